// count_down.cpp - counters that only count are counted down to 0, in as few bits as they need; see
// passes.hpp.
// Why          `DCR; JNZ` compares for nothing: 14 T-states in one register; so does `INX; JNK` in
// a
//              pair, with undocumented instructions.
// Depends on   libLLVM 19.
#include <llvm/Analysis/ScalarEvolutionExpressions.h>
#include <llvm/Analysis/TargetTransformInfo.h>
#include <llvm/IR/IRBuilder.h>
#include <llvm/IR/Instructions.h>
#include <llvm/IR/Module.h>
#include <llvm/Transforms/Utils/BasicBlockUtils.h>
#include <llvm/Transforms/Utils/Local.h>
#include <llvm/Transforms/Utils/LoopSimplify.h>
#include <llvm/Transforms/Utils/ScalarEvolutionExpander.h>

#include <algorithm>
#include <cstdlib>

#include "toolchain/ir/analyses.hpp"
#include "toolchain/ir/exit_count.hpp"
#include "toolchain/ir/passes.hpp"

namespace toolchain::ir {

namespace {

using llvm::ICmpInst;
using llvm::Value;

class Counter {
public:
    Counter(Analyses& analyses, llvm::Loop& loop, const llvm::DataLayout& layout, bool words_go_up)
        : loops_(analyses.loops()),
          evolution_(analyses.evolution()),
          costs_(analyses.get<llvm::TargetIRAnalysis>()),
          loop_(loop),
          words_go_up_(words_go_up),
          expander_(evolution_, layout, "count") {
        expander_.disableCanonicalMode();
    }

    void run() {
        if (loop_.getLoopPreheader() == nullptr || loop_.getLoopLatch() == nullptr) return;
        llvm::SmallVector<llvm::BasicBlock*, 4> exits;
        loop_.getExitingBlocks(exits);
        for (llvm::BasicBlock* block : exits) {
            // A block of a loop inside runs more than once each time around.
            if (loops_.getLoopFor(block) == &loop_ && replace(*block)) return;
        }
    }

private:
    /// The phi that serves nothing but the comparison, or nullptr.
    [[nodiscard]] llvm::PHINode* pure_counter(const ICmpInst& compare) const {
        llvm::PHINode* found = nullptr;
        for (llvm::PHINode& phi : loop_.getHeader()->phis()) {
            if (!phi.getType()->isIntegerTy()) continue;
            const Value* next = phi.getIncomingValueForBlock(loop_.getLoopLatch());
            if (compare.getOperand(0) != &phi && compare.getOperand(0) != next &&
                compare.getOperand(1) != &phi && compare.getOperand(1) != next) {
                continue;
            }
            const auto* step = llvm::dyn_cast<llvm::BinaryOperator>(next);
            if (step == nullptr) continue;
            const auto only = [&](const Value* value) {
                return std::all_of(value->user_begin(), value->user_end(), [&](const auto* user) {
                    return user == &phi || user == next || user == &compare;
                });
            };
            if (only(&phi) && only(next)) found = &phi;
        }
        return found;
    }

    [[nodiscard]] bool counts_down_already(const ICmpInst& compare) const {
        const auto* number = llvm::dyn_cast<llvm::ConstantInt>(compare.getOperand(1));
        return compare.isEquality() && number != nullptr && number->isZero();
    }

    bool replace(llvm::BasicBlock& block) {
        auto* branch = llvm::dyn_cast<llvm::BranchInst>(block.getTerminator());
        if (branch == nullptr || !branch->isConditional()) return false;
        auto* compare = llvm::dyn_cast<ICmpInst>(branch->getCondition());
        if (compare == nullptr || !compare->hasOneUse()) return false;
        llvm::PHINode* old = pure_counter(*compare);
        if (old == nullptr) return false;
        const unsigned old_bits = old->getType()->getIntegerBitWidth();
        if (old_bits <= 8 && counts_down_already(*compare)) return false;
        const llvm::SCEV* stays = cheap_exit_count(evolution_, costs_, expander_, loop_, block);
        if (stays == nullptr) return false;
        const bool byte = evolution_.getUnsignedRangeMax(stays).ule(UINT8_MAX);
        const unsigned bits = byte ? 8 : 16;
        if (counts_down_already(*compare) && bits >= old_bits) return false;
        const bool goes_up = words_go_up_ && &block == loop_.getLoopLatch();
        if (!byte && !goes_up && compare_pointer(block, *branch, *compare, stays)) return true;
        make(block, *branch, *compare, *old, stays, bits);
        return true;
    }

    /// A pointer that starts at a known place and steps evenly has a known end: no counter at all.
    bool compare_pointer(llvm::BasicBlock& block, llvm::BranchInst& branch, ICmpInst& compare,
                         const llvm::SCEV* stays) {
        llvm::BasicBlock* latch = loop_.getLoopLatch();
        const auto* count = llvm::dyn_cast<llvm::SCEVConstant>(stays);
        if (&block != latch || count == nullptr) return false;
        for (llvm::PHINode& phi : loop_.getHeader()->phis()) {
            if (!phi.getType()->isPointerTy()) continue;
            const auto* form = llvm::dyn_cast<llvm::SCEVAddRecExpr>(evolution_.getSCEV(&phi));
            auto* start = llvm::dyn_cast<llvm::Constant>(
                phi.getIncomingValueForBlock(loop_.getLoopPreheader()));
            if (form == nullptr || form->getLoop() != &loop_ || start == nullptr) continue;
            const auto* step =
                llvm::dyn_cast<llvm::SCEVConstant>(form->getStepRecurrence(evolution_));
            if (step == nullptr) continue;
            // It must not pass its end before the last step.
            const int64_t rounds = count->getAPInt().getSExtValue() + 1;
            const int64_t whole = rounds * step->getAPInt().getSExtValue();
            if (whole == 0 || std::abs(whole) > UINT16_MAX) continue;
            llvm::IRBuilder<> builder(&branch);
            llvm::Constant* end = llvm::ConstantExpr::getGetElementPtr(
                builder.getInt8Ty(), start,
                llvm::ConstantInt::getSigned(builder.getInt16Ty(), whole));
            Value* next = phi.getIncomingValueForBlock(latch);
            finish(branch, compare, next, end);
            return true;
        }
        return false;
    }

    /// The loop is left when both are equal.
    void finish(llvm::BranchInst& branch, ICmpInst& compare, Value* left, Value* right) {
        llvm::IRBuilder<> builder(&branch);
        const bool stays_if_true = loop_.contains(branch.getSuccessor(0));
        branch.setCondition(builder.CreateICmp(
            stays_if_true ? llvm::CmpInst::ICMP_NE : llvm::CmpInst::ICMP_EQ, left, right));
        evolution_.forgetLoop(&loop_);
        llvm::RecursivelyDeleteTriviallyDeadInstructions(&compare);
        llvm::DeleteDeadPHIs(loop_.getHeader());
    }

    void make(llvm::BasicBlock& block, llvm::BranchInst& branch, ICmpInst& compare,
              llvm::PHINode& old, const llvm::SCEV* stays, unsigned bits) {
        llvm::BasicBlock* before = loop_.getLoopPreheader();
        llvm::BasicBlock* latch = loop_.getLoopLatch();
        const bool at_end = &block == latch;
        llvm::Type* type = llvm::IntegerType::get(old.getContext(), bits);
        const llvm::SCEV* start = evolution_.getTruncateOrZeroExtend(stays, type);
        // At the end of the body the counter has been stepped once more.
        if (at_end) start = evolution_.getAddExpr(start, evolution_.getOne(type));
        const bool up = words_go_up_ && at_end && bits > 8;
        if (up) start = evolution_.getNegativeSCEV(start);
        Value* first = expander_.expandCodeFor(start, type, before->getTerminator());
        auto* phi = llvm::PHINode::Create(type, 2, "left", loop_.getHeader()->begin());
        llvm::IRBuilder<> builder(latch->getTerminator());
        Value* next = builder.CreateAdd(phi, llvm::ConstantInt::getSigned(type, up ? 1 : -1));
        phi->addIncoming(first, before);
        phi->addIncoming(next, latch);
        finish(branch, compare, at_end ? next : phi, llvm::ConstantInt::get(type, 0));
    }

    llvm::LoopInfo& loops_;
    llvm::ScalarEvolution& evolution_;
    llvm::TargetTransformInfo& costs_;
    llvm::Loop& loop_;
    bool words_go_up_;
    llvm::SCEVExpander expander_;
};

}  // namespace

const llvm::SCEV* cheap_exit_count(llvm::ScalarEvolution& evolution,
                                   const llvm::TargetTransformInfo& costs,
                                   llvm::SCEVExpander& expander, llvm::Loop& loop,
                                   llvm::BasicBlock& exit) {
    constexpr unsigned kCheap = 4;
    const llvm::SCEV* count = evolution.getExitCount(&loop, &exit);
    if (llvm::isa<llvm::SCEVCouldNotCompute>(count)) return nullptr;
    if (evolution.getUnsignedRangeMax(count).ugt(UINT16_MAX)) return nullptr;
    llvm::Instruction* before = loop.getLoopPreheader()->getTerminator();
    if (!expander.isSafeToExpandAt(count, before) ||
        expander.isHighCostExpansion({count}, &loop, kCheap, &costs, before)) {
        return nullptr;
    }
    return count;
}

static void count_to_zero(llvm::Function& function, bool words_go_up) {
    Analyses analyses(function);
    analyses.run(llvm::LoopSimplifyPass());
    for (llvm::Loop* loop : analyses.loops().getLoopsInPreorder()) {
        Counter(analyses, *loop, function.getParent()->getDataLayout(), words_go_up).run();
    }
}

void count_down(llvm::Function& function) {
    count_to_zero(function, false);
}

void count_words_up(llvm::Function& function) {
    count_to_zero(function, true);
}

void count_last(llvm::Function& function) {
    for (llvm::BasicBlock& block : function) {
        auto* branch = llvm::dyn_cast<llvm::BranchInst>(block.getTerminator());
        if (branch == nullptr || !branch->isConditional()) continue;
        auto* compare = llvm::dyn_cast<ICmpInst>(branch->getCondition());
        if (compare == nullptr || !compare->isEquality() || compare->getParent() != &block)
            continue;
        auto* step = llvm::dyn_cast<llvm::BinaryOperator>(compare->getOperand(0));
        const auto* zero = llvm::dyn_cast<llvm::ConstantInt>(compare->getOperand(1));
        if (step == nullptr || zero == nullptr || !zero->isZero() || step->getParent() != &block ||
            step->getOpcode() != llvm::Instruction::Add || !step->getType()->isIntegerTy(16)) {
            continue;
        }
        const auto* one = llvm::dyn_cast<llvm::ConstantInt>(step->getOperand(1));
        const bool used_here = std::any_of(step->user_begin(), step->user_end(), [&](auto* user) {
            const auto* at = llvm::cast<llvm::Instruction>(user);
            return user != compare && !llvm::isa<llvm::PHINode>(at) && at->getParent() == &block;
        });
        if (one == nullptr || !one->isOne() || used_here || !compare->hasOneUse()) continue;
        step->moveBefore(branch);
        compare->moveBefore(branch);
    }
}

}  // namespace toolchain::ir
