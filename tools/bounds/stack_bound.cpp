// stack_bound.cpp - see stack_bound.hpp.
#include "tools/bounds/stack_bound.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <tuple>

#include "tools/budget/budget_error.hpp"

namespace rover_bounds {
namespace {

using rover_budget::BudgetError;
using toolchain::isa::Flow;

constexpr uint32_t kReturnAddress = 2;
constexpr uint32_t kAcceptT = 12;
constexpr uint8_t kEi = 0xFB;
constexpr uint8_t kDi = 0xF3;

/// The interrupt enable flip-flop.
enum class Enable : uint8_t { off, soon, on };

Enable behind(Enable before, uint8_t opcode) {
    if (opcode == kDi) return Enable::off;
    if (opcode == kEi) return Enable::soon;
    return before == Enable::soon ? Enable::on : before;
}

[[noreturn]] void refuse(const FlowProgram& program, uint16_t address, const std::string& what,
                         const char* advice) {
    throw BudgetError(source_place(program.symbols(), address), 0, what, advice);
}

/// Where it goes on behind an instruction within a function.
struct Next {
    std::vector<uint16_t> addresses;
    bool returns = false;
    bool calls = false;  ///< a callee runs before `addresses`, if it is called
};

Next next_of(const Decoded& at) {
    const bool conditional = at.entry->conditional();
    switch (at.entry->flow) {
        case Flow::jump:
            if (conditional) return {{at.behind(), at.operand}, false, false};
            return {{at.operand}, false, false};
        case Flow::call:
            return {{at.behind()}, false, true};
        case Flow::ret:
            if (conditional) return {{at.behind()}, true, false};
            return {{}, true, false};
        default:
            return {{at.behind()}, false, false};
    }
}

// -- Stack ---------------------------------------------------------------------------------------

/// Deepest bytes by whether interrupts can be accepted, its own return address left out.
struct Depth {
    uint32_t disabled = 0, enabled = 0;
    std::set<Enable> after;  ///< in which it returns

    void take(uint32_t bytes, Enable enable) {
        uint32_t& most = enable == Enable::on ? enabled : disabled;
        most = std::max(most, bytes);
    }
};

class DepthFinder {
public:
    explicit DepthFinder(const FlowProgram& program) : program_(program) {}

    /// Of a call that begins with interrupts in a state.
    const Depth& of(uint16_t entry, Enable enable) {
        const auto key = std::make_pair(entry, enable);
        const auto known = known_.find(key);
        if (known != known_.end()) return known->second;
        if (!open_.insert(entry).second) {
            refuse(program_, entry, "the function calls itself", "write it as a loop");
        }
        Depth depth = follow(entry, enable);
        open_.erase(entry);
        return known_[key] = std::move(depth);
    }

private:
    using Place = std::tuple<uint16_t, Enable, uint32_t>;

    Depth follow(uint16_t entry, Enable enable) {
        Depth depth;
        std::set<Place> seen;
        std::vector<Place> open = {{entry, enable, 0}};
        while (!open.empty()) {
            const Place place = open.back();
            open.pop_back();
            if (!seen.insert(place).second) continue;
            if (seen.size() > kPlacesMax) {
                refuse(program_, entry, "its stack grows without end", "pop what is pushed");
            }
            step(place, depth, open);
        }
        return depth;
    }

    void step(const Place& place, Depth& depth, std::vector<Place>& open) {
        const auto& [address, enable, bytes] = place;
        depth.take(bytes, enable);
        const Decoded at = decode(program_.source(), address);
        const Enable then = behind(enable, at.entry->opcode);
        const uint32_t pushed = moved(at, bytes);
        const Next next = next_of(at);
        if (next.returns) {
            if (bytes != 0) {
                refuse(program_, address, "it returns with bytes pushed", "pop what is pushed");
            }
            depth.after.insert(then);
        }
        if (!next.calls) {
            for (const uint16_t to : next.addresses) open.emplace_back(to, then, pushed);
            return;
        }
        const uint16_t to = next.addresses.front();
        if (at.entry->conditional()) open.emplace_back(to, then, bytes);
        const Depth& below = of(at.operand, then);
        depth.take(bytes + kReturnAddress + below.disabled, Enable::off);
        if (has_enabled(below, then)) {
            depth.take(bytes + kReturnAddress + below.enabled, Enable::on);
        }
        for (const Enable after : below.after) open.emplace_back(to, after, bytes);
    }

    static bool has_enabled(const Depth& below, Enable at_call) {
        return at_call == Enable::on || below.enabled != 0 || below.after.contains(Enable::on);
    }

    uint32_t moved(const Decoded& at, uint32_t bytes) const {
        const std::string_view mnemonic = at.entry->mnemonic();
        if (mnemonic == "PUSH") return bytes + 2;
        if (mnemonic == "POP") {
            if (bytes < 2)
                refuse(program_, at.address, "it pops what it has not pushed", "see why");
            return bytes - 2;
        }
        const bool moves = mnemonic == "SPHL" || at.entry->text() == "LXI SP,d16" ||
                           at.entry->text() == "INX SP" || at.entry->text() == "DCX SP";
        if (moves) refuse(program_, at.address, "it sets SP", "use PUSH and POP");
        return bytes;
    }

    static constexpr std::size_t kPlacesMax = 100'000;
    const FlowProgram& program_;
    std::map<std::pair<uint16_t, Enable>, Depth> known_;
    std::set<uint16_t> open_;
};

// -- Time with interrupts disabled ----------------------------------------------------------------

class StretchFinder {
public:
    /// @param handler  returning ends the stretch: TRAP leaves the flip-flop as it was
    StretchFinder(const FlowProgram& program, bool handler)
        : program_(program), handler_(handler) {}

    /// Most T-states from an instruction on until interrupts are accepted again.
    uint32_t from(uint16_t address, Enable enable) {
        callers_.clear();
        return longest(address, enable);
    }

private:
    uint32_t longest(uint16_t address, Enable enable) {
        if (enable == Enable::on) return 0;
        if (!open_.insert({address, callers_.size()}).second) {
            refuse(program_, address, "a loop runs with interrupts disabled", "enable them first");
        }
        const uint32_t t = longest_from(address, enable);
        open_.erase({address, callers_.size()});
        return t;
    }

    uint32_t longest_from(uint16_t address, Enable enable) {
        const Decoded at = decode(program_.source(), address);
        const Enable then = behind(enable, at.entry->opcode);
        const Next next = next_of(at);
        uint32_t most = 0;
        if (next.calls) {
            most = at.entry->t_taken + call(at.operand, at.behind(), then);
            if (at.entry->conditional()) {
                most = std::max(most, at.entry->t_not_taken + longest(at.behind(), then));
            }
            return most;
        }
        if (next.returns) most = at.entry->t_taken + give_back(address, then);
        for (const uint16_t to : next.addresses) {
            const bool behind = to == at.behind() && at.entry->conditional();
            const uint32_t t = behind ? at.entry->t_not_taken : at.entry->t_taken;
            most = std::max(most, t + longest(to, then));
        }
        return most;
    }

    uint32_t call(uint16_t callee, uint16_t back, Enable enable) {
        if (enable == Enable::on) return 0;
        callers_.push_back(back);
        const uint32_t t = longest(callee, enable);
        callers_.pop_back();
        return t;
    }

    uint32_t give_back(uint16_t address, Enable enable) {
        if (enable == Enable::on) return 0;
        if (callers_.empty()) {
            if (handler_) return 0;
            refuse(program_, address, "it returns with interrupts disabled", "enable them before");
        }
        const uint16_t back = callers_.back();
        callers_.pop_back();
        const uint32_t t = longest(back, enable);
        callers_.push_back(back);
        return t;
    }

    const FlowProgram& program_;
    bool handler_;
    std::vector<uint16_t> callers_;
    std::set<std::pair<uint16_t, std::size_t>> open_;
};

/// Addresses of DI in the step and in what it calls.
std::set<uint16_t> disables_of_step(const FlowProgram& program) {
    std::vector<const Procedure*> procedures = {&program.step()};
    for (const Edge& edge : program.step().edges) {
        if (!edge.callee) continue;
        for (const uint16_t entry : program.graph().reached_from(*edge.callee)) {
            procedures.push_back(&program.graph().at(entry));
        }
    }
    std::set<uint16_t> found;
    for (const Procedure* procedure : procedures) {
        for (const Block& block : procedure->blocks) {
            for (uint16_t at = block.first; at <= block.last;) {
                const Decoded one = decode(program.source(), at);
                if (one.entry->opcode == kDi) found.insert(at);
                at = one.behind();
            }
        }
    }
    return found;
}

}  // namespace

StackBound stack_bound(const FlowProgram& program) {
    DepthFinder finder(program);
    StackBound bound;
    const Depth& main = finder.of(program.main(), Enable::off);
    bound.parts.push_back({"main", main.disabled + kReturnAddress, main.enabled + kReturnAddress});
    uint32_t trap = 0, above_tick = 0, tick = 0;
    for (const Handler& handler : program.handlers()) {
        const Depth& depth = finder.of(handler.vector, Enable::off);
        const bool enables = handler.name == "RST 7.5";
        if (!enables && depth.enabled != 0) {
            refuse(program, handler.vector, handler.name + " enables interrupts before its end",
                   "it would be entered a second time behind a tick; only the tick may");
        }
        bound.parts.push_back({handler.name, depth.disabled + kReturnAddress,
                               enables ? depth.enabled + kReturnAddress : 0});
        const StackBound::Part& part = bound.parts.back();
        if (handler.name == "TRAP") trap = std::max(part.disabled, part.enabled);
        if (enables) tick = part.enabled;
        if (handler.name == "RST 6.5" || handler.name == "RST 5.5") {
            above_tick = std::max(above_tick, part.disabled + trap);
        }
        if (enables) bound.with_interrupts = part.disabled + trap;  // before its EI
    }
    const uint32_t nested =
        std::max({bound.with_interrupts, tick + std::max(trap, above_tick), above_tick, trap});
    bound.with_interrupts =
        std::max(bound.parts[0].enabled + nested, bound.parts[0].disabled + trap);
    return bound;
}

std::vector<DisabledStretch> disabled_stretches(const FlowProgram& program) {
    std::vector<DisabledStretch> stretches;
    for (const Handler& handler : program.handlers()) {
        const uint32_t t = StretchFinder(program, true).from(handler.vector, Enable::off);
        stretches.push_back({handler.name, kAcceptT + t});
    }
    for (const uint16_t address : disables_of_step(program)) {
        const host_sim::Symbol* function = program.symbols().function_at(address);
        const std::string place = function == nullptr ? "step" : function->name;
        stretches.push_back({fmt::format("{}, DI at {:04X}H", place, address),
                             StretchFinder(program, false).from(address, Enable::off)});
    }
    return stretches;
}

}  // namespace rover_bounds
