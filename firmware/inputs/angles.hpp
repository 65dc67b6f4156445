// angles.hpp - converter counts to angles, and which channels cannot be believed.
// Depends on   hal/io.hpp, hal/calibration.hpp, core/arith.hpp.
// Bounds       five channels; 20 bytes of state.
#pragma once

#include "firmware/config/controller_tuning.hpp"
#include "firmware/core/arith.hpp"
#include "firmware/executive/estimates.hpp"
#include "hal/calibration.hpp"
#include "hal/io.hpp"

namespace rover {

/// An angle, if the sensor gave one.
struct AngleReading {
    int16_t brad = 0;
    bool valid = false;
};

struct Angles {
    AngleReading channel[hal::kAngleChannelCount];

    constexpr const AngleReading& operator[](hal::AngleChannel which) const {
        return channel[static_cast<uint8_t>(which)];
    }
};

/// angle = (count - zero) * gain, s16 brad, rounded half up in magnitude, saturating.
constexpr int16_t angle_from_count(uint16_t adc_q4_count,
                                   const hal::AngleCalibration& calibration) {
    const bool above = adc_q4_count >= calibration.zero_q4_count;
    const uint16_t away = above ? sub_wrap(adc_q4_count, calibration.zero_q4_count)
                                : sub_wrap(calibration.zero_q4_count, adc_q4_count);
    const uint16_t scaled = narrow_wrap_u16(
        shift_floor<16>(add_wrap(mul_wide(away, calibration.gain_q16), uint32_t{0x8000})));
    const int16_t magnitude = narrow_sat_s16(scaled);
    return above != calibration.inverted ? magnitude : neg_wrap(magnitude);
}

/// Fault bit of each angle channel, in the order of hal::AngleChannel.
inline constexpr uint16_t kAngleFault[hal::kAngleChannelCount] = {
    kFaultBogieLeft, kFaultBogieRight, kFaultDifferential, kFaultPitch, kFaultRoll};
inline constexpr hal::AdcChannel kAngleAdc[hal::kAngleChannelCount] = {
    hal::AdcChannel::bogie_left, hal::AdcChannel::bogie_right, hal::AdcChannel::differential,
    hal::AdcChannel::pitch, hal::AdcChannel::roll};

/// Watches for sensors that never change while the others do.
struct StuckWatch {
    uint16_t last_q4_count[hal::kAngleChannelCount] = {};
    uint8_t same_cycles[hal::kAngleChannelCount] = {};
};

constexpr uint16_t angle_count(const hal::RawInputs& inputs, uint8_t channel) {
    return inputs.adc_q4_count[static_cast<uint8_t>(kAngleAdc[channel])];
}

/// Once a slip-and-sinkage cycle. A channel is stuck when its sum of 16 conversions has been the
/// same for kStuckCycles cycles in which at least one other channel changed.
[[gnu::noinline]] constexpr void watch_cycle(StuckWatch& watch, const hal::RawInputs& inputs) {
    bool any_changed = false;
    for (uint8_t i = 0; i < hal::kAngleChannelCount; ++i) {
        if (angle_count(inputs, i) != watch.last_q4_count[i]) any_changed = true;
    }
    for (uint8_t i = 0; i < hal::kAngleChannelCount; ++i) {
        const uint16_t count = angle_count(inputs, i);
        if (count != watch.last_q4_count[i]) {
            watch.same_cycles[i] = 0;
        } else if (any_changed && watch.same_cycles[i] < kStuckCycles) {
            ++watch.same_cycles[i];
        }
        watch.last_q4_count[i] = count;
    }
}

/// Angles of this step; a channel that is absent, at a rail, uncalibrated or stuck is not valid.
/// @return  Fault bits of the channels that are present but not to be believed
[[gnu::noinline]] constexpr uint16_t read_angles(const hal::RawInputs& inputs,
                                                 const hal::Calibration& calibration,
                                                 const StuckWatch& watch, Angles& angles) {
    uint16_t faults = 0;
    for (uint8_t i = 0; i < hal::kAngleChannelCount; ++i) {
        const uint16_t count = angle_count(inputs, i);
        AngleReading& reading = angles.channel[i];
        reading = AngleReading{};
        if (count > hal::kAdcMaxQ4Count) continue;  // absent
        const bool at_rail = count == 0 || count == hal::kAdcMaxQ4Count;
        const bool stuck = watch.same_cycles[i] >= kStuckCycles && count == watch.last_q4_count[i];
        if (at_rail || stuck || calibration.angle[i].gain_q16 == 0) {
            faults = bit_or(faults, kAngleFault[i]);
            continue;
        }
        reading.brad = angle_from_count(count, calibration.angle[i]);
        reading.valid = true;
    }
    return faults;
}

}  // namespace rover
