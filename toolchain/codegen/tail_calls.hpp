// tail_calls.hpp - a call in front of a return is a jump: the callee returns in its place.
// Depends on   machine.hpp.
// Must run     behind all passes that follow control: it tells none that control leaves there.
// Saves        a byte and 18 T; 3 more where a branch went to such a call.
#pragma once

#include <vector>

#include "toolchain/codegen/machine.hpp"

namespace toolchain::codegen {

/// @param indirect  symbol of the routine that calls through a pointer: its calls stay calls
void jump_to_last_calls(std::vector<CodeItem>& items, uint32_t indirect);

}  // namespace toolchain::codegen
