// checks.hpp - pass: what cannot be compiled because of who calls whom.
// Depends on   call_graph.hpp.
#pragma once

#include <string>
#include <vector>

#include "toolchain/codegen/call_graph.hpp"

namespace toolchain::codegen {

/// "file.c:12", or empty.
[[nodiscard]] std::string place_text(const Module& module, SourcePlace place);

/// A line for each: recursion with its cycle, interrupt functions that are called, have parameters,
/// or share a vector.
[[nodiscard]] std::vector<std::string> call_refusals(const Module& module, const CallGraph& graph,
                                                     bool allow_recursion);

}  // namespace toolchain::codegen
