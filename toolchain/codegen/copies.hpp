// copies.hpp - pass: second copies of what an interrupt shares with the main program or with
// another interrupt. Why          a static frame and the cells of a runtime routine hold one
// activation. This bug has
//              bitten other compilers with static frames.
// In, out      sections of all functions -> the same and copies `NAME@rst75`, with the code of each
//              interrupt calling its own. What has no memory of its own is not copied.
// Depends on   contexts.hpp, toolchain/asm/clone.hpp.
#pragma once

#include <cstddef>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "toolchain/asm/object.hpp"
#include "toolchain/codegen/contexts.hpp"
#include "toolchain/codegen/names.hpp"

namespace toolchain::codegen {

struct CopyInput {
    const Module& module;
    const SafeNames& names;
    const CallGraph& graph;
    const std::vector<Context>& contexts;
    std::span<const assembly::Module> runtime{};
};

/// Copies of one context.
struct ContextCopies {
    std::set<std::size_t> functions{};  ///< copied for it
};

/// Adds the copies to `program`, which holds the sections of all functions and variables, and lets
/// the contexts use them.
/// @param refusals  gains what cannot be done: a function with memory that two contexts reach, the
///                  later one through a pointer
/// @return by context
std::vector<ContextCopies> make_copies(const CopyInput& input, assembly::Module& program,
                                       std::vector<std::string>& refusals);

}  // namespace toolchain::codegen
