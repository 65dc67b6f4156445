// bounds.cpp - see bounds.hpp.
#include "tools/bounds/bounds.hpp"

#include <algorithm>
#include <utility>

#include "tools/budget/budget_error.hpp"

namespace rover_bounds {
namespace {

constexpr uint64_t kAcceptT = 12;

/// The handlers by name. @errors BudgetError: the image lacks one
Workload workload_of(const FlowProgram& program, const Bounds& bounds) {
    const auto handler = [&](const char* name) {
        const auto found = bounds.handler_t.find(name);
        if (found != bounds.handler_t.end()) return found->second;
        throw rover_budget::BudgetError(program.table().file, 0,
                                        std::string("the image has no handler of ") + name,
                                        "give an image of this rover");
    };
    Workload load;
    load.trap = handler("TRAP");
    load.tick = handler("RST 7.5");
    load.receive = handler("RST 6.5");
    load.transmit = handler("RST 5.5");
    load.step = bounds.step.t;
    load.wake = bounds.function_t.at(program.wait()).value_or(0);
    for (std::size_t i = 0; i < bounds.disabled.size(); ++i) {
        const DisabledStretch& stretch = bounds.disabled[i];
        if (i >= program.handlers().size()) {
            load.main_disabled = std::max<uint64_t>(load.main_disabled, stretch.t);
        } else if (stretch.place == "RST 7.5") {
            load.tick_disabled = stretch.t;
        }
    }
    return load;
}

}  // namespace

Bounds find_bounds(const FlowProgram& program, const Timing& timing) {
    Bounds bounds;
    for (const auto& [entry, procedure] : program.graph().procedures) {
        const auto path = longest_path(program, entry);
        std::optional<uint64_t>& t = bounds.function_t[entry];
        if (path) t = path->t;
    }
    for (const Handler& handler : program.handlers()) {
        const auto& t = bounds.function_t.at(handler.vector);
        if (!t) {
            throw rover_budget::BudgetError(handler.name, 0, "its handler never ends",
                                            "let it return");
        }
        bounds.handler_t[handler.name] = kAcceptT + *t;
    }
    bounds.step = longest_step(program);
    bounds.stack = stack_bound(program);
    bounds.disabled = disabled_stretches(program);
    bounds.deadlines = deadlines(workload_of(program, bounds), timing);
    return bounds;
}

rover_budget::Numbers numbers_of(const Bounds& bounds) {
    rover_budget::Numbers numbers;
    numbers["bound.step"] = bounds.step.t;
    for (const auto& [name, t] : bounds.handler_t) numbers["bound.handler." + name] = t;
    numbers["bound.stack"] = bounds.stack.with_interrupts;
    for (const DisabledStretch& stretch : bounds.disabled) {
        uint64_t& longest = numbers["bound.disabled"];
        if (!bounds.handler_t.contains(stretch.place))
            longest = std::max<uint64_t>(longest, stretch.t);
    }
    for (const Deadline& deadline : bounds.deadlines) {
        if (deadline.response_t) numbers["bound.response." + deadline.what] = *deadline.response_t;
    }
    return numbers;
}

}  // namespace rover_bounds
