// contexts.hpp - what can be active at the same time: the main program and each interrupt.
// Depends on   call_graph.hpp.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "toolchain/codegen/call_graph.hpp"

namespace toolchain::codegen {

/// The main program with constructors and roots, or one interrupt function.
struct Context {
    std::string suffix{};  ///< behind the names of its copies; of the main program empty
    std::string title{};   ///< for messages
    std::vector<std::size_t> roots{};
    std::vector<bool> reached{};     ///< by function
    std::vector<bool> by_pointer{};  ///< reached by a call through a pointer
};

/// "RST 7.5" for 3CH; empty if no interrupt enters there.
[[nodiscard]] std::string vector_title(int32_t vector);
/// "@rst75" for 3CH.
[[nodiscard]] std::string vector_suffix(int32_t vector);

/// The main program first, then interrupts by their vectors.
/// @param main_roots  indices of main, constructors ...; functions whose address is taken but which
///                    nobody reaches are added
[[nodiscard]] std::vector<Context> find_contexts(const Module& module, const CallGraph& graph,
                                                 std::vector<std::size_t> main_roots);

/// For every function the first context that reaches it, or kNoContext.
[[nodiscard]] std::vector<std::size_t> owners(const std::vector<Context>& contexts,
                                              std::size_t functions);
inline constexpr std::size_t kNoContext = SIZE_MAX;

}  // namespace toolchain::codegen
