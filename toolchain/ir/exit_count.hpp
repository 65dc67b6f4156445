// exit_count.hpp - how often a loop's exit is passed by before it is taken; internal to
// toolchain/ir. Depends on   libLLVM 19.
#pragma once

#include <llvm/Analysis/LoopInfo.h>
#include <llvm/Analysis/ScalarEvolution.h>
#include <llvm/Analysis/TargetTransformInfo.h>
#include <llvm/Transforms/Utils/ScalarEvolutionExpander.h>

namespace toolchain::ir {

/// The count as an expression that costs little in front of the loop and fits in 16 bits, or
/// nullptr.
[[nodiscard]] const llvm::SCEV* cheap_exit_count(llvm::ScalarEvolution& evolution,
                                                 const llvm::TargetTransformInfo& costs,
                                                 llvm::SCEVExpander& expander, llvm::Loop& loop,
                                                 llvm::BasicBlock& exit);

}  // namespace toolchain::ir
