// input_walk.cpp - see input_walk.hpp.
#include "host_sim/world/input_walk.hpp"

#include <algorithm>
#include <array>

#include "host_sim/world/course.hpp"
#include "host_sim/world/faults.hpp"

namespace host_sim {

namespace {

constexpr std::array kFaultTexts = {
    "bogie_left:stuck@2-",
    "bogie_right:stuck@3-",
    "differential:stuck@1-",
    "pitch:stuck@2-",
    "roll:stuck@2-",
    "bogie_right:absent@1-4",
    "differential:dropped=0.3@0-20",
    "pitch:offset=4@3-8",
    "roll:absent@5-6",
    "tach_middle_left:absent@2-7",
    "tach:dropped=0.05@0-30",
    "tach_rear_right:stuck@3-10",
    "tach_front_left:offset=900@4-",
    "range:absent@2-12",
    "range_0:stuck@1-20",
    "range_1:dropped=0.5@0-20",
    "bogie_left:absent@0-",
    "pitch:absent@4-",
};

}  // namespace

uint32_t InputWalk::below(uint32_t limit) {
    return static_cast<uint32_t>(random_.bits() >> 33) % limit;
}

hal::Calibration InputWalk::calibration() {
    hal::Calibration record;
    if (chance(0.4)) return record;
    for (hal::AngleCalibration& angle : record.angle) {
        angle.zero_q4_count = static_cast<uint16_t>(angle.zero_q4_count + below(801) - 400);
        angle.gain_q16 = static_cast<uint16_t>(angle.gain_q16 + below(401) - 200);
        angle.inverted = chance(0.1);
    }
    record.range_offset_q1_mm = static_cast<int16_t>(static_cast<int>(below(41)) - 20);
    if (chance(0.8)) return record;
    record.version = static_cast<uint16_t>(below(3));
    record.wheel_radius_q4_mm = word();
    record.tach_q16_mm_per_count = word();
    record.angle[below(hal::kAngleChannelCount)].gain_q16 = word();
    return record;
}

DriveOptions InputWalk::course() {
    static constexpr std::array kRoughness = {0.0, 0.0025, 0.01, 0.02, 0.04, 0.08};
    Vehicle vehicle = rocky32();
    vehicle.speed_cm_per_s = std::array{3.0, 12.0, 35.0, 65.0}[below(4)];
    const auto kind = chance(0.5) ? TerrainKind::fractal : TerrainKind::wilcox1994;
    DriveOptions options =
        random_course(vehicle, kind, kRoughness[below(kRoughness.size())], 5.0, random_.bits());
    options.advance.kind = static_cast<AdvanceKind>(below(4));
    if (chance(0.3)) options.advance.mean_cm = random_.uniform(0, 3);
    if (chance(0.5)) add_exit_ramp(options, 60);
    while (chance(0.5)) {
        for (const Fault& fault : parse_faults(kFaultTexts[below(kFaultTexts.size())])) {
            options.faults.push_back(fault);
        }
    }
    if (chance(0.3)) options.hand_moves = {{random_.uniform(1, 10), random_.uniform(-20, 20)}};
    options.sensors.range_scan_steps = 1 + static_cast<int>(below(5));
    return options;
}

void InputWalk::begin() {
    steps_left_ = 40 + below(260);
    const uint32_t draw = below(10);
    kind_ = draw < 6 ? Kind::drive : draw < 9 ? Kind::wander : Kind::noise;
    calibration_ = calibration();
    drive_.reset();
    if (kind_ == Kind::drive) drive_.emplace(course());
    corruption_ = chance(0.3) ? 0.02 : 0;
    wandering_ = hal::RawInputs{};
    for (uint16_t& count : wandering_.adc_q4_count) count = 32760;
    wandering_.tach_present = 63;
    wandering_.range_present = 3;
    slope_ = 0;
    pulses_ = 250;
    turning_ = false;
    stuck_ = -1;
}

/// Hills in the counts, wheels that change speed, turn and reverse, channels that come and go.
void InputWalk::wander() {
    hal::RawInputs& now = wandering_;
    now.tick_count = static_cast<uint16_t>(now.tick_count + (chance(0.03) ? 30 : 10));
    if (!chance(0.2)) ++now.range_scan_count;
    if (chance(0.03)) pulses_ = static_cast<int>(below(700)) - 150;
    if (chance(0.03)) pulses_ = 0;
    if (chance(0.03)) turning_ = !turning_;
    for (uint8_t wheel = 0; wheel < hal::kWheelCount; ++wheel) {
        const int rolled = turning_ && wheel % 2 == 0 ? -pulses_ : pulses_;
        const int jitter = pulses_ == 0 ? 0 : static_cast<int>(below(5)) - 2;
        now.tach_count[wheel] =
            static_cast<uint16_t>(now.tach_count[wheel] + static_cast<unsigned>(rolled + jitter));
    }
    if (chance(0.02)) now.tach_present = static_cast<uint8_t>(now.tach_present ^ 1u << below(6));
    if (chance(0.02)) now.range_present = static_cast<uint8_t>(below(4));
    slope_ = std::clamp(slope_ + static_cast<int>(below(601)) - 300, -9000, 9000);
    if (chance(0.02)) stuck_ = static_cast<int>(below(2 * hal::kAngleChannelCount));
    for (uint8_t i = 0; i < hal::kAngleChannelCount; ++i) {
        if (i == stuck_) continue;
        const int bump = static_cast<int>(below(801)) - 400;
        const bool absent = now.adc_q4_count[i] == hal::kAdcAbsent;
        if (absent ? chance(0.9) : chance(0.01)) {
            now.adc_q4_count[i] = hal::kAdcAbsent;
        } else {
            now.adc_q4_count[i] = static_cast<uint16_t>(32760 + (i == 3 ? slope_ : 0) + bump);
        }
    }
    for (int16_t& range : now.range_q1_mm) range = static_cast<int16_t>(below(801)) - 400;
}

hal::RawInputs InputWalk::noise() {
    hal::RawInputs now;
    now.tick_count = word();
    for (uint16_t& count : now.adc_q4_count) count = word();
    for (uint16_t& count : now.tach_count) count = word();
    now.tach_present = static_cast<uint8_t>(word());
    now.range_present = static_cast<uint8_t>(word());
    now.range_scan_count = static_cast<uint8_t>(word());
    for (int16_t& range : now.range_q1_mm) range = static_cast<int16_t>(word());
    now.detector_bits = static_cast<uint8_t>(word());
    now.command_size = static_cast<uint8_t>(below(hal::kCommandBytesMax + 1));
    for (uint8_t& byte : now.command) byte = static_cast<uint8_t>(word());
    return now;
}

/// One field wrong, as a bad contact or a disturbed line makes it.
void InputWalk::corrupt(hal::RawInputs& inputs) {
    const hal::RawInputs wrong = noise();
    const uint32_t channel = below(hal::kAngleChannelCount);
    const uint32_t wheel = below(hal::kWheelCount);
    switch (below(6)) {
        case 0:
            inputs.adc_q4_count[channel] = wrong.adc_q4_count[channel];
            break;
        case 1:
            inputs.tach_count[wheel] = wrong.tach_count[wheel];
            break;
        case 2:
            inputs.tach_present = wrong.tach_present;
            break;
        case 3:
            inputs.range_present = wrong.range_present;
            break;
        case 4:
            inputs.range_q1_mm[0] = wrong.range_q1_mm[0];
            break;
        default:
            inputs.tick_count = wrong.tick_count;
    }
}

InputWalk::Next InputWalk::next(const hal::Commands& commands) {
    Next result;
    if (steps_left_ == 0) {
        begin();
        result.reset = true;
        result.calibration = calibration_;
    }
    --steps_left_;
    switch (kind_) {
        case Kind::drive:
            result.inputs = drive_->step(result.reset ? full_speed_ahead() : commands).inputs;
            break;
        case Kind::wander:
            wander();
            result.inputs = wandering_;
            break;
        case Kind::noise:
            result.inputs = noise();
            break;
    }
    if (corruption_ > 0 && chance(corruption_)) corrupt(result.inputs);
    return result;
}

}  // namespace host_sim
