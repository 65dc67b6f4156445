// block_code.hpp - code for one block, given what it finds and what its successors want.
// How          a narrow beam: every operation in every way on the best states so far.
// Depends on   recipes.hpp, edge.hpp.
#pragma once

#include <stdexcept>
#include <vector>

#include "toolchain/codegen/edge.hpp"

namespace toolchain::codegen {

/// Where a block stands: which successor follows it without a jump.
struct BlockSetting {
    BlockId block = 0;
    BlockId next = kNone;  ///< placed behind it
    double byte_cost = 1;  ///< T-states that a byte is worth, at this block's frequency
    unsigned beam = 6;
    bool only_cost = false;  ///< make no instructions
    RecipeContext recipes{};
    const Contract* entry = nullptr;
    const std::vector<Contract>* contracts = nullptr;  ///< of all blocks
    uint32_t first_block_label = 0;                    ///< label of block n is this plus n
    SymbolId jump_index = kNone;                       ///< of the routine for jump tables
};

struct BlockCode {
    std::vector<CodeItem> items{};
    std::vector<CodeItem> cold{};  ///< edges that are jumped to, behind all blocks
    double cost = 0;               ///< T-states of one execution, and its bytes by their weight
};

/// No way was found to translate an operation: a wider beam may have one.
class NoWay : public std::logic_error {
public:
    using std::logic_error::logic_error;
};

/// @errors NoWay
[[nodiscard]] BlockCode make_block(const FunctionFacts& facts, const BlockSetting& setting);

}  // namespace toolchain::codegen
