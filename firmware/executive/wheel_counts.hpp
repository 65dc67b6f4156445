// wheel_counts.hpp - tachometer pulses with direction: counted by the tick, read by the step.
// Depends on   hal/io.hpp, core/arith.hpp.
// Direction    pulses of a tick count in the direction that the wheel has at its end.
// Design note  docs/design/executive.md     Tests  tests/firmware/executive/wheel_counts_test.cpp
#pragma once

#include "firmware/core/arith.hpp"
#include "hal/io.hpp"

namespace rover {

struct WheelCount {
    uint16_t pulses = 0;          ///< of the counter at the last tick; the tick's
    volatile uint16_t count = 0;  ///< forward counts up, modulo 2^16
};

/// One wheel, one tick. @param pulses  of the counter since it was started, modulo 2^16
/// @context  the tick
inline void count_wheel(WheelCount& wheel, uint16_t pulses, bool forward) {
    const uint16_t came = sub_wrap(pulses, wheel.pulses);
    if (came == 0) return;
    wheel.pulses = pulses;
    wheel.count =
        forward ? add_wrap(uint16_t{wheel.count}, came) : sub_wrap(uint16_t{wheel.count}, came);
}

/// Reads tick and counts of one moment: again when a tick has come in between. The second reading
/// takes far less than a tick, so it is whole.
/// @context  main line
inline void read_wheels(const volatile uint16_t& tick_count,
                        const WheelCount (&wheels)[hal::kWheelCount], hal::RawInputs& inputs) {
    for (uint8_t tries = 2; tries != 0; --tries) {
        const uint16_t tick = tick_count;
        uint16_t* place = inputs.tach_count;
        for (const WheelCount& wheel : wheels) *place++ = wheel.count;
        inputs.tick_count = tick_count;
        if (inputs.tick_count == tick) return;
    }
}

}  // namespace rover
