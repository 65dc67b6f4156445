// loop_bounds.cpp - see loop_bounds.hpp.
#include "toolchain/ir/loop_bounds.hpp"

#include <fmt/format.h>
#include <llvm/Analysis/BlockFrequencyInfo.h>
#include <llvm/Analysis/BranchProbabilityInfo.h>
#include <llvm/Analysis/LoopInfo.h>
#include <llvm/Analysis/ScalarEvolution.h>
#include <llvm/IR/CFG.h>
#include <llvm/IR/Dominators.h>
#include <llvm/IR/InstIterator.h>
#include <llvm/IR/Instructions.h>
#include <llvm/IR/Module.h>
#include <llvm/Transforms/Utils/LoopUtils.h>

#include <algorithm>
#include <vector>

#include "toolchain/ir/analyses.hpp"
#include "toolchain/ir/refuse.hpp"

namespace toolchain::ir {

namespace {

constexpr const char* kCall = "__i85_loop_bound";
// Notes on a loop: its bound; the product with those of the loops inside (0: not all known); how
// many loops are inside. LLVM may let loops share a header, and then keeps the notes of one of
// them.
constexpr const char* kBound = "i85.loop.bound";
constexpr const char* kWhole = "i85.loop.whole";
constexpr const char* kInner = "i85.loop.inner";

unsigned note_of(const llvm::Loop& loop, const char* key) {
    const auto note = llvm::getOptionalIntLoopAttribute(&loop, key);
    return note ? static_cast<unsigned>(*note) : 0;
}

unsigned loops_inside(const llvm::Loop& loop) {
    unsigned count = 0;
    for (const llvm::Loop* inner : loop) count += 1 + loops_inside(*inner);
    return count;
}

void take_bound(llvm::CallBase& call, const llvm::LoopInfo& loops) {
    llvm::Loop* loop = loops.getLoopFor(call.getParent());
    if (loop == nullptr) {
        refuse(call, fmt::format("{} is not in a loop: call it in the body that repeats", kCall));
    }
    const auto* number =
        call.arg_size() == 1 ? llvm::dyn_cast<llvm::ConstantInt>(call.getArgOperand(0)) : nullptr;
    if (number == nullptr || number->isZero()) {
        refuse(call, fmt::format("{} needs a constant from 1 on", kCall));
    }
    auto bound = static_cast<unsigned>(number->getZExtValue());
    const unsigned known = note_of(*loop, kBound);
    if (known != 0) bound = std::min(bound, known);
    llvm::addStringMetadataToLoop(loop, kBound, bound);
    call.eraseFromParent();
}

/// Executions of the innermost header for each entry; 0: unknown.
unsigned note_whole(llvm::Loop& loop) {
    uint64_t inner = 1;
    bool known = true;
    for (llvm::Loop* child : loop) {
        const unsigned whole = note_whole(*child);
        known = known && whole != 0;
        inner = std::max<uint64_t>(inner, whole);
    }
    const uint64_t whole = inner * note_of(loop, kBound);
    if (!known || whole == 0 || whole > INT32_MAX) return 0;
    llvm::addStringMetadataToLoop(&loop, kWhole, static_cast<unsigned>(whole));
    return static_cast<unsigned>(whole);
}

/// Executions of the header. A loop that tests at its top runs it once more than its body.
uint32_t noted_bound(const llvm::Loop& loop) {
    unsigned bound = note_of(loop, kBound);
    if (loops_inside(loop) < note_of(loop, kInner)) bound = note_of(loop, kWhole);
    if (bound == 0) return 0;
    const llvm::BasicBlock* latch = loop.getLoopLatch();
    const bool tests_at_bottom = latch != nullptr && loop.isLoopExiting(latch);
    const bool once_more = loop.isLoopExiting(loop.getHeader()) && !tests_at_bottom;
    return bound + (once_more ? 1 : 0);
}

/// Executions of the header for each entry into the loop, as LLVM's frequencies have it.
double assumed_iterations(const llvm::Loop& loop, const llvm::BlockFrequencyInfo& frequencies,
                          const llvm::BranchProbabilityInfo& probabilities) {
    const auto count = [&](const llvm::BasicBlock* block) {
        return static_cast<double>(frequencies.getBlockFreq(block).getFrequency());
    };
    double entries = 0;
    for (const llvm::BasicBlock* before : llvm::predecessors(loop.getHeader())) {
        if (loop.contains(before)) continue;
        const auto part = probabilities.getEdgeProbability(before, loop.getHeader());
        entries += count(before) * part.getNumerator() / part.getDenominator();
    }
    return entries <= 0 ? 1 : std::max(1.0, count(loop.getHeader()) / entries);
}

}  // namespace

void take_loop_bounds(llvm::Module& module) {
    llvm::Function* note = module.getFunction(kCall);
    if (note == nullptr) return;
    for (llvm::Function& function : module) {
        std::vector<llvm::CallBase*> calls;
        for (llvm::Instruction& instruction : llvm::instructions(function)) {
            auto* call = llvm::dyn_cast<llvm::CallBase>(&instruction);
            if (call != nullptr && call->getCalledOperand() == note) calls.push_back(call);
        }
        if (calls.empty()) continue;
        const llvm::DominatorTree dominators(function);
        llvm::LoopInfo loops(dominators);
        for (llvm::CallBase* call : calls) take_bound(*call, loops);
        for (llvm::Loop* loop : loops) note_whole(*loop);
        for (llvm::Loop* loop : loops.getLoopsInPreorder()) {
            if (note_of(*loop, kBound) == 0 || loop->isInnermost()) continue;
            llvm::addStringMetadataToLoop(loop, kInner, loops_inside(*loop));
        }
    }
    if (note->use_empty()) note->eraseFromParent();
}

std::map<const llvm::BasicBlock*, BlockFacts> block_facts(const llvm::Function& function) {
    constexpr double kUnknownIterations = 10;
    // The analyses keep nothing in the function.
    Analyses analyses(const_cast<llvm::Function&>(function));
    auto& loops = analyses.get<llvm::LoopAnalysis>();
    auto& evolution = analyses.get<llvm::ScalarEvolutionAnalysis>();
    const auto& frequencies = analyses.get<llvm::BlockFrequencyAnalysis>();
    const auto& probabilities = analyses.get<llvm::BranchProbabilityAnalysis>();
    const llvm::DominatorTree& dominators = analyses.get<llvm::DominatorTreeAnalysis>();

    std::map<const llvm::BasicBlock*, BlockFacts> facts;
    const auto entry =
        static_cast<double>(frequencies.getBlockFreq(&function.getEntryBlock()).getFrequency());
    for (const llvm::BasicBlock& block : function) {
        if (!dominators.isReachableFromEntry(&block)) continue;
        BlockFacts& fact = facts[&block];
        const auto count = static_cast<double>(frequencies.getBlockFreq(&block).getFrequency());
        fact.frequency = count / std::max(1.0, entry);
        fact.loop_depth = loops.getLoopDepth(&block);
    }
    for (llvm::Loop* loop : loops.getLoopsInPreorder()) {
        const uint32_t exact = evolution.getSmallConstantTripCount(loop);
        const uint32_t proven = evolution.getSmallConstantMaxTripCount(loop);
        const uint32_t noted = noted_bound(*loop);
        const uint32_t bound = proven == 0 ? noted : noted == 0 ? proven : std::min(noted, proven);
        facts[loop->getHeader()].loop_bound = bound;
        double iterations = exact;
        if (exact == 0)
            iterations =
                bound == 0 ? kUnknownIterations : std::min<double>(kUnknownIterations, bound);
        const double factor = iterations / assumed_iterations(*loop, frequencies, probabilities);
        for (const llvm::BasicBlock* block : loop->blocks()) facts[block].frequency *= factor;
    }
    return facts;
}

}  // namespace toolchain::ir
