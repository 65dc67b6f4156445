// expand_selects.cpp - a select becomes a branch around an empty block; see passes.hpp.
// Depends on   libLLVM 19.
#include <llvm/IR/InstIterator.h>
#include <llvm/IR/Instructions.h>
#include <llvm/Transforms/Utils/BasicBlockUtils.h>

#include <vector>

#include "toolchain/ir/passes.hpp"

namespace toolchain::ir {

void expand_selects(llvm::Function& function) {
    std::vector<llvm::SelectInst*> selects;
    for (llvm::Instruction& instruction : llvm::instructions(function)) {
        if (auto* select = llvm::dyn_cast<llvm::SelectInst>(&instruction))
            selects.push_back(select);
    }
    for (llvm::SelectInst* select : selects) {
        llvm::BasicBlock* head = select->getParent();
        llvm::Instruction* end =
            llvm::SplitBlockAndInsertIfThen(select->getCondition(), select->getIterator(), false);
        llvm::BasicBlock* taken = end->getParent();
        auto* phi = llvm::PHINode::Create(select->getType(), 2, "", select->getIterator());
        phi->addIncoming(select->getTrueValue(), taken);
        phi->addIncoming(select->getFalseValue(), head);
        select->replaceAllUsesWith(phi);
        phi->takeName(select);
        select->eraseFromParent();
    }
}

}  // namespace toolchain::ir
