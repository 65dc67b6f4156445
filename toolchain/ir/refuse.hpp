// refuse.hpp - programs that cannot be compiled: where, what, what to do.
// Depends on   libLLVM 19 (IR), select.hpp (Refused).
#pragma once

#include <string>

#include "toolchain/ir/select.hpp"

namespace llvm {
class Function;
class GlobalVariable;
class Instruction;
}  // namespace llvm

namespace toolchain::ir {

/// "file:line" of an instruction; without one of its own, of its function; without that, the file.
[[nodiscard]] std::string place_text(const llvm::Instruction& instruction);
[[nodiscard]] std::string place_text(const llvm::Function& function);
[[nodiscard]] std::string place_text(const llvm::GlobalVariable& variable);

/// Throws Refused: "file:line: in function: what".
[[noreturn]] void refuse(const llvm::Instruction& instruction, const std::string& what);

/// Refuses everything that has no meaning on the 8085 or that the back end does not do: floating
/// point, vectors, integers beyond 64 bits, variable argument lists, variables of run-time size,
/// thread-locals, computed goto, inline assembly, atomic read-modify-write, address spaces,
/// exceptions, ifuncs. @errors Refused: a line for each, twenty at most
void refuse_unsupported(const llvm::Module& module);

}  // namespace toolchain::ir
