// plain_generator.hpp - the simplest code that is right: every byte in its slot, every operation
// through A.
// Use          a stand-in for generate() where a test is about frames, calls and interrupts; and a
//              second opinion about generate() itself.
// Depends on   toolchain/codegen/mir.hpp, behind lower_calls().
#pragma once

#include "toolchain/codegen/generate.hpp"

namespace codegen_test {

[[nodiscard]] toolchain::codegen::FunctionCode plain_code(
    const toolchain::codegen::Module& module, const toolchain::codegen::Function& function,
    const toolchain::codegen::GenerateOptions& options);

}  // namespace codegen_test
