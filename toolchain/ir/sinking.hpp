// sinking.hpp - moves computations to where their only use is; internal to toolchain/ir.
// Depends on   libLLVM 19.
#pragma once

#include <llvm/IR/Instructions.h>

namespace toolchain::ir {

/// May the instruction be executed at `before` instead, in its block or one that only follows it?
/// It has no effect, and what it reads from memory is not written in between.
[[nodiscard]] bool may_move_down(const llvm::Instruction& instruction,
                                 const llvm::Instruction& before);

/// Moves a value that is used once, and what only it uses, from `home` in front of `before`.
/// @param home  the block to take from; `limit` is its last instruction that counts as in between
void sink(llvm::Value* value, const llvm::BasicBlock& home, const llvm::Instruction& limit,
          llvm::Instruction* before);

}  // namespace toolchain::ir
