// board_inputs.hpp - which converter channels this vehicle samples in every step.
// Depends on   hal/io.hpp.
#pragma once

#include "hal/io.hpp"

namespace rover {

/// Multiplexer inputs, [0, kAdcChannelCount). All others are reported absent.
inline constexpr uint8_t kSampledChannels[] = {
    static_cast<uint8_t>(hal::AdcChannel::bogie_left),
    static_cast<uint8_t>(hal::AdcChannel::bogie_right),
    static_cast<uint8_t>(hal::AdcChannel::differential),
    static_cast<uint8_t>(hal::AdcChannel::pitch),
    static_cast<uint8_t>(hal::AdcChannel::roll),
};

}  // namespace rover
