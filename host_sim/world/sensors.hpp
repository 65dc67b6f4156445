// sensors.hpp - from the true state of the vehicle to raw counts.
// Modelled      converter channels of 12 bits, 16 conversions summed, white noise per conversion
// and
//               common noise per acquisition (optionally with memory, optionally correlated between
//               differential and bogies), wrong zero and gain; tachometer counters modulo 2^16 with
//               wheels of slightly different speed; look-ahead samples with noise in 0.5 mm steps.
// Not modelled  steering, gyro, mast, motor current, battery, proximity: marked absent.
// Depends       hal/io.hpp, host_sim/world/vehicle.hpp, random.hpp.
#pragma once

#include <array>
#include <cstdint>

#include "hal/calibration.hpp"
#include "hal/io.hpp"
#include "host_sim/world/random.hpp"
#include "host_sim/world/vehicle.hpp"

namespace host_sim {

/// How a real sensor differs from its calibration: seen = (angle - zero_rad) * gain.
struct AngleError {
    double zero_rad = 0;
    double gain = 1;
};

/// Repeatability of the suspension potentiometers of the rover Spirit at rest: pooled deviation of
/// the repeated readings in chassis_state.csv
/// (SpiritData.RepeatabilityOfThePotentiometersIsAsStated).
inline constexpr double kSpiritPotentiometerNoiseRad = 0.26e-3;

/// The defaults give z(1) a noise of 0.04 mm, the paper's figure, with Rocky 3.2's converter
/// (Sensors.DefaultNoiseIsThePapers).
struct SensorModel {
    double conversion_noise_count = 0.5;     ///< sigma per conversion, 12-bit counts
    double potentiometer_noise_rad = 75e-6;  ///< sigma per acquisition, common to its conversions
    double inclinometer_noise_rad = 75e-6;
    double noise_memory = 0;  ///< AR(1) coefficient of the common noise between steps, (-1, 1)
    double linkage_correlation = 0;  ///< of differential and bogie potentiometer noise, [-1, 1]
    std::array<AngleError, hal::kAngleChannelCount> angle_error = {};
    double tach_spread = 0;       ///< sigma of the wheels' relative speed differences, drawn once
    double range_noise_mm = 2.0;  ///< sigma of a look-ahead sample
    int range_scan_steps = 1;     ///< control steps between two scans, >= 1

    /// No noise, no spread; quantisation remains.
    static SensorModel noiseless();
};

/// The 12-bit converter: floor of the count, held at the rails 0 and 4095.
constexpr std::uint32_t convert_12bit(double count) {
    if (!(count > 0.0)) return 0;
    if (count >= 4095.0) return 4095;
    return static_cast<std::uint32_t>(count);
}

/// What the sensors look at in one control step.
struct SensedState {
    std::array<double, hal::kAngleChannelCount> angle_rad = {};  ///< by hal::AngleChannel
    std::array<double, hal::kWheelCount> rim_travel_cm = {};     ///< since start, by hal::Wheel
    std::array<double, hal::kRangeSampleCount> range_height_cm = {};
    std::uint8_t range_seen = 0;  ///< bit i: sample i has ground in sight
};

class Sensors {
public:
    /// @errors  InputError when the model has a value out of its range
    Sensors(const Vehicle& vehicle, const SensorModel& model, std::uint64_t seed);

    /// The inputs of the next control step; call once a step.
    hal::RawInputs read(const SensedState& state);

private:
    [[nodiscard]] std::uint16_t acquire(std::size_t channel, double angle_rad);
    void draw_common_noise();
    void scan(const SensedState& state, hal::RawInputs& inputs);

    SensorModel model_;
    std::array<double, hal::kAngleChannelCount> count_per_rad_ = {};
    std::array<double, hal::kAngleChannelCount> noise_rad_ = {};
    std::array<double, hal::kAngleChannelCount> common_ = {};  // unit variance, before correlation
    std::array<double, hal::kWheelCount> pulses_per_cm_ = {};
    Random conversion_;
    Random acquisition_;
    Random range_;
    hal::RawInputs last_scan_ = {};
    std::uint16_t tick_count_ = 0;
    int steps_to_scan_ = 0;
    bool first_ = true;
};

}  // namespace host_sim
