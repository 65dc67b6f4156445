// step_pointers.cpp - addresses that grow by the same amount each time around a loop are stepped,
// not computed from the counter; see passes.hpp.
// Why          the 8085 has no index: `a[i]` of words costs two DADs and a constant, an address
// that
//              is kept costs two INX. LLVM's own pass prefers base plus index.
// How          ScalarEvolution gives {start, +, step}; addresses with the same step and a constant
//              distance share one stepped pointer. Products of the counter likewise.
// Depends on   libLLVM 19.
#include <llvm/Analysis/ScalarEvolutionExpressions.h>
#include <llvm/Analysis/ValueTracking.h>
#include <llvm/IR/IRBuilder.h>
#include <llvm/IR/Instructions.h>
#include <llvm/IR/Module.h>
#include <llvm/Transforms/Scalar/LoopPassManager.h>
#include <llvm/Transforms/Utils/BasicBlockUtils.h>
#include <llvm/Transforms/Utils/Local.h>
#include <llvm/Transforms/Utils/LoopSimplify.h>
#include <llvm/Transforms/Utils/ScalarEvolutionExpander.h>

#include <algorithm>
#include <optional>
#include <vector>

#include "toolchain/ir/analyses.hpp"
#include "toolchain/ir/exit_count.hpp"
#include "toolchain/ir/passes.hpp"

namespace toolchain::ir {

namespace {

using llvm::Instruction;
using llvm::SCEVAddRecExpr;

/// An address in a register needs two; that of a constant table needs none when it is computed.
constexpr std::size_t kMostConstant = 1;

/// Values with one step and constant distances.
struct Group {
    const SCEVAddRecExpr* first = nullptr;
    llvm::PHINode* phi = nullptr;
    std::vector<std::pair<Instruction*, int64_t>> members;  ///< with distance from `first`
};

class Stepper {
public:
    Stepper(Analyses& analyses, llvm::Loop& loop, const llvm::DataLayout& layout)
        : loops_(analyses.loops()),
          evolution_(analyses.evolution()),
          costs_(analyses.get<llvm::TargetIRAnalysis>()),
          loop_(loop),
          expander_(evolution_, layout, "step") {
        expander_.disableCanonicalMode();
    }

    void run() {
        if (loop_.getLoopPreheader() == nullptr || loop_.getLoopLatch() == nullptr) return;
        for (llvm::PHINode& phi : loop_.getHeader()->phis()) add_phi(phi);
        for (llvm::BasicBlock* block : loop_.blocks()) {
            if (loops_.getLoopFor(block) != &loop_) continue;
            for (Instruction& instruction : *block) add(instruction);
        }
        drop_unprofitable();
        for (Group& group : groups_) replace(group);
        llvm::DeleteDeadPHIs(loop_.getHeader());
    }

private:
    const SCEVAddRecExpr* recurrence(Instruction& instruction) {
        if (!evolution_.isSCEVable(instruction.getType())) return nullptr;
        const auto* form = llvm::dyn_cast<SCEVAddRecExpr>(evolution_.getSCEV(&instruction));
        if (form == nullptr || form->getLoop() != &loop_ || !form->isAffine()) return nullptr;
        return form;
    }

    std::optional<int64_t> distance(const SCEVAddRecExpr* from, const SCEVAddRecExpr* to) {
        if (from->getType() != to->getType() ||
            from->getStepRecurrence(evolution_) != to->getStepRecurrence(evolution_)) {
            return std::nullopt;
        }
        const auto* number = llvm::dyn_cast<llvm::SCEVConstant>(
            evolution_.getMinusSCEV(to->getStart(), from->getStart()));
        if (number == nullptr) return std::nullopt;
        return number->getAPInt().getSExtValue();
    }

    void add_phi(llvm::PHINode& phi) {
        if (const SCEVAddRecExpr* form = recurrence(phi)) groups_.push_back({form, &phi, {}});
    }

    void add(Instruction& instruction) {
        const bool address = llvm::isa<llvm::GetElementPtrInst>(instruction);
        if (!address && instruction.getOpcode() != Instruction::Mul) return;
        // Parts of other addresses go with those; a phi's next value is a step already.
        const auto is_part = [&](const llvm::User* user) {
            const auto* phi = llvm::dyn_cast<llvm::PHINode>(user);
            return llvm::isa<llvm::GetElementPtrInst>(user) ||
                   (phi != nullptr && phi->getParent() == loop_.getHeader());
        };
        if (std::all_of(instruction.user_begin(), instruction.user_end(), is_part)) return;
        const SCEVAddRecExpr* form = recurrence(instruction);
        if (form == nullptr) return;
        const llvm::SCEV* step = form->getStepRecurrence(evolution_);
        Instruction* before = loop_.getLoopPreheader()->getTerminator();
        if (!expander_.isSafeToExpandAt(form->getStart(), before) ||
            !expander_.isSafeToExpandAt(step, before)) {
            return;
        }
        for (Group& group : groups_) {
            const auto away = distance(group.first, form);
            if (!away) continue;
            // The next value of a phi is made at the end of the loop.
            if (group.phi != nullptr && is_next(instruction, *group.phi)) return;
            group.members.emplace_back(&instruction, *away);
            return;
        }
        groups_.push_back({form, nullptr, {{&instruction, 0}}});
    }

    // -- Which of them pay: those that free the counter they are computed from. -------------------

    [[nodiscard]] bool is_member(const llvm::User* user) const {
        return std::any_of(groups_.begin(), groups_.end(), [&](const Group& group) {
            return std::any_of(group.members.begin(), group.members.end(),
                               [&](const auto& member) { return member.first == user; });
        });
    }

    /// Is the value used for nothing but members, its own next value and the end of the loop?
    [[nodiscard]] bool serves_members(const llvm::Value& value, unsigned depth = 0) {
        constexpr unsigned kDeepest = 6;
        if (depth > kDeepest) return false;
        return std::all_of(value.user_begin(), value.user_end(), [&](const llvm::User* user) {
            const auto* instruction = llvm::cast<Instruction>(user);
            if (is_member(user)) return true;
            if (!loop_.contains(instruction)) return false;
            if (llvm::isa<llvm::PHINode>(user))
                return instruction->getParent() == loop_.getHeader();
            if (llvm::isa<llvm::ICmpInst>(user)) {
                return user->hasOneUse() && llvm::isa<llvm::BranchInst>(*user->user_begin()) &&
                       loop_.isLoopExiting(
                           llvm::cast<Instruction>(*user->user_begin())->getParent()) &&
                       counts(*llvm::cast<Instruction>(*user->user_begin())->getParent());
            }
            const bool passes_on = llvm::isa<llvm::CastInst>(user) ||
                                   llvm::isa<llvm::BinaryOperator>(user) ||
                                   llvm::isa<llvm::GetElementPtrInst>(user);
            return passes_on && serves_members(*instruction, depth + 1);
        });
    }

    /// Will count_down() free the counter of that comparison?
    [[nodiscard]] bool counts(const llvm::BasicBlock& exit) {
        return cheap_exit_count(evolution_, costs_, expander_, loop_,
                                const_cast<llvm::BasicBlock&>(exit)) != nullptr;
    }

    /// Are all counters that the value is computed from freed?
    [[nodiscard]] bool frees_counters(const llvm::Value& value, unsigned depth = 0) {
        const auto* instruction = llvm::dyn_cast<Instruction>(&value);
        if (instruction == nullptr || !loop_.contains(instruction)) return true;
        if (llvm::isa<llvm::PHINode>(instruction)) {
            return instruction->getType()->isIntegerTy() && serves_members(value);
        }
        constexpr unsigned kDeepest = 6;
        return depth <= kDeepest &&
               std::all_of(instruction->op_begin(), instruction->op_end(),
                           [&](const llvm::Use& use) { return frees_counters(*use, depth + 1); });
    }

    [[nodiscard]] bool starts_at_constant(const Group& group) const {
        return llvm::isa<llvm::Constant>(llvm::getUnderlyingObject(group.members[0].first));
    }

    void drop_unprofitable() {
        for (bool changed = true; changed;) {
            changed = false;
            std::size_t from_constants = 0;
            for (Group& group : groups_) {
                if (group.phi == nullptr && !group.members.empty() && starts_at_constant(group))
                    ++from_constants;
            }
            for (Group& group : groups_) {
                if (group.members.empty() || group.phi != nullptr) continue;
                const bool too_many = starts_at_constant(group) && from_constants > kMostConstant;
                const bool frees =
                    std::all_of(group.members.begin(), group.members.end(),
                                [&](const auto& member) { return frees_counters(*member.first); });
                if (frees && !too_many) continue;
                group.members.clear();
                changed = true;
            }
        }
    }

    [[nodiscard]] bool is_next(const Instruction& instruction, const llvm::PHINode& phi) const {
        return phi.getIncomingValueForBlock(loop_.getLoopLatch()) == &instruction;
    }

    void replace(Group& group) {
        if (group.members.empty()) return;
        if (group.phi == nullptr) make_phi(group);
        for (const auto& [instruction, away] : group.members) {
            llvm::Value* value = group.phi;
            llvm::IRBuilder<> builder(instruction);
            if (away != 0) {
                auto* number = llvm::ConstantInt::getSigned(
                    value->getType()->isPointerTy() ? builder.getInt16Ty() : value->getType(),
                    away);
                value = value->getType()->isPointerTy() ? builder.CreatePtrAdd(value, number)
                                                        : builder.CreateAdd(value, number);
            }
            evolution_.forgetValue(instruction);
            instruction->replaceAllUsesWith(value);
            llvm::RecursivelyDeleteTriviallyDeadInstructions(instruction);
        }
    }

    void make_phi(Group& group) {
        llvm::Type* type = group.first->getType();
        llvm::BasicBlock* before = loop_.getLoopPreheader();
        llvm::BasicBlock* latch = loop_.getLoopLatch();
        const llvm::SCEV* step = group.first->getStepRecurrence(evolution_);
        llvm::Value* start =
            expander_.expandCodeFor(group.first->getStart(), type, before->getTerminator());
        llvm::Value* amount =
            expander_.expandCodeFor(step, step->getType(), before->getTerminator());
        group.phi = llvm::PHINode::Create(type, 2, "step", loop_.getHeader()->begin());
        llvm::IRBuilder<> builder(latch->getTerminator());
        llvm::Value* next = type->isPointerTy() ? builder.CreatePtrAdd(group.phi, amount)
                                                : builder.CreateAdd(group.phi, amount);
        group.phi->addIncoming(start, before);
        group.phi->addIncoming(next, latch);
    }

    llvm::LoopInfo& loops_;
    llvm::ScalarEvolution& evolution_;
    llvm::TargetTransformInfo& costs_;
    llvm::Loop& loop_;
    llvm::SCEVExpander expander_;
    std::vector<Group> groups_;
};

}  // namespace

void step_pointers(llvm::Function& function) {
    Analyses analyses(function);
    analyses.run(llvm::LoopSimplifyPass());
    auto loops = analyses.loops().getLoopsInPreorder();
    for (llvm::Loop* loop : llvm::reverse(loops)) {
        Stepper(analyses, *loop, function.getParent()->getDataLayout()).run();
    }
}

}  // namespace toolchain::ir
