// narrow_calls.hpp - pass: every call of a multiply, divide or shift routine becomes one of the
// narrowest routine that gives the same bytes.
// Why          a 32-bit product of two sign-extended words takes 594 T instead of 1693.
// In, out      calls as select() makes them: one string of bytes for each argument, quotient before
//              remainder. Routines: docs/spec/runtime.md.
// Depends on   known_bytes.hpp, builder.hpp.
#pragma once

#include "toolchain/codegen/mir.hpp"

namespace toolchain::codegen {

/// Also drops such calls whose results nobody needs.
void narrow_calls(Module& module, Function& function);

}  // namespace toolchain::codegen
