// constructors.hpp - the functions that run before main.
// Depends on   libLLVM 19 (IR), toolchain/codegen/mir.hpp.
#pragma once

#include <vector>

#include "toolchain/codegen/mir.hpp"

namespace llvm {
class Module;
}

namespace toolchain::ir {

/// What llvm.global_ctors lists: lower priorities first, among equals in the list's order.
[[nodiscard]] std::vector<codegen::SymbolId> constructors_of(codegen::Module& out,
                                                             const llvm::Module& module);

}  // namespace toolchain::ir
