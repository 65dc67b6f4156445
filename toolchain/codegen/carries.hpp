// carries.hpp - comparisons that the carry of a sum or difference in front of them answers: a sum
// is below its operand if it wraps, and a difference borrows if its left operand is below its
// right. Depends on   mir.hpp.
#pragma once

#include <cstdint>
#include <vector>

#include "toolchain/codegen/mir.hpp"

namespace toolchain::codegen {

/// What answers the comparison "below" or "not below" at a position of a block.
struct CarryAnswer {
    uint32_t from = kNone;  ///< position of the sum or difference; kNone: nothing does
    bool inverted = false;  ///< left is below right if there is no carry
};

/// By position of the block; its terminator's is the last.
[[nodiscard]] std::vector<CarryAnswer> find_carry_answers(const Function& function,
                                                          const Block& block);

}  // namespace toolchain::codegen
