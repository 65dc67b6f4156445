// expand_selects.cpp - selects become branches; see passes.hpp.
// How          selects of a block with the same condition share one branch where nothing in between
//              forbids it. What only one of two values needs is computed on its way.
// Depends on   libLLVM 19.
#include <llvm/IR/IRBuilder.h>
#include <llvm/IR/Instructions.h>
#include <llvm/Transforms/Utils/BasicBlockUtils.h>

#include <algorithm>
#include <vector>

#include "toolchain/ir/passes.hpp"
#include "toolchain/ir/sinking.hpp"

namespace toolchain::ir {

namespace {

using llvm::BasicBlock;
using llvm::Instruction;
using llvm::SelectInst;

/// May the select stand in front of `place`, earlier in its block?
bool may_move_up(const SelectInst& select, const Instruction& place) {
    return std::all_of(select.op_begin(), select.op_end(), [&](const llvm::Use& use) {
        const auto* operand = llvm::dyn_cast<Instruction>(use.get());
        return operand == nullptr || operand->getParent() != select.getParent() ||
               (operand != &place && operand->comesBefore(&place));
    });
}

/// Selects with the condition of `first` that can stand beside it.
std::vector<SelectInst*> group_of(SelectInst& first) {
    std::vector<SelectInst*> group = {&first};
    for (Instruction* next = first.getNextNode(); next != nullptr; next = next->getNextNode()) {
        auto* select = llvm::dyn_cast<SelectInst>(next);
        if (select == nullptr || select->getCondition() != first.getCondition()) continue;
        if (may_move_up(*select, first)) group.push_back(select);
    }
    for (SelectInst* select : group) {
        if (select != &first) select->moveBefore(&first);
    }
    return group;
}

/// An arm without code of its own is no block.
void drop_empty(Instruction& end, BasicBlock& head, BasicBlock& tail) {
    BasicBlock* arm = end.getParent();
    if (&arm->front() != &end) return;
    head.getTerminator()->replaceSuccessorWith(arm, &tail);
    tail.replacePhiUsesWith(arm, &head);
    arm->eraseFromParent();
}

void expand(SelectInst& first) {
    const std::vector<SelectInst*> group = group_of(first);
    SelectInst* top = group.size() > 1 ? group[1] : &first;
    BasicBlock* head = first.getParent();
    Instruction* yes_end = nullptr;
    Instruction* no_end = nullptr;
    llvm::SplitBlockAndInsertIfThenElse(first.getCondition(), top->getIterator(), &yes_end,
                                        &no_end);
    BasicBlock* tail = first.getParent();
    for (SelectInst* select : group) {
        auto* phi = llvm::PHINode::Create(select->getType(), 2, "", tail->begin());
        phi->addIncoming(select->getTrueValue(), yes_end->getParent());
        phi->addIncoming(select->getFalseValue(), no_end->getParent());
        phi->setDebugLoc(select->getDebugLoc());
        select->replaceAllUsesWith(phi);
        phi->takeName(select);
    }
    for (SelectInst* select : group) select->eraseFromParent();
    for (llvm::PHINode& phi : tail->phis()) {
        for (Instruction* end : {yes_end, no_end}) {
            sink(phi.getIncomingValueForBlock(end->getParent()), *head, *head->getTerminator(),
                 end);
        }
    }
    // At least one arm has to stay: the values differ.
    const bool no_is_empty = &no_end->getParent()->front() == no_end;
    drop_empty(no_is_empty ? *no_end : *yes_end, *head, *tail);
}

}  // namespace

void expand_selects(llvm::Function& function) {
    for (BasicBlock& block : function) {
        for (Instruction& instruction : block) {
            if (auto* select = llvm::dyn_cast<SelectInst>(&instruction)) {
                expand(*select);
                break;
            }
        }
    }
}

}  // namespace toolchain::ir
