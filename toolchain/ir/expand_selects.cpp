// expand_selects.cpp - selects become branches; see passes.hpp.
// How          selects of a block with the same condition share one branch where nothing in between
//              forbids it. What only one of two values needs is computed on its way.
// Depends on   libLLVM 19.
#include <llvm/Analysis/ValueTracking.h>
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

/// Can the value be had in front of `place`, with what it is computed from?
bool may_move_up(const llvm::Value* value, const Instruction& place, unsigned depth = 0) {
    constexpr unsigned kDeepest = 4;
    const auto* instruction = llvm::dyn_cast<Instruction>(value);
    if (instruction == nullptr || instruction->getParent() != place.getParent() ||
        instruction->comesBefore(&place)) {
        return true;
    }
    if (instruction == &place || depth > kDeepest || llvm::isa<llvm::PHINode>(instruction) ||
        instruction->mayReadFromMemory() || !llvm::isSafeToSpeculativelyExecute(instruction)) {
        return false;
    }
    return std::all_of(instruction->op_begin(), instruction->op_end(), [&](const llvm::Use& use) {
        return may_move_up(use.get(), place, depth + 1);
    });
}

void move_up(llvm::Value* value, Instruction& place) {
    auto* instruction = llvm::dyn_cast<Instruction>(value);
    if (instruction == nullptr || instruction->getParent() != place.getParent() ||
        instruction->comesBefore(&place)) {
        return;
    }
    for (llvm::Value* operand : instruction->operand_values()) move_up(operand, place);
    instruction->moveBefore(&place);
}

/// Selects with the condition of `first`, moved to stand in front of it one behind the other.
std::vector<SelectInst*> group_of(SelectInst& first) {
    std::vector<SelectInst*> group = {&first};
    for (Instruction* next = first.getNextNode(); next != nullptr; next = next->getNextNode()) {
        auto* select = llvm::dyn_cast<SelectInst>(next);
        if (select == nullptr || select->getCondition() != first.getCondition()) continue;
        // What one of the group gives may not be needed for another one.
        const bool depends = std::any_of(
            select->op_begin(), select->op_end(),
            [&](const llvm::Use& use) { return !may_move_up(use.get(), *group.front()); });
        if (depends) continue;
        group.push_back(select);
    }
    for (SelectInst* select : group) {
        if (select == &first) continue;
        for (llvm::Value* operand : select->operand_values()) move_up(operand, first);
    }
    // Behind all that they need, the first one included.
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
