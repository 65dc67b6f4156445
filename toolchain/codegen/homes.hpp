// homes.hpp - which values live in registers at block boundaries: a search with the real block
// generator as its judge.
// Depends on   block_code.hpp.
#pragma once

#include <vector>

#include "toolchain/codegen/block_code.hpp"

namespace toolchain::codegen {

struct HomesOptions {
    bool search = true;
    double byte_cost = 1;
    RecipeContext recipes{};
    SymbolId jump_index = kNone;
    uint64_t budget = 0;     ///< operations to translate at most while searching; 0: by size
    uint64_t by_chance = 0;  ///< for tests: a seed, homes that nobody looked for
};

struct FunctionBlocks {
    std::vector<BlockId> order{};     ///< as they are placed
    std::vector<BlockCode> blocks{};  ///< by block
    double cost = 0;
};

/// Code of all blocks with the best contracts found. The result does not depend on the machine or
/// the time: the search is limited by counting.
[[nodiscard]] FunctionBlocks make_blocks(const FunctionFacts& facts, const HomesOptions& options);

}  // namespace toolchain::codegen
