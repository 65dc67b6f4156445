// lower_calls.hpp - the ABI: where arguments and results are. See docs/spec/abi.md.
// Depends on   mir.hpp.
#pragma once

#include "toolchain/codegen/mir.hpp"

namespace toolchain::codegen {

/// Gives every call and every function its registers. Arguments and results beyond them become
/// stores and loads at fixed symbols: `NAME@args` (a FrameObject of the function), for functions
/// whose address is taken one symbol per signature, for runtime routines their cells. Calls of
/// `__mul16` and the like become calls of the narrowest routine that gives the same bytes.
/// @param narrow  false: they stay as they are
void lower_calls(Module& module, bool narrow = true);

}  // namespace toolchain::codegen
