// place_near_use.cpp - addresses and loads stand where they are used; see passes.hpp.
// Why          LLVM computes them early. With seven registers every value that waits pushes another
//              one into memory.
// How          an instruction moves down in its block in front of its only user, the next value of
// a
//              stepped address to the end of the loop, unless more bytes would wait instead. Not
//              arithmetic: moved as well, it made five kernels of ten slower by 1 to 5 %.
// Depends on   libLLVM 19.
#include <llvm/IR/Instructions.h>
#include <llvm/IR/Module.h>

#include <algorithm>
#include <vector>

#include "toolchain/ir/passes.hpp"
#include "toolchain/ir/sinking.hpp"

namespace toolchain::ir {

namespace {

using llvm::Instruction;

uint64_t size_of(const llvm::Value& value) {
    const llvm::DataLayout& layout =
        llvm::cast<Instruction>(value).getFunction()->getParent()->getDataLayout();
    return layout.getTypeStoreSize(value.getType()).getFixedValue();
}

/// Bytes that would wait longer if the instruction moved: operands that nobody else uses.
uint64_t bytes_kept_waiting(const Instruction& instruction) {
    uint64_t sum = 0;
    for (const llvm::Use& use : instruction.operands()) {
        if (llvm::isa<Instruction>(use.get()) && use->hasOneUse()) sum += size_of(*use.get());
    }
    return sum;
}

/// In front of which instruction the value is needed, or nullptr.
Instruction* place_of_use(Instruction& instruction) {
    llvm::BasicBlock* home = instruction.getParent();
    const bool goes_on =
        std::all_of(instruction.use_begin(), instruction.use_end(), [&](const llvm::Use& use) {
            const auto* phi = llvm::dyn_cast<llvm::PHINode>(use.getUser());
            return phi != nullptr && phi->getIncomingBlock(use) == home;
        });
    if (goes_on && !instruction.use_empty()) return home->getTerminator();
    if (!instruction.hasOneUse()) return nullptr;
    auto* user = llvm::cast<Instruction>(*instruction.user_begin());
    if (llvm::isa<llvm::PHINode>(user)) return nullptr;
    return user->getParent() == home ? user : nullptr;
}

}  // namespace

void place_near_use(llvm::Function& function) {
    for (llvm::BasicBlock& block : function) {
        // From the bottom: what a value is computed from follows it.
        std::vector<Instruction*> instructions;
        for (Instruction& instruction : block) instructions.push_back(&instruction);
        for (Instruction* instruction : llvm::reverse(instructions)) {
            if (!llvm::isa<llvm::LoadInst>(instruction) &&
                !llvm::isa<llvm::GetElementPtrInst>(instruction)) {
                continue;
            }
            Instruction* place = place_of_use(*instruction);
            if (place == nullptr || instruction->getNextNode() == place) continue;
            if (!may_move_down(*instruction, *place)) continue;
            if (bytes_kept_waiting(*instruction) > size_of(*instruction)) continue;
            instruction->moveBefore(place);
        }
    }
}

}  // namespace toolchain::ir
