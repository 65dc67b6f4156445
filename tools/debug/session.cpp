// session.cpp - see session.hpp.
#include "tools/debug/session.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "host_sim/cpu/interrupts.hpp"
#include "toolchain/isa/disassemble.hpp"
#include "tools/debug/registers.hpp"

namespace debug_console {

using host_sim::BusAccess;
using host_sim::RunEnd;
using host_sim::StepRecord;
using host_sim::Stimulus;
using host_sim::Violation;
using toolchain::isa::Flow;
using toolchain::isa::intel_hex;

namespace {

constexpr uint64_t kSliceT = 307'200;      // 100 ms of the board's time
constexpr unsigned kStepsBetween = 32768;  // looks at Ctrl-C and at the serial line

std::string access_text(const BusAccess& access, const Names& names) {
    const std::string value = intel_hex(access.value, 2);
    switch (access.kind) {
        case BusAccess::Kind::in:
            return fmt::format("IN {} gave {}", intel_hex(access.address, 2), value);
        case BusAccess::Kind::out:
            return fmt::format("OUT {} of {}", intel_hex(access.address, 2), value);
        case BusAccess::Kind::write:
            return fmt::format("{} written to {}", value, names.address_text(access.address));
        default:
            return fmt::format("{} read from {}", value, names.address_text(access.address));
    }
}

}  // namespace

std::string violation_text(const Violation& violation, const Names& names) {
    const std::string value = intel_hex(violation.value, 2);
    const std::string place = names.address_text(violation.address);
    const std::string port = intel_hex(violation.address, 2);
    std::string what = "none";
    switch (violation.kind) {
        case Violation::Kind::none:
            return what;
        case Violation::Kind::unmapped_write:
            what = fmt::format("write of {} to {} where no memory is", value, place);
            break;
        case Violation::Kind::eeprom_write:
            what = fmt::format("write of {} to {} that the EEPROM ignored", value, place);
            break;
        case Violation::Kind::unmapped_in:
            what = fmt::format("IN {} that no chip answers", port);
            break;
        case Violation::Kind::unmapped_out:
            what = fmt::format("OUT {} of {} to no chip", port, value);
            break;
    }
    return fmt::format("{}, by {} at {}", what, names.address_text(violation.pc),
                       time_text(violation.t));
}

// -- What runs ask for
// ------------------------------------------------------------------------------------------------

Stop Session::step(uint64_t count) {
    if (count == 0) return {};
    return run_observed(kNever, [count](const StepRecord&) mutable { return --count == 0; });
}

Stop Session::over() {
    const uint16_t pc = board.state.cpu.pc, sp = board.state.cpu.sp;
    if (board.state.cpu.halted) return step(1);
    bool begun = false;
    return run_observed(kNever, [pc, sp, begun](const StepRecord& record) mutable {
        if (record.kind == StepRecord::Kind::instruction && record.pc == pc && record.sp == sp) {
            begun = true;
            const Flow flow = flow_of(record);
            if (flow != Flow::call && flow != Flow::restart) return true;
        }
        return begun && !above(sp, record.next_sp);
    });
}

Stop Session::finish() {
    if (!calls.frames().empty()) {
        const uint16_t slot = calls.frames().back().slot;
        return run_observed(
            kNever, [slot](const StepRecord& record) { return above(record.next_sp, slot); });
    }
    // Without a shadow: the first return that leaves SP above where it is now.
    const uint16_t sp = board.state.cpu.sp;
    return run_observed(kNever, [sp](const StepRecord& record) {
        return record.next_sp != record.sp && above(record.next_sp, sp) &&
               flow_of(record) == Flow::ret;
    });
}

Stop Session::run(uint64_t until_t) {
    if (until_t <= board.state.cpu.t) return {};
    if (!observer && !breakpoints.any_enabled()) return run_unobserved(until_t);
    return run_observed(until_t, [](const StepRecord&) { return false; });
}

// -- Runs
// ------------------------------------------------------------------------------------------------

Stop Session::run_unobserved(uint64_t until_t) {
    while (board.state.cpu.t < until_t) {
        const uint64_t t = board.state.cpu.t;
        const RunEnd end = board.run(until_t - t > kSliceT ? t + kSliceT : until_t);
        state_changed();
        if (pause()) return {Stop::Kind::interrupted, "interrupted"};
        if (end != RunEnd::time_limit) return stop_of(end);
    }
    return {};
}

Stop Session::run_observed(uint64_t until_t, const Goal& goal) {
    StepRecord record;
    Stop stop;
    for (unsigned steps = 0;; ++steps) {
        if (steps % kStepsBetween == kStepsBetween - 1 && pause()) {
            return {Stop::Kind::interrupted, "interrupted"};
        }
        if (steps != 0 && breakpoint_before(stop)) return stop;
        const RunEnd end = board.step(record, until_t);
        follow_resets();
        if (end == RunEnd::halted || end == RunEnd::undefined_instruction) return stop_of(end);
        calls.follow(record);
        if (observer) observer(record, board.state);
        if (breakpoint_behind(record, stop)) return stop;
        if (end == RunEnd::violation) return stop_of(end);
        if (goal(record) || board.state.cpu.t >= until_t) return {};
    }
}

bool Session::pause() {
    if (between_slices) between_slices();
    return interrupted && interrupted();
}

// Brings the board to the present T-state, as the next step would: what has happened by now decides
// whether the instruction at PC, or an interrupt, comes next. A level that does not change is no
// event.
void Session::settle() {
    const bool service = board.state.cpu.pin(host_sim::Pin::sid).level;
    board.schedule({board.state.cpu.t, Stimulus::Kind::service, 0, service ? 1 : 0});
}

bool Session::breakpoint_before(Stop& stop) {
    const host_sim::BoardState& state = board.state;
    if (!breakpoints.waits_at(state.cpu.pc) || state.cpu.halted) return false;
    settle();
    if (state.reset_pending || state.watchdog.pulse() ||
        pending_interrupt(state.cpu) != host_sim::Interrupt::none) {
        return false;  // it comes first; the instruction is reached later
    }
    const auto breakpoint = breakpoints.before(state);
    if (!breakpoint) return false;
    stop = {Stop::Kind::breakpoint,
            fmt::format("breakpoint {}: {}", breakpoint->id, breakpoint->text(names))};
    return true;
}

bool Session::breakpoint_behind(const StepRecord& record, Stop& stop) {
    const auto breakpoint = breakpoints.behind(record, board.state);
    if (!breakpoint) return false;
    const BusAccess* access = matching_access(*breakpoint, record);
    const std::string what = breakpoint->kind == Breakpoint::Kind::interrupt
                                 ? debug_console::interrupt_name(record.kind) + " taken instead of "
                                 : access_text(*access, names) + " by ";
    stop = {Stop::Kind::breakpoint, fmt::format("breakpoint {}: {}{}", breakpoint->id, what,
                                                names.address_text(record.pc))};
    return true;
}

Stop Session::stop_of(RunEnd end) const {
    const auto& state = board.state;
    switch (end) {
        case RunEnd::halted:
            return {Stop::Kind::halted,
                    "halted with interrupts disabled; only TRAP or RESET goes on"};
        case RunEnd::undefined_instruction:
            return {Stop::Kind::undefined_instruction,
                    fmt::format("{} at {} is no documented instruction; --cpu 8085u runs it",
                                intel_hex(state.memory.bytes[state.cpu.pc], 2),
                                names.address_text(state.cpu.pc))};
        case RunEnd::violation:
            return {Stop::Kind::violation,
                    "violation: " + violation_text(state.last_violation, names)};
        case RunEnd::time_limit:
            break;
    }
    return {};
}

void Session::follow_resets() {
    if (board.state.reset_count == resets_seen_) return;
    resets_seen_ = board.state.reset_count;
    calls.clear();
}

void Session::reset() {
    board.reset();
    follow_resets();
}

void Session::power_cycle() {
    board.power_cycle();
    resets_seen_ = board.state.reset_count;
    calls.clear();
}

void Session::state_changed() {
    resets_seen_ = board.state.reset_count;
    calls.forget();
}

}  // namespace debug_console
