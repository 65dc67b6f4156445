// acquisition.hpp - RawInputs from the board's parts.
// Depends on   hal/board/rb85_parts.hpp (as a template argument), config/board_inputs.hpp,
//              executive/wheel_counts.hpp.
// Bounds       every wait is one of a driver, with a bound; about 16,500 T.
// Design note  docs/design/executive.md     Tests  tests/firmware/executive/acquisition_test.cpp
#pragma once

#include "firmware/config/board_inputs.hpp"
#include "firmware/executive/wheel_counts.hpp"
#include "hal/chips/range_module.hpp"

namespace rover {

/// All converter channels absent: once, before the first read_converter().
inline void begin_converter(hal::RawInputs& inputs) {
    uint16_t* channel = inputs.adc_q4_count;
    for (uint8_t left = hal::kAdcChannelCount; left != 0; --left) *channel++ = hal::kAdcAbsent;
}

/// One channel. @param absent  called when it gave no answer
template <class Parts, class Absent>
[[gnu::noinline]] uint16_t read_channel(uint8_t channel, Absent absent) {
    uint16_t sum;
    if (!Parts::AnalogInputs::sum_of_16(channel, sum)) absent();
    return sum;
}

/// The sampled channels; the others stay as they were. @param absent  called for each without
/// answer
template <class Parts, class Absent>
void read_converter(hal::RawInputs& inputs, Absent absent) {
    static_assert(kSampledChannelCount == 5);
    inputs.adc_q4_count[0] = read_channel<Parts>(0, absent);
    inputs.adc_q4_count[1] = read_channel<Parts>(1, absent);
    inputs.adc_q4_count[2] = read_channel<Parts>(2, absent);
    inputs.adc_q4_count[3] = read_channel<Parts>(3, absent);
    inputs.adc_q4_count[4] = read_channel<Parts>(4, absent);
}

// A scan goes from the module to its place: the inputs have it in the order of the frame.
static_assert(__builtin_offsetof(hal::RawInputs, range_present) ==
              __builtin_offsetof(hal::RawInputs, range_scan_count) +
                  __builtin_offsetof(hal::RangeFrame, present));
static_assert(__builtin_offsetof(hal::RawInputs, range_q1_mm) ==
              __builtin_offsetof(hal::RawInputs, range_scan_count) +
                  __builtin_offsetof(hal::RangeFrame, heights));

/// The newest scan. Without an answer no sample is present, and the scan count stays: stale; the
/// heights mean nothing then.
template <class Parts>
void read_range(hal::RawInputs& inputs) {
    const uint8_t last_scan_count = inputs.range_scan_count;
    if (Parts::Range::read(reinterpret_cast<hal::RangeFrame&>(inputs.range_scan_count)) ==
        hal::RangeStatus::ok)
        return;
    inputs.range_scan_count = last_scan_count;
    inputs.range_present = 0;
}

}  // namespace rover
