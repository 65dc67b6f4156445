#include "host_sim/import/board_counts.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

namespace host_sim {

std::uint16_t inclinometer_code(double angle_deg) {
    const double code =
        std::floor((angle_deg + kInclinometerRangeDeg) / (2 * kInclinometerRangeDeg) * 4096.0);
    return static_cast<std::uint16_t>(std::clamp(code, 0.0, 4095.0));
}

std::uint16_t sum_of_16_q4_count(std::span<const std::uint16_t> codes) {
    const std::uint32_t sum = std::accumulate(codes.begin(), codes.end(), std::uint32_t{0});
    const auto count = static_cast<std::uint32_t>(codes.size());
    return static_cast<std::uint16_t>((sum * 32 + count) / (2 * count));
}

std::uint16_t counter_value(double pulses) {
    return static_cast<std::uint16_t>(static_cast<std::int64_t>(std::floor(pulses)) & 0xFFFF);
}

hal::Calibration wheel_calibration(double wheel_radius_mm) {
    hal::Calibration calibration;
    using enum hal::AngleChannel;
    for (const hal::AngleChannel channel : {bogie_left, bogie_right, differential}) {
        calibration.angle[static_cast<std::size_t>(channel)].gain_q16 = 0;
    }
    const double mm_per_count = 2 * std::numbers::pi * wheel_radius_mm / kTachCountsPerTurn;
    calibration.wheel_radius_q4_mm = static_cast<std::uint16_t>(std::lround(wheel_radius_mm * 16));
    calibration.tach_counts_per_turn = kTachCountsPerTurn;
    calibration.tach_q16_mm_per_count =
        static_cast<std::uint16_t>(std::lround(mm_per_count * 65536));
    return calibration;
}

hal::RawInputs absent_inputs() {
    hal::RawInputs inputs;
    std::ranges::fill(inputs.adc_q4_count, hal::kAdcAbsent);
    return inputs;
}

void set_tach(hal::RawInputs& inputs, hal::Wheel wheel, std::uint16_t count) {
    const auto index = static_cast<unsigned>(wheel);
    inputs.tach_count[index] = count;
    inputs.tach_present = static_cast<std::uint8_t>(inputs.tach_present | (1U << index));
}

}  // namespace host_sim
