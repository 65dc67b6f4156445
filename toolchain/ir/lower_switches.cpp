// lower_switches.cpp - jump tables where cases are dense, trees of comparisons elsewhere; see
// passes.hpp.
// How          cases are sorted and cut into clusters: one value, a run of values with one target,
//              or a table. A tree decides between clusters: on the 8085 `CPI; JC; JZ` serves both
//              its comparisons with the same number.
// Depends on   libLLVM 19.
#include <llvm/IR/IRBuilder.h>
#include <llvm/IR/Instructions.h>

#include <algorithm>
#include <cstddef>
#include <map>
#include <span>
#include <vector>

#include "toolchain/ir/passes.hpp"

namespace toolchain::ir {

namespace {

using llvm::APInt;
using llvm::BasicBlock;

constexpr std::size_t kLeastCases = 5;
constexpr uint64_t kMostEntries = 128;
constexpr uint64_t kLeastPercent = 40;
constexpr std::size_t kLinear = 3;  // clusters that are compared one by one

struct Case {
    APInt value;
    BasicBlock* target;
};

struct Builder : llvm::IRBuilder<> {
    Builder(BasicBlock* block, const llvm::DebugLoc& place) : IRBuilder(block) {
        SetCurrentDebugLocation(place);
    }
};

/// Cases from `low` to `high`: all to one target, or a table.
struct Cluster {
    APInt low;
    APInt high;
    std::vector<Case> cases;  // more than one target: a table

    [[nodiscard]] bool is_table() const { return cases.size() > 1; }
};

class Lowering {
public:
    explicit Lowering(llvm::SwitchInst& instruction)
        : condition_(instruction.getCondition()),
          default_(instruction.getDefaultDest()),
          head_(instruction.getParent()),
          place_(instruction.getDebugLoc()) {
        for (const auto& entry : instruction.cases()) {
            cases_.push_back({entry.getCaseValue()->getValue(), entry.getCaseSuccessor()});
        }
        // Signed cases around 0 are dense only in signed order.
        const auto spread = [&](bool is_signed) {
            sort(is_signed);
            return cases_.back().value - cases_.front().value;
        };
        if (!cases_.empty()) {
            is_signed_ = spread(true).ult(spread(false));
            sort(is_signed_);
        }
        default_is_unreachable_ =
            llvm::isa<llvm::UnreachableInst>(*default_->getFirstNonPHIOrDbg());
    }

    void run(llvm::SwitchInst& instruction) {
        remember_phis(instruction);
        instruction.eraseFromParent();
        make_clusters();
        tree(head_, clusters_);
    }

private:
    void sort(bool is_signed) {
        std::sort(cases_.begin(), cases_.end(), [&](const Case& left, const Case& right) {
            return is_signed ? left.value.slt(right.value) : left.value.ult(right.value);
        });
    }

    // The values that phis get from the switch; its edges are taken away and made again.
    void remember_phis(llvm::SwitchInst& instruction) {
        for (BasicBlock* target : llvm::successors(&instruction)) {
            for (llvm::PHINode& phi : target->phis()) {
                const int index = phi.getBasicBlockIndex(head_);
                if (index < 0) continue;
                incoming_[target].push_back(
                    {&phi, phi.getIncomingValue(static_cast<unsigned>(index))});
                while (phi.getBasicBlockIndex(head_) >= 0) {
                    phi.removeIncomingValue(head_, false);
                }
            }
        }
    }

    void add_edge(BasicBlock* from, BasicBlock* target) {
        for (const auto& [phi, value] : incoming_[target]) phi->addIncoming(value, from);
    }

    // Longest dense stretch first: from every case the farthest one that makes a table.
    void make_clusters() {
        for (std::size_t from = 0; from < cases_.size();) {
            std::size_t end = from + 1;
            for (std::size_t to = cases_.size(); to >= from + kLeastCases; --to) {
                if (!dense(from, to)) continue;
                end = to;
                break;
            }
            const std::vector<Case> part(cases_.begin() + static_cast<std::ptrdiff_t>(from),
                                         cases_.begin() + static_cast<std::ptrdiff_t>(end));
            const bool joins = end == from + 1 && !clusters_.empty() &&
                               !clusters_.back().is_table() &&
                               clusters_.back().high + 1 == part[0].value &&
                               clusters_.back().cases[0].target == part[0].target;
            if (joins) {
                clusters_.back().high = part[0].value;
            } else {
                clusters_.push_back({part.front().value, part.back().value, part});
            }
            from = end;
        }
    }

    // Worth a table: many cases that are not runs of one target.
    [[nodiscard]] bool dense(std::size_t from, std::size_t to) const {
        const APInt spread = cases_[to - 1].value - cases_[from].value;
        if (spread.uge(kMostEntries)) return false;
        const uint64_t entries = spread.getZExtValue() + 1;
        std::size_t runs = 1;
        for (std::size_t i = from + 1; i < to; ++i) {
            const bool same = cases_[i].target == cases_[i - 1].target &&
                              cases_[i].value == cases_[i - 1].value + 1;
            if (!same) ++runs;
        }
        return runs >= kLeastCases && runs * 100 >= entries * kLeastPercent;
    }

    BasicBlock* new_block() const {
        return BasicBlock::Create(head_->getContext(), "", head_->getParent(),
                                  head_->getNextNode());
    }

    void jump(BasicBlock* from, BasicBlock* target) {
        Builder(from, place_).CreateBr(target);
        add_edge(from, target);
    }

    /// `taken` without a block of its own is a target with phis.
    void branch(BasicBlock* from, llvm::Value* condition, BasicBlock* taken, BasicBlock* other) {
        Builder(from, place_).CreateCondBr(condition, taken, other);
        add_edge(from, taken);
    }

    void tree(BasicBlock* block, std::span<const Cluster> clusters) {
        if (clusters.size() <= kLinear) {
            for (const Cluster& cluster : clusters) {
                const bool certain = default_is_unreachable_ && &cluster == &clusters.back();
                block = certain ? hit(block, cluster) : test(block, cluster);
            }
            if (block != nullptr) jump(block, default_);
            return;
        }
        const std::size_t middle = clusters.size() / 2;
        Builder builder(block, place_);
        llvm::Value* pivot = number(clusters[middle].low);
        llvm::Value* below = is_signed_ ? builder.CreateICmpSLT(condition_, pivot)
                                        : builder.CreateICmpULT(condition_, pivot);
        BasicBlock* left = new_block();
        BasicBlock* right = new_block();
        builder.CreateCondBr(below, left, right);
        tree(left, clusters.first(middle));
        tree(right, clusters.subspan(middle));
    }

    /// The block for what is not in the cluster.
    BasicBlock* test(BasicBlock* block, const Cluster& cluster) {
        Builder builder(block, place_);
        BasicBlock* next = new_block();
        if (!cluster.is_table() && cluster.low == cluster.high) {
            branch(block, builder.CreateICmpEQ(condition_, number(cluster.low)),
                   cluster.cases[0].target, next);
            return next;
        }
        llvm::Value* index = offset(builder, cluster);
        llvm::Value* inside = builder.CreateICmpULE(index, number(cluster.high - cluster.low));
        if (cluster.is_table()) {
            BasicBlock* inner = new_block();
            builder.CreateCondBr(inside, inner, next);
            table(inner, index, cluster);
        } else {
            branch(block, inside, cluster.cases[0].target, next);
        }
        return next;
    }

    /// All that is left is in the cluster.
    BasicBlock* hit(BasicBlock* block, const Cluster& cluster) {
        if (!cluster.is_table()) {
            jump(block, cluster.cases[0].target);
        } else {
            Builder builder(block, place_);
            table(block, offset(builder, cluster), cluster);
        }
        return nullptr;
    }

    llvm::Value* offset(Builder& builder, const Cluster& cluster) {
        if (cluster.low.isZero()) return condition_;
        return builder.CreateSub(condition_, number(cluster.low));
    }

    void table(BasicBlock* block, llvm::Value* index, const Cluster& cluster) {
        const auto entries = static_cast<unsigned>((cluster.high - cluster.low).getZExtValue() + 1);
        std::vector<BasicBlock*> targets(entries, default_);
        for (const Case& entry : cluster.cases) {
            targets[(entry.value - cluster.low).getZExtValue()] = entry.target;
        }
        Builder builder(block, place_);
        BasicBlock* never = new_block();
        Builder(never, place_).CreateUnreachable();
        llvm::Value* byte = builder.CreateZExtOrTrunc(index, builder.getInt8Ty());
        llvm::SwitchInst* jump = builder.CreateSwitch(byte, never, entries);
        for (unsigned i = 0; i < entries; ++i) {
            jump->addCase(builder.getInt8(static_cast<uint8_t>(i)), targets[i]);
            add_edge(block, targets[i]);
        }
    }

    [[nodiscard]] llvm::ConstantInt* number(const APInt& value) const {
        return llvm::ConstantInt::get(condition_->getContext(), value);
    }

    llvm::Value* condition_;
    BasicBlock* default_;
    BasicBlock* head_;
    llvm::DebugLoc place_;
    bool is_signed_ = false;
    bool default_is_unreachable_ = false;
    std::vector<Case> cases_;
    std::vector<Cluster> clusters_;
    std::map<BasicBlock*, std::vector<std::pair<llvm::PHINode*, llvm::Value*>>> incoming_;
};

}  // namespace

void lower_switches(llvm::Function& function) {
    std::vector<llvm::SwitchInst*> switches;
    for (BasicBlock& block : function) {
        if (auto* jump = llvm::dyn_cast<llvm::SwitchInst>(block.getTerminator())) {
            switches.push_back(jump);
        }
    }
    for (llvm::SwitchInst* jump : switches) Lowering(*jump).run(*jump);
}

}  // namespace toolchain::ir
