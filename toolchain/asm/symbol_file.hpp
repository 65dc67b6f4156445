// symbol_file.hpp - a program's names for simulator, trace, profile and debugger.
// Form         docs/spec/symbols.md.
#pragma once

#include <string>

#include "toolchain/asm/program.hpp"

namespace toolchain::assembly {

/// Functions and data by their demangled names where those are unique; slots of overlaid frames as
/// labels, since data may not overlap; a label without a name for each run of instructions of one
/// source line. Local labels and numbers are left out.
[[nodiscard]] std::string symbol_file(const Program& program);

}  // namespace toolchain::assembly
