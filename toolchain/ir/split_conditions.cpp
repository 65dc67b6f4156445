// split_conditions.cpp - a branch on `a and b` becomes two branches; see passes.hpp.
// Why          flags decide a branch at once; a condition as a value costs a comparison into a
//              register, a combination and another test. What only the second part needs is
//              computed behind the first.
// Depends on   libLLVM 19.
#include <llvm/IR/Instructions.h>
#include <llvm/IR/PatternMatch.h>

#include <vector>

#include "toolchain/ir/passes.hpp"
#include "toolchain/ir/sinking.hpp"

namespace toolchain::ir {

namespace {

using llvm::BasicBlock;
using llvm::BranchInst;
using llvm::Value;

void add_incoming_like(BasicBlock& target, const BasicBlock& like, BasicBlock& from) {
    for (llvm::PHINode& phi : target.phis()) {
        phi.addIncoming(phi.getIncomingValueForBlock(&like), &from);
    }
}

/// The block of the second test, or nullptr if there is nothing to split.
BasicBlock* split(BranchInst& branch) {
    using namespace llvm::PatternMatch;
    if (!branch.isConditional() || branch.getSuccessor(0) == branch.getSuccessor(1)) return nullptr;
    auto* condition = llvm::dyn_cast<llvm::Instruction>(branch.getCondition());
    BasicBlock* head = branch.getParent();
    if (condition == nullptr || condition->getParent() != head || !condition->hasOneUse()) {
        return nullptr;
    }
    Value* first = nullptr;
    Value* second = nullptr;
    const bool both = match(condition, m_LogicalAnd(m_Value(first), m_Value(second)));
    if (!both && !match(condition, m_LogicalOr(m_Value(first), m_Value(second)))) return nullptr;
    // A condition that is known already, such as a parameter, is better tested first.
    BasicBlock* yes = branch.getSuccessor(0);
    BasicBlock* no = branch.getSuccessor(1);
    BasicBlock* next =
        BasicBlock::Create(head->getContext(), "", head->getParent(), head->getNextNode());
    BranchInst* end = BranchInst::Create(yes, no, second, next);
    end->setDebugLoc(branch.getDebugLoc());
    end->setMetadata(llvm::LLVMContext::MD_loop, branch.getMetadata(llvm::LLVMContext::MD_loop));
    add_incoming_like(*yes, *head, *next);
    add_incoming_like(*no, *head, *next);
    branch.setCondition(first);
    // The successor that the second test decides is no longer one of the first.
    BasicBlock* lost = both ? yes : no;
    lost->removePredecessor(head, /*KeepOneInputPHIs=*/true);
    branch.setSuccessor(both ? 0 : 1, next);
    condition->eraseFromParent();
    sink(second, *head, branch, end);
    return next;
}

}  // namespace

void split_conditions(llvm::Function& function) {
    std::vector<BasicBlock*> blocks;
    for (BasicBlock& block : function) blocks.push_back(&block);
    while (!blocks.empty()) {
        BasicBlock* block = blocks.back();
        blocks.pop_back();
        auto* branch = llvm::dyn_cast<BranchInst>(block->getTerminator());
        if (branch == nullptr) continue;
        if (BasicBlock* next = split(*branch)) {
            blocks.push_back(block);
            blocks.push_back(next);
        }
    }
}

}  // namespace toolchain::ir
