// sinking.cpp - see sinking.hpp.
#include "toolchain/ir/sinking.hpp"

#include <algorithm>

namespace toolchain::ir {

bool may_move_down(const llvm::Instruction& instruction, const llvm::Instruction& before) {
    if (llvm::isa<llvm::PHINode>(instruction) || llvm::isa<llvm::AllocaInst>(instruction) ||
        llvm::isa<llvm::CallBase>(instruction) || instruction.isTerminator() ||
        instruction.mayHaveSideEffects()) {
        return false;
    }
    if (!instruction.mayReadFromMemory()) return true;
    for (const llvm::Instruction* next = instruction.getNextNode(); next != nullptr;
         next = next->getNextNode()) {
        if (next == &before) return true;
        if (next->mayWriteToMemory()) return false;
    }
    return false;
}

void sink(llvm::Value* value, const llvm::BasicBlock& home, const llvm::Instruction& limit,
          llvm::Instruction* before) {
    auto* instruction = llvm::dyn_cast<llvm::Instruction>(value);
    if (instruction == nullptr || instruction->getParent() != &home || !instruction->hasOneUse() ||
        !may_move_down(*instruction, limit)) {
        return;
    }
    instruction->moveBefore(before);
    // A copy: moving changes no operand, but the loop must not see what comes next.
    const llvm::SmallVector<llvm::Value*, 4> operands(instruction->operand_values());
    for (llvm::Value* operand : operands) sink(operand, home, limit, instruction);
}

}  // namespace toolchain::ir
