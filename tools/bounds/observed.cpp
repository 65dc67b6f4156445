// observed.cpp - see observed.hpp.
#include "tools/bounds/observed.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "host_sim/trace/execution_trace.hpp"

namespace rover_bounds {
namespace {

using host_sim::StepRecord;

constexpr std::size_t kViolationsMax = 50;

}  // namespace

Observer::Observer(const FlowProgram& program, const Bounds& bounds, uint32_t stack_end)
    : program_(program), bounds_(bounds), stack_end_(stack_end) {
    for (const auto& [entry, procedure] : program.graph().procedures) {
        for (const BoundedLoop& loop : program.loops(entry)) watch(procedure, loop);
    }
    std::ranges::stable_sort(loops_, {}, &WatchedLoop::address);
    loops_at_.assign(host_sim::kAddressSpaceSize, -1);
    for (std::size_t i = loops_.size(); i-- > 0;) {
        loops_at_[loops_[i].address] = static_cast<int32_t>(i);
    }
    for (const FlowFact& fact : program.table().facts) {
        auto& terms = facts_.emplace_back();
        for (const FlowTerm& term : fact.terms) {
            watch(term.item, items_);
            terms.emplace_back(items_++, term.factor);
        }
    }
    restart();
}

void Observer::watch(const Procedure& procedure, const BoundedLoop& loop) {
    WatchedLoop watched;
    watched.loop = &loop;
    watched.procedure = &procedure;
    watched.address = loop.loop.address;
    for (const std::size_t block : loop.loop.blocks) {
        const Block& range = procedure.blocks[block];
        watched.ranges.emplace_back(range.first, range.last);
    }
    loops_.push_back(std::move(watched));
}

void Observer::watch(const FlowItem& item, std::size_t index) {
    for (const auto& [entry, procedure] : program_.graph().procedures) {
        if (!item.fits(procedure.name)) continue;
        if (!item.loop) call_items_[entry].push_back(index);
        for (WatchedLoop& loop : loops_) {
            if (loop.procedure == &procedure && loop.loop->number == item.loop) {
                loop.items.push_back(index);
            }
        }
    }
}

void Observer::restart() {
    stack_.emplace(&program_.symbols(), static_cast<host_sim::CallListener&>(*this));
    activations_.clear();
    levels_.assign(1, Level{std::vector<int64_t>(items_), 0});
    waiting_ = 0;
    in_step_ = false;
}

void Observer::observe(const StepRecord& step, const host_sim::CpuState& after) {
    if (step.kind == StepRecord::Kind::instruction) {
        if (step.pc == 0) restart();
        if (step.pc == program_.step().entry) begin_step();
        if (!activations_.empty()) watch_loops(step.pc);
    }
    stack_->observe(step);
    if (step.pc >= program_.first()) watch_stack(after.sp);
}

/// The loader in front of the program has a stack of its own, in the same place.
void Observer::watch_stack(uint16_t sp) {
    const uint32_t used = stack_end_ - sp;
    if (sp <= stack_end_ && used > observed_.stack_bytes && used <= kDeepestBelievable) {
        observed_.stack_bytes = used;
        if (used > bounds_.stack.with_interrupts) {
            violated(fmt::format("stack: {} bytes, bound {}", used, bounds_.stack.with_interrupts));
        }
    }
}

void Observer::watch_loops(uint16_t pc) {
    Activation& activation = activations_.back();
    const int32_t first = loops_at_[pc];
    if (first >= 0) {
        for (auto i = static_cast<std::size_t>(first); i < loops_.size(); ++i) {
            if (loops_[i].address != pc) break;
            count_turn(loops_[i], activation);
        }
    }
    activation.last_pc = pc;
    activation.fresh = false;
}

void Observer::count_turn(WatchedLoop& loop, const Activation& activation) {
    const bool again = !activation.fresh && loop.holds(activation.last_pc);
    loop.turns = again ? loop.turns + 1 : 1;
    for (const std::size_t item : loop.items) ++levels_.back().counts[item];
    if (loop.loop->kind != LoopKind::turns || loop.turns <= loop.loop->most) return;
    violated(fmt::format("{}: {}, loop {}: more than {} turns",
                         source_place(program_.symbols(), loop.address), loop.procedure->name,
                         loop.loop->number, loop.loop->most));
}

void Observer::begin_step() {
    Level& level = levels_.front();
    if (in_step_) {
        ++observed_.steps;
        observed_.step_t = std::max(observed_.step_t, level.t);
        if (level.t > bounds_.step.t) {
            violated(fmt::format("step: {} T, bound {}", level.t, bounds_.step.t));
        }
        check_facts(level, "a step");
    }
    in_step_ = true;
    level = Level{std::vector<int64_t>(items_), 0};
}

void Observer::check_facts(const Level& level, const std::string& where) {
    for (std::size_t i = 0; i < facts_.size(); ++i) {
        int64_t sum = 0;
        for (const auto& [item, factor] : facts_[i]) sum += factor * level.counts[item];
        const FlowFact& fact = program_.table().facts[i];
        if (sum > fact.most) {
            violated(fmt::format("{}:{}: does not hold in {}: {}", program_.table().file, fact.line,
                                 where, fact.text));
        }
    }
}

void Observer::frame_begins(const host_sim::Frame& frame, bool called) {
    activations_.push_back({});
    if (frame.interrupt) {
        levels_.push_back(Level{std::vector<int64_t>(items_), 0});
        return;
    }
    if (frame.function == program_.wait()) ++waiting_;
    if (!called) return;
    const auto items = call_items_.find(frame.function);
    if (items == call_items_.end()) return;
    for (const std::size_t item : items->second) ++levels_.back().counts[item];
}

void Observer::frame_ends(const host_sim::Frame& frame) {
    activations_.pop_back();
    if (frame.interrupt) {
        const std::string name(host_sim::interrupt_name(frame.source));
        end_handler(name);
        return;
    }
    if (frame.function == program_.wait()) {
        --waiting_;
        return;
    }
    uint64_t& most = observed_.function_t[frame.function];
    if (frame.t_inside <= most) return;
    most = frame.t_inside;
    const auto bound = bounds_.function_t.find(frame.function);
    if (bound == bounds_.function_t.end() || !bound->second || most <= *bound->second) return;
    violated(fmt::format("{}: {} T, bound {}", program_.graph().at(frame.function).name, most,
                         *bound->second));
}

void Observer::end_handler(const std::string& name) {
    const Level level = std::move(levels_.back());
    levels_.pop_back();
    uint64_t& most = observed_.handler_t[name];
    most = std::max(most, level.t);
    const auto bound = bounds_.handler_t.find(name);
    if (bound == bounds_.handler_t.end() || level.t > bound->second) {
        violated(fmt::format("{}: {} T, more than its bound", name, level.t));
    }
    check_facts(level, name);
}

void Observer::time_passes(const host_sim::Frame&, uint64_t t) {
    if (levels_.size() > 1 || waiting_ == 0) levels_.back().t += t;
}

void Observer::violated(std::string what) {
    if (observed_.violations.size() < kViolationsMax) observed_.violations.insert(std::move(what));
}

}  // namespace rover_bounds
