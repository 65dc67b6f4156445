// call_profile.hpp - where the T-states go: by function, by interrupt, in HALT.
// Depends on   host_sim/trace/call_stack.hpp.
// Formats      docs/design/trace.md.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "host_sim/trace/call_stack.hpp"

namespace host_sim {

/// T-states of one function. Inclusive is with what it calls and without interrupts.
struct FunctionProfile {
    uint16_t address = 0;
    std::string name;  ///< of the symbol; else the address, "0100H"
    uint64_t calls = 0;
    uint64_t exclusive_t = 0;
    uint64_t exclusive_interrupt_t = 0;  ///< the part of exclusive_t inside of interrupts
    uint64_t inclusive_t = 0;            ///< a recursive call is a part of the outermost one
    uint64_t completed = 0;              ///< outermost calls that have ended
    uint64_t completed_t = 0;            ///< their inclusive T-states
    uint64_t worst_t = 0;                ///< the longest of them; 0 if none

    [[nodiscard]] double mean_t() const {  ///< of the completed ones; 0 if none
        return completed == 0 ? 0.0
                              : static_cast<double>(completed_t) / static_cast<double>(completed);
    }
};

/// T-states of one interrupt input, from acceptance to return, without interrupts in between.
struct InterruptProfile {
    std::string name;  ///< "TRAP", "RST 7.5", ...
    uint64_t accepted = 0;
    uint64_t total_t = 0;
    uint64_t completed = 0;
    uint64_t worst_t = 0;  ///< the longest completed one
};

/// A whole run. exclusive_t of all functions and halt_t add up to total_t.
struct ProfileReport {
    uint64_t total_t = 0;
    uint64_t halt_t = 0;
    uint64_t interrupt_t = 0;                  ///< in interrupts
    std::vector<FunctionProfile> functions;    ///< most exclusive T first
    std::vector<InterruptProfile> interrupts;  ///< those that happened, by priority
};

/// Adds up a run, step by step.
class CallProfile final : private CallListener {
public:
    /// @param symbols  nullptr: functions are what is called; must outlive the profile
    explicit CallProfile(const Symbols* symbols) : symbols_(symbols), stack_(symbols, *this) {}
    CallProfile(const CallProfile&) = delete;
    CallProfile& operator=(const CallProfile&) = delete;

    /// Takes the next step.
    void observe(const StepRecord& step);

    /// What has been seen so far. Activations that have not ended count in inclusive_t and total_t,
    /// not in worst and mean.
    [[nodiscard]] ProfileReport report() const;

private:
    void frame_begins(const Frame& frame, bool called) override;
    void frame_ends(const Frame& frame) override;
    void time_passes(const Frame& frame, uint64_t t) override;

    const Symbols* symbols_;
    CallStack stack_;
    uint64_t total_t_ = 0;
    uint64_t halt_t_ = 0;
    uint64_t interrupt_t_ = 0;
    std::map<uint16_t, FunctionProfile> functions_;
    std::array<InterruptProfile, 5> interrupts_{};  ///< TRAP, 7.5, 6.5, 5.5, INTR
};

/// The report as a table for people.
[[nodiscard]] std::string profile_text(const ProfileReport& report);

/// The report for programs, as a JSON text.
[[nodiscard]] std::string profile_json(const ProfileReport& report);

}  // namespace host_sim
