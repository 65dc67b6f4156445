// sensors.cpp - converter, tachometers and look-ahead module.
#include "host_sim/world/sensors.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace host_sim {

namespace {

constexpr int kConversions = 16;
constexpr std::size_t kDifferential = static_cast<std::size_t>(hal::AngleChannel::differential);
constexpr std::size_t kPitch = static_cast<std::size_t>(hal::AngleChannel::pitch);

void require(bool condition, const char* what) {
    if (!condition) throw InputError(std::string("sensor model: ") + what);
}

}  // namespace

SensorModel SensorModel::noiseless() {
    SensorModel model;
    model.conversion_noise_count = 0;
    model.potentiometer_noise_rad = 0;
    model.inclinometer_noise_rad = 0;
    model.range_noise_mm = 0;
    return model;
}

Sensors::Sensors(const Vehicle& vehicle, const SensorModel& model, std::uint64_t seed)
    : model_(model),
      conversion_(stream(seed, "conversion")),
      acquisition_(stream(seed, "acquisition")),
      range_(stream(seed, "range")) {
    const auto is_sigma = [](double value) { return value >= 0 && value < 1e6; };
    require(is_sigma(model.conversion_noise_count), "conversion noise must not be negative");
    require(is_sigma(model.potentiometer_noise_rad), "potentiometer noise must not be negative");
    require(is_sigma(model.inclinometer_noise_rad), "inclinometer noise must not be negative");
    require(is_sigma(model.range_noise_mm), "range noise must not be negative");
    require(std::abs(model.noise_memory) < 1, "noise memory must be between -1 and 1");
    require(std::abs(model.linkage_correlation) <= 1, "correlation must be from -1 to 1");
    require(model.tach_spread >= 0 && model.tach_spread < 0.2,
            "tachometer spread must be 0 to 0.2");
    require(model.range_scan_steps >= 1, "a range scan takes one step or more");
    for (const AngleError& error : model.angle_error) {
        require(std::isfinite(error.zero_rad) && std::isfinite(error.gain),
                "angle errors are finite");
    }
    for (std::size_t i = 0; i < count_per_rad_.size(); ++i) {
        const double range_deg =
            i >= kPitch ? vehicle.inclinometer_range_deg : vehicle.potentiometer_range_deg;
        count_per_rad_[i] = 4096.0 / (2.0 * range_deg) * 180.0 / std::numbers::pi;
        noise_rad_[i] = i >= kPitch ? model.inclinometer_noise_rad : model.potentiometer_noise_rad;
    }
    Random spread = stream(seed, "tachometer spread");
    for (double& pulses : pulses_per_cm_) {
        pulses = (1.0 + model.tach_spread * spread.normal()) / vehicle.cm_per_pulse();
    }
    for (double& common : common_) common = acquisition_.normal();
    for (std::uint16_t& count : last_scan_.adc_q4_count) count = hal::kAdcAbsent;
}

void Sensors::draw_common_noise() {
    if (first_) {  // the constructor drew stationary values
        first_ = false;
        return;
    }
    const double fresh = std::sqrt(1.0 - model_.noise_memory * model_.noise_memory);
    for (double& common : common_) {
        common = model_.noise_memory * common + fresh * acquisition_.normal();
    }
}

std::uint16_t Sensors::acquire(std::size_t channel, double angle_rad) {
    double common = common_[channel];
    if (channel < kDifferential) {  // a bogie
        const double share = model_.linkage_correlation;
        common = share * common_[kDifferential] + std::sqrt(1.0 - share * share) * common;
    }
    const AngleError& error = model_.angle_error[channel];
    const double seen_rad =
        (angle_rad - error.zero_rad) * error.gain + noise_rad_[channel] * common;
    const double count = 2048.0 + seen_rad * count_per_rad_[channel];
    if (model_.conversion_noise_count == 0) {
        return static_cast<std::uint16_t>(kConversions * convert_12bit(count));
    }
    std::uint32_t sum = 0;
    for (int i = 0; i < kConversions; ++i) {
        sum += convert_12bit(count + model_.conversion_noise_count * conversion_.normal());
    }
    return static_cast<std::uint16_t>(sum);
}

void Sensors::scan(const SensedState& state, hal::RawInputs& inputs) {
    inputs.range_scan_count = static_cast<std::uint8_t>(last_scan_.range_scan_count + 1);
    inputs.range_present = 0;
    for (std::size_t i = 0; i < hal::kRangeSampleCount; ++i) {
        inputs.range_q1_mm[i] = 0;
        if ((state.range_seen >> i & 1u) == 0) continue;
        const double height_mm =
            10.0 * state.range_height_cm[i] + model_.range_noise_mm * range_.normal();
        const double height_q1_mm = std::clamp(std::round(2.0 * height_mm), -32768.0, 32767.0);
        inputs.range_q1_mm[i] = static_cast<std::int16_t>(height_q1_mm);
        inputs.range_present = static_cast<std::uint8_t>(inputs.range_present | 1u << i);
    }
}

hal::RawInputs Sensors::read(const SensedState& state) {
    hal::RawInputs inputs = last_scan_;  // every other channel stays absent, an old scan stays put
    inputs.tick_count = tick_count_;
    tick_count_ = static_cast<std::uint16_t>(tick_count_ + 10);
    draw_common_noise();
    for (std::size_t i = 0; i < hal::kAngleChannelCount; ++i) {
        inputs.adc_q4_count[i] = acquire(i, state.angle_rad[i]);
    }
    for (std::size_t wheel = 0; wheel < hal::kWheelCount; ++wheel) {
        const double pulses = std::floor(state.rim_travel_cm[wheel] * pulses_per_cm_[wheel]);
        inputs.tach_count[wheel] =
            static_cast<std::uint16_t>(static_cast<std::int64_t>(pulses) & 0xFFFF);
    }
    inputs.tach_present = (1u << hal::kWheelCount) - 1u;
    if (steps_to_scan_ == 0) {
        scan(state, inputs);
        steps_to_scan_ = model_.range_scan_steps;
        last_scan_.range_scan_count = inputs.range_scan_count;
        last_scan_.range_present = inputs.range_present;
        std::copy(std::begin(inputs.range_q1_mm), std::end(inputs.range_q1_mm),
                  std::begin(last_scan_.range_q1_mm));
    }
    --steps_to_scan_;
    return inputs;
}

}  // namespace host_sim
