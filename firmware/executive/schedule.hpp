// schedule.hpp - when a control step is due, and which steps came late.
// Depends on   config/controller_tuning.hpp, core/arith.hpp.
// Bounds       none: ticks are modulo 2^16, and a step is at most 327 s late.
// Design note  docs/design/executive.md     Tests  tests/firmware/executive/schedule_test.cpp
#pragma once

#include "firmware/config/controller_tuning.hpp"
#include "firmware/core/arith.hpp"

namespace rover {

/// Steps are due kTicksPerStep apart, counted from the first one; a late one does not move those
/// behind it.
struct Schedule {
    uint16_t due_tick = 0;
    uint16_t late_steps = 0;  ///< begun behind their tick, modulo 2^16
    /// Never begun: the next one was due already, modulo 2^16. Volatile so that the rare loop over
    /// them stays a loop and does not become a division.
    volatile uint16_t missed_steps = 0;
};

constexpr bool step_is_due(const Schedule& schedule, uint16_t tick) {
    return narrow_wrap_s16(sub_wrap(tick, schedule.due_tick)) >= 0;
}

/// A step begins now. Books lateness and sets when the next one is due.
/// @param late  called when it begins behind its tick
/// @cost    one round of the loop for each missed step
template <class Late>
void begin_due_step(Schedule& schedule, uint16_t tick, Late late) {
    if (schedule.due_tick != tick) {
        schedule.late_steps = add_wrap(schedule.late_steps, uint16_t{1});
        late();
    }
    for (;;) {
        schedule.due_tick = add_wrap(schedule.due_tick, kTicksPerStep);
        if (!step_is_due(schedule, tick)) return;
        schedule.missed_steps = add_wrap(uint16_t{schedule.missed_steps}, uint16_t{1});
    }
}

}  // namespace rover
