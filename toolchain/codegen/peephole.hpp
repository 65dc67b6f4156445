// peephole.hpp - small improvements of a finished function.
// Depends on   machine.hpp, toolchain/isa.
#pragma once

#include <vector>

#include "toolchain/codegen/machine.hpp"

namespace toolchain::codegen {

/// Jumps to jumps, to returns and to what follows; labels nobody uses; code nobody reaches; MVI A,0
/// as XRA A where no flag is read. Flags are never live across a jump without condition.
void improve(std::vector<CodeItem>& items);

}  // namespace toolchain::codegen
