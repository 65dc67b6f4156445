// entry.hpp - puts a program into a machine such that a RET of its entry is seen.
// Depends on   machine.hpp, program.hpp.
// Design note  The return address is that of a trap, a HLT in memory the image leaves free: the
//              highest free byte of the ROM half (7FFFh if it is free), which programs for the
//              board do not write; where the image fills that half, FFFFh, with the stack below it.
#pragma once

#include <cstdint>
#include <optional>

#include "tools/i85run/machine.hpp"
#include "tools/i85run/options.hpp"
#include "tools/i85run/program.hpp"

namespace i85run {

/// Copies the image into the machine's memory and sets PC, SP and the return address.
/// @return  the address of the return trap; none when the image leaves no room for it and neither
///          --entry nor --sp ask for it
/// @errors  host_sim::ImageError: the return address would lie on the image
std::optional<uint16_t> enter_program(Machine& machine, const Program& program,
                                      const Options& options);

/// Whether the trap's byte is no longer what enter_program has put there.
[[nodiscard]] bool return_is_lost(const Machine& machine, uint16_t trap);

}  // namespace i85run
