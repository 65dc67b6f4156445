// sod_watchdog.hpp - retriggerable one-shot on the SOD line: motors off and reset when it is quiet.
// Source       own circuit: an edge detector and a one-shot of 0.5 s; a second one-shot for the
// pulse. Depends on   host_sim/chips/chip.hpp. Not modelled tolerance of the timing parts. Page
// docs/chips/sod-watchdog.md
#pragma once

#include <cstdint>

#include "host_sim/chips/chip.hpp"

namespace host_sim::chips {

struct SodWatchdog {
    static constexpr uint64_t kPeriodNs = 500'000'000;  ///< quiet time that is tolerated
    static constexpr uint64_t kPulseNs = 20'000'000;    ///< RESET and motors-off pulse

    /// Power-on at T-state 0: the first period begins.
    explicit SodWatchdog(uint64_t clock_hz);

    /// Power-on or reset button: ends a pulse, and a new period begins. Its own pulse must not be
    /// wired to this.
    void restart(uint64_t now_t);
    /// Level of the SOD line. Either edge begins a new period, but not during the pulse.
    void sod(bool level, uint64_t now_t);
    void advance(uint64_t now_t);
    /// T-state at which the pulse begins or ends.
    [[nodiscard]] uint64_t next_event_t() const { return change_t; }

    /// RESET IN of the processor and clear line of the motor latches. Valid after advance.
    [[nodiscard]] bool pulse() const { return pulsing; }
    [[nodiscard]] Properties properties() const;

    uint64_t period_t = 0;
    uint64_t pulse_t = 0;

    bool line = false;  ///< SOD is low after a reset of the 8085
    bool pulsing = false;
    uint64_t change_t = 0;  ///< when the pulse begins or ends, if no edge comes
    uint64_t fired_count = 0;
    uint64_t longest_quiet_t = 0;  ///< longest time between two edges that was in time

    bool operator==(const SodWatchdog&) const = default;
};

}  // namespace host_sim::chips
