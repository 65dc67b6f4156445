// wheel_counts.hpp - tachometer pulses with direction: counted by the tick, read by the step.
// Depends on   hal/io.hpp, core/arith.hpp.
// Counters     started by I82c54::start_pulses(): loaded by their first pulse, then downwards.
// Direction    pulses count in the direction that the wheel has when they are read: 20 Hz.
// Design note  docs/design/executive.md     Tests  tests/firmware/executive/wheel_counts_test.cpp
#pragma once

#include "firmware/core/arith.hpp"
#include "hal/io.hpp"

namespace rover {

struct WheelCount {
    uint16_t now = 0;             ///< its counter, which counts down; the tick's
    uint16_t last = 0;            ///< the same, when it was booked; the tick's
    bool moved = false;           ///< the counter has been loaded by its first pulse; the tick's
    volatile uint16_t count = 0;  ///< forward counts up, modulo 2^16
};

/// The six counters, of one moment.
template <class Parts>
void read_counters(WheelCount (&wheels)[hal::kWheelCount]) {
    Parts::TimerB::latch_counts();
    Parts::TimerC::latch_counts();
    wheels[0].now = Parts::TimerB::template latched_count<0>();
    wheels[1].now = Parts::TimerB::template latched_count<1>();
    wheels[2].now = Parts::TimerB::template latched_count<2>();
    wheels[3].now = Parts::TimerC::template latched_count<0>();
    wheels[4].now = Parts::TimerC::template latched_count<1>();
    wheels[5].now = Parts::TimerC::template latched_count<2>();
}

/// Books the pulses of one wheel, of which there are some. A counter keeps what it held until its
/// first pulse loads it; from then on it is the complement of the number of pulses, so the first
/// change is counted from that of 0.
[[gnu::noinline]] inline void book_pulses(WheelCount& wheel, uint8_t forward) {
    const uint16_t from = wheel.moved ? wheel.last : uint16_t{0xFFFF};
    const uint16_t now = wheel.now;
    wheel.moved = true;
    wheel.last = now;
    const uint16_t pulses = sub_wrap(from, now);
    const uint16_t count = wheel.count;
    wheel.count =
        bit_and(forward, uint8_t{1}) != 0 ? add_wrap(count, pulses) : sub_wrap(count, pulses);
}

/// All wheels, behind read_counters(). @param forward  bit w: wheel w turns forward
/// @context  the tick
inline void count_wheels(WheelCount (&wheels)[hal::kWheelCount], uint8_t forward) {
    for (WheelCount& wheel : wheels) {
        if (wheel.now != wheel.last) book_pulses(wheel, forward);
        forward = shift_floor<1>(forward);
    }
}

/// Reads tick and counts of one moment: again when a tick has come in between. The second reading
/// takes far less than a tick, so it is whole.
/// @context  main line
inline void read_wheels(const volatile uint16_t& tick_count,
                        const WheelCount (&wheels)[hal::kWheelCount], hal::RawInputs& inputs) {
    for (uint8_t tries = 2; tries != 0; --tries) {
        const uint16_t tick = tick_count;
        volatile uint16_t* const place = inputs.tach_count;  // stored at once, not kept meanwhile
        place[0] = wheels[0].count;
        place[1] = wheels[1].count;
        place[2] = wheels[2].count;
        place[3] = wheels[3].count;
        place[4] = wheels[4].count;
        place[5] = wheels[5].count;
        inputs.tick_count = tick_count;
        if (inputs.tick_count == tick) return;
    }
}

}  // namespace rover
