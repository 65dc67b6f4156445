// session.hpp - the board under the debugger: runs it, stops it, and knows why it stopped.
// Depends on   breakpoints.hpp, call_stack.hpp, names.hpp, host_sim/board.
// Speed        unobserved runs go at the board's full speed in slices; with a breakpoint or an
//              observer every step is recorded.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "host_sim/board/board.hpp"
#include "tools/debug/breakpoints.hpp"
#include "tools/debug/call_stack.hpp"
#include "tools/debug/names.hpp"

namespace debug_console {

/// Why a run ended.
struct Stop {
    enum class Kind : uint8_t {
        done,  ///< as far as was asked for
        breakpoint,
        halted,  ///< in HALT with interrupts disabled, if the board's options ask for it
        undefined_instruction,
        violation,
        interrupted,  ///< by the person at the console
    };
    Kind kind = Kind::done;
    std::string text;  ///< for people; empty when done
};

class Session {
public:
    static constexpr uint64_t kNever = host_sim::chips::kNever;

    Session(const host_sim::BoardOptions& options, Names symbols)
        : board(options), names(std::move(symbols)), resets_seen_(board.state.reset_count) {}

    host_sim::Board board;
    Names names;
    Breakpoints breakpoints;
    CallStack calls;

    /// Asked now and then during a run: true ends it. May be empty.
    std::function<bool()> interrupted;
    /// Called between the slices of a run, to show what the board sends. May be empty.
    std::function<void()> between_slices;
    /// Sees every step while it is set.
    std::function<void(const host_sim::StepRecord&, const host_sim::BoardState&)> observer;

    /// `count` steps: instructions, interrupts taken, waits in HALT.
    Stop step(uint64_t count);
    /// The instruction at PC, with what it calls and the interrupts before it.
    Stop over();
    /// Until the current function has returned.
    Stop finish();
    /// To the first instruction boundary at or after `until_t`.
    Stop run(uint64_t until_t = kNever);

    /// Presses RESET.
    void reset();
    /// Takes the supply away and gives it back.
    void power_cycle();
    /// After the state was changed by hand or restored.
    void state_changed();

private:
    /// What a run asks for: true behind the step that fulfils it.
    using Goal = std::function<bool(const host_sim::StepRecord&)>;

    Stop run_observed(uint64_t until_t, const Goal& goal);
    Stop run_unobserved(uint64_t until_t);
    bool pause();
    void settle();
    bool breakpoint_before(Stop& stop);
    bool breakpoint_behind(const host_sim::StepRecord& record, Stop& stop);
    void follow_resets();
    [[nodiscard]] Stop stop_of(host_sim::RunEnd end) const;

    uint64_t resets_seen_;
};

/// A violation for people: "write of 05H to 4000H where no memory is, by 0103H main+3".
[[nodiscard]] std::string violation_text(const host_sim::Violation& violation, const Names& names);

}  // namespace debug_console
