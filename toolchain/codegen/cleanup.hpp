// cleanup.hpp - what block by block translation cannot see: values that are still where they are
// wanted, and instructions whose results nobody reads.
// Depends on   known_values.hpp.
// Volatile     memory outside of the frame's slots is read and written exactly as before.
#pragma once

#include <cstdint>
#include <vector>

#include "toolchain/codegen/machine.hpp"

namespace toolchain::codegen {

/// @param items        code of a function, its slots at their final offsets in the frame
/// @param frame_bytes  of slots
/// @param at_return    registers whose values the caller looks at; what the function changes
///                     besides is found afterwards, in the result
void clean_up(std::vector<CodeItem>& items, uint32_t frame_bytes, RegisterSet at_return);

}  // namespace toolchain::codegen
