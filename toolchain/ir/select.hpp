// select.hpp - LLVM IR to the back end's representation.
// Depends on   libLLVM 19 (IR), toolchain/codegen.
// Input        IR behind prepare(): no switch, select, invoke, vector, float; intrinsics only for
// the
//              processor, memory copies and what is dropped.
#pragma once

#include <stdexcept>
#include <string>

#include "toolchain/codegen/mir.hpp"

namespace llvm {
class Module;
}

namespace toolchain::ir {

/// What cannot be compiled: "file:line: function: what: what to do".
class Refused : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

/// Translates all functions and variables. @errors Refused
[[nodiscard]] codegen::Module select(const llvm::Module& module);

}  // namespace toolchain::ir
