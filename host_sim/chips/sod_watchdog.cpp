// sod_watchdog.cpp - watchdog on SOD.
#include "host_sim/chips/sod_watchdog.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace host_sim::chips {

SodWatchdog::SodWatchdog(uint64_t clock_hz)
    : period_t(t_states_from_ns(kPeriodNs, clock_hz)),
      pulse_t(t_states_from_ns(kPulseNs, clock_hz)),
      change_t(period_t) {}

void SodWatchdog::restart(uint64_t now_t) {
    advance(now_t);
    pulsing = false;
    change_t = now_t + period_t;
}

void SodWatchdog::sod(bool level, uint64_t now_t) {
    advance(now_t);
    if (level == line) return;
    line = level;
    if (pulsing) return;
    longest_quiet_t = std::max(longest_quiet_t, now_t + period_t - change_t);
    change_t = now_t + period_t;
}

void SodWatchdog::advance(uint64_t now_t) {
    while (change_t <= now_t) {
        pulsing = !pulsing;
        if (pulsing) ++fired_count;
        change_t += pulsing ? pulse_t : period_t;
    }
}

Properties SodWatchdog::properties() const {
    return {
        {"output", pulsing ? fmt::format("motors off and RESET until T {}", change_t)
                           : fmt::format("quiet, fires at T {}", change_t)},
        {"SOD", line ? "high" : "low"},
        {"fired", fmt::format("{}", fired_count)},
        {"longest time between edges", fmt::format("{} of {} T", longest_quiet_t, period_t)},
    };
}

}  // namespace host_sim::chips
