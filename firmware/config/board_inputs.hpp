// board_inputs.hpp - which converter channels this vehicle samples in every step, and when its
// tachometers are read.
// Depends on   hal/io.hpp, config/controller_tuning.hpp.
#pragma once

#include "firmware/config/controller_tuning.hpp"
#include "hal/io.hpp"

namespace rover {

/// The first multiplexer inputs: bogies, differential, pitch, roll. All others are reported absent.
inline constexpr uint8_t kSampledChannelCount = 5;
static_assert(static_cast<uint8_t>(hal::AdcChannel::roll) + 1 == kSampledChannelCount);

/// The tick counts tachometer pulses at every fifth tick, so at that of every step: 20 times a
/// second. Pulses in between are taken to have come in the direction that the wheel has then; a
/// wheel that reverses is near rest.
inline constexpr uint8_t kTicksPerCount = 5;
static_assert(kTicksPerStep % kTicksPerCount == 0);

}  // namespace rover
