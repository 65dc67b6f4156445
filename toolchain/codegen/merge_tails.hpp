// merge_tails.hpp - equal code at the ends of ways that meet is there once.
// Depends on   machine.hpp.
// Cost         none in T-states where both ways went on to one label; 10 where one of them returned
//              (it jumps to the other's end then), which has to save kWorthAJump bytes.
#pragma once

#include <cstdint>
#include <vector>

#include "toolchain/codegen/machine.hpp"

namespace toolchain::codegen {

inline constexpr uint32_t kWorthAJump = 3;

/// @param next_label  the first label number that is free; behind it afterwards
void merge_tails(std::vector<CodeItem>& items, uint32_t& next_label);

}  // namespace toolchain::codegen
