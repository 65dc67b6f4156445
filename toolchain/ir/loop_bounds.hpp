// loop_bounds.hpp - what is known about how often a loop repeats, from its author and from LLVM.
// Depends on   libLLVM 19.
#pragma once

#include <cstdint>
#include <map>

namespace llvm {
class BasicBlock;
class Function;
class Module;
}  // namespace llvm

namespace toolchain::ir {

/// Calls of `__i85_loop_bound(n)` become a note on the innermost loop around them: its body runs at
/// most n times each time the loop is entered. For IR as the front end left it.
/// @errors Refused: outside of a loop, or n is not a constant from 1 on
void take_loop_bounds(llvm::Module& module);

/// What code generation wants to know about a block.
struct BlockFacts {
    double frequency = 1;  ///< executions for each call of the function, estimated
    uint32_t loop_depth = 0;
    uint32_t loop_bound = 0;  ///< of a loop's header: most executions for each entry; 0: unknown
};

/// Of every block that can be reached. Frequencies are LLVM's, corrected by the iterations of every
/// loop: its trip count where that is constant, else ten.
[[nodiscard]] std::map<const llvm::BasicBlock*, BlockFacts> block_facts(
    const llvm::Function& function);

}  // namespace toolchain::ir
