// board_counts.hpp - physical quantities as the board's converter and counters would show them.
// Depends on   hal/io.hpp.     Source  docs/guides/real-data.md, "How a channel is converted".
// Tests        tests/host_sim/import/board_counts_test.cpp
#pragma once

#include <cstdint>
#include <span>

#include "hal/calibration.hpp"
#include "hal/io.hpp"

namespace host_sim {

inline constexpr std::uint32_t kStepMs = 100;          ///< one control step
inline constexpr std::uint32_t kTicksPerStep = 10;     ///< 100 Hz ticks in it
inline constexpr double kInclinometerRangeDeg = 75.0;  ///< the converter spans +- this
inline constexpr std::uint16_t kTachCountsPerTurn = 2000;

/// One conversion of the inclinometer: floor((angle + 75 deg) / 150 deg * 4096), clamped to
/// [0, 4095]. Level is the edge between the codes 2047 and 2048, so the sum of 16 noisy
/// conversions at level is 32760 on average: the nominal zero of hal/calibration.hpp.
std::uint16_t inclinometer_code(double angle_deg);

/// What the firmware's sum of 16 conversions would be, from the codes that a slower recording has
/// for the same step: round(sum * 16 / n), half up. The mean of the step is kept; the noise of the
/// result is that of n conversions, not of 16.
/// @param codes  [1, 16] codes of 12 bits
/// @return  u16 Q4 counts, [0, 65520]
std::uint16_t sum_of_16_q4_count(std::span<const std::uint16_t> codes);

/// A pulse counter that has travelled: floor(pulses) modulo 2^16. @param pulses |.| < 2^53
std::uint16_t counter_value(double pulses);

/// The record of a vehicle of which only wheels are known: radius, 2000 counts a turn and the rim
/// travel per count that follows; potentiometers "not calibrated" (gain 0), inclinometer nominal.
/// @param wheel_radius_mm  (0, 318]
/// @accuracy  tach_q16_mm_per_count within half an LSB: 0.007 % at radius 35 mm
hal::Calibration wheel_calibration(double wheel_radius_mm);

/// Inputs of a vehicle without any sensor: converter channels absent, no tachometer, no range.
hal::RawInputs absent_inputs();

/// Marks wheel `wheel` present and sets its counter.
void set_tach(hal::RawInputs& inputs, hal::Wheel wheel, std::uint16_t count);

}  // namespace host_sim
