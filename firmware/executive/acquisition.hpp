// acquisition.hpp - RawInputs from the board's parts.
// Depends on   hal/board/rb85_parts.hpp (as a template argument), config/board_inputs.hpp,
//              link/byte_ring.hpp, executive/wheel_counts.hpp.
// Bounds       every wait is one of a driver, with a bound; about 20,000 T.
// Design note  docs/design/executive.md     Tests  tests/firmware/executive/acquisition_test.cpp
#pragma once

#include "firmware/config/board_inputs.hpp"
#include "firmware/executive/wheel_counts.hpp"
#include "firmware/link/byte_ring.hpp"
#include "hal/chips/range_module.hpp"

namespace rover {

/// The angle channels; the others stay absent. @return  false: the converter gave no answer
template <class Parts>
bool read_converter(hal::RawInputs& inputs) {
    bool answered = true;
    for (uint16_t& channel : inputs.adc_q4_count) channel = hal::kAdcAbsent;
    for (const uint8_t channel : kSampledChannels) {
        const uint16_t sum = Parts::AnalogInputs::sum_of_16(channel);
        inputs.adc_q4_count[channel] = sum;
        if (sum == hal::kAdcAbsent) answered = false;
    }
    return answered;
}

/// The newest scan. Without an answer no sample is present, and the scan count stays: stale.
template <class Parts>
void read_range(hal::RawInputs& inputs) {
    hal::RangeFrame frame;
    inputs.range_present = 0;
    if (Parts::Range::read(frame) != hal::RangeStatus::ok) return;
    inputs.range_scan_count = frame.scan_count;
    inputs.range_present = frame.present;
    for (uint8_t i = 0; i < hal::kRangeSampleCount; ++i) inputs.range_q1_mm[i] = frame.heights[i];
}

/// Bytes that have come over the link, oldest first; what does not fit waits in the ring.
template <class Ring>
void read_link(Ring& received, hal::RawInputs& inputs) {
    uint8_t size = 0;
    while (size < hal::kCommandBytesMax && !received.empty()) {
        inputs.command[size] = received.pop();
        ++size;
    }
    inputs.command_size = size;
}

}  // namespace rover
