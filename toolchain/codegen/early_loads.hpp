// early_loads.hpp - a branch to code that only loads registers and goes on: the loads come in front
// of the branch, which then goes where they went on to.
// Depends on   code_flow.hpp.
// Saves        3 bytes: the jump behind the loads, or the branch becomes a return.
// Cost         the loads' T-states where the branch is not taken, so none in loops but where that
//              way loads the same register at once.
#pragma once

#include <vector>

#include "toolchain/codegen/machine.hpp"

namespace toolchain::codegen {

/// @param at_return  registers that the caller looks at
void load_early(std::vector<CodeItem>& items, RegisterSet at_return);

}  // namespace toolchain::codegen
