// verify.hpp - checks of a finished program that do not rely on how it was made.
// Depends on   toolchain/isa.
#pragma once

#include <string>
#include <vector>

#include "toolchain/asm/program.hpp"

namespace toolchain::assembly {

struct VerifyOptions {
    bool allow_undocumented = false;  ///< the ten instructions that Intel does not document
};

/// What is wrong with a program, empty if nothing is:
/// every stored byte is in the image, and every instruction's opcode at its address; every opcode
/// is allowed; what is called or jumped to by name is an instruction of the program; stored
/// sections lie in ROM unless their address is fixed; frames, data, cleared region and stack lie in
/// RAM and apart. That operands are in their range is checked by link().
[[nodiscard]] std::vector<Diagnostic> verify(const Program& program,
                                             const VerifyOptions& options = {});

}  // namespace toolchain::assembly
