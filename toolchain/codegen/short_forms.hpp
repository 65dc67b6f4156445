// short_forms.hpp - the last pass over finished code: shorter instructions for what is needed of
// longer ones, where nobody looks at flags and registers that differ.
// Depends on   code_flow.hpp.
// Volatile     every read of memory stays one read.
#pragma once

#include <vector>

#include "toolchain/codegen/machine.hpp"

namespace toolchain::codegen {

/// @param at_return  registers that the caller looks at
void take_short_forms(std::vector<CodeItem>& items, RegisterSet at_return);

}  // namespace toolchain::codegen
