// breakpoints.cpp - see breakpoints.hpp.
#include "tools/debug/breakpoints.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

#include "host_sim/trace/execution_trace.hpp"
#include "toolchain/isa/disassemble.hpp"
#include "tools/debug/debug_error.hpp"

namespace debug_console {

using host_sim::BoardState;
using host_sim::BusAccess;
using host_sim::StepRecord;
using toolchain::isa::intel_hex;

std::string interrupt_name(StepRecord::Kind kind) {
    const std::string_view name = host_sim::interrupt_name(kind);
    return name.empty() ? "any interrupt" : std::string(name);
}

const BusAccess* matching_access(const Breakpoint& breakpoint, const StepRecord& record) {
    const bool port = breakpoint.kind == Breakpoint::Kind::port;
    const auto read = port ? BusAccess::Kind::in : BusAccess::Kind::read;
    const auto write = port ? BusAccess::Kind::out : BusAccess::Kind::write;
    for (unsigned i = 0; i < record.access_count; ++i) {
        const BusAccess& access = record.accesses[i];
        const bool wanted = (breakpoint.reads && access.kind == read) ||
                            (breakpoint.writes && access.kind == write);
        if (wanted && access.address >= breakpoint.first && access.address <= breakpoint.last) {
            return &access;
        }
    }
    return nullptr;
}

std::string Breakpoint::text(const Names& names) const {
    std::string what;
    if (kind == Kind::address) {
        what = names.address_text(first);
    } else if (kind == Kind::interrupt) {
        what = debug_console::interrupt_name(interrupt);
    } else if (kind == Kind::port) {
        what = "port " + intel_hex(first, 2) + (!writes ? " in" : !reads ? " out" : "");
    } else {
        what = (!writes ? "read " : !reads ? "write " : "access ") + names.address_text(first);
        if (last != first) what += " to " + intel_hex(last, 4);
    }
    if (!condition.text().empty()) what += " if " + condition.text();
    return what;
}

unsigned Breakpoints::add(Breakpoint breakpoint) {
    breakpoint.id = next_id_++;
    list_.push_back(std::move(breakpoint));
    index();
    return list_.back().id;
}

Breakpoint& Breakpoints::at(unsigned id) {
    const auto found = std::ranges::find(list_, id, &Breakpoint::id);
    if (found == list_.end()) {
        throw DebugError(fmt::format("no breakpoint {}; `break` lists them", id));
    }
    return *found;
}

void Breakpoints::remove(unsigned id) {
    list_.erase(list_.begin() + (&at(id) - list_.data()));
    index();
}

void Breakpoints::clear() {
    list_.clear();
    index();
}

void Breakpoints::set_enabled(unsigned id, bool enabled) {
    at(id).enabled = enabled;
    index();
}

bool Breakpoints::any_enabled() const {
    return std::ranges::any_of(list_, &Breakpoint::enabled);
}

void Breakpoints::index() {
    addresses_.reset();
    observes_ = false;
    for (const Breakpoint& breakpoint : list_) {
        if (!breakpoint.enabled) continue;
        if (breakpoint.kind == Breakpoint::Kind::address) {
            addresses_.set(breakpoint.first);
        } else {
            observes_ = true;
        }
    }
}

bool Breakpoints::stops(Breakpoint& breakpoint, const BoardState& state) {
    if (!breakpoint.condition.holds(state)) return false;
    ++breakpoint.hits;
    if (breakpoint.ignore == 0) return true;
    --breakpoint.ignore;
    return false;
}

std::optional<Breakpoint> Breakpoints::hit(std::size_t number) {
    Breakpoint found = list_[number];
    if (found.temporary) remove(found.id);
    return found;
}

std::optional<Breakpoint> Breakpoints::before(const BoardState& state) {
    std::optional<std::size_t> first;
    for (std::size_t i = 0; i < list_.size(); ++i) {
        Breakpoint& breakpoint = list_[i];
        const bool here = breakpoint.enabled && breakpoint.kind == Breakpoint::Kind::address &&
                          breakpoint.first == state.cpu.pc;
        if (here && stops(breakpoint, state) && !first) first = i;
    }
    return first ? hit(*first) : std::nullopt;
}

std::optional<Breakpoint> Breakpoints::find_behind(const StepRecord& record,
                                                   const BoardState& state) {
    const bool interrupt =
        record.kind != StepRecord::Kind::instruction && record.kind != StepRecord::Kind::halt;
    std::optional<std::size_t> first;
    for (std::size_t i = 0; i < list_.size(); ++i) {
        Breakpoint& breakpoint = list_[i];
        if (!breakpoint.enabled || breakpoint.kind == Breakpoint::Kind::address) continue;
        const bool any = breakpoint.interrupt == StepRecord::Kind::instruction;
        const bool here = breakpoint.kind == Breakpoint::Kind::interrupt
                              ? interrupt && (any || breakpoint.interrupt == record.kind)
                              : matching_access(breakpoint, record) != nullptr;
        if (here && stops(breakpoint, state) && !first) first = i;
    }
    return first ? hit(*first) : std::nullopt;
}

}  // namespace debug_console
