// angles.hpp - converter counts to angles, and which channels cannot be believed.
// Depends on   hal/io.hpp, hal/calibration.hpp, core/arith.hpp.
// Bounds       five channels, four products a step.
// Design note  docs/design/controller.md     Tests  tests/firmware/inputs/angles_test.cpp
#pragma once

#include "firmware/config/controller_tuning.hpp"
#include "firmware/core/arith.hpp"
#include "firmware/executive/estimates.hpp"
#include "hal/calibration.hpp"
#include "hal/io.hpp"

namespace rover {

/// A channel as a bit of Angles, which is its fault bit too.
constexpr uint8_t channel_bit(hal::AngleChannel channel) {
    return shift_left_wrap(uint8_t{1}, static_cast<uint8_t>(channel));
}
static_assert(channel_bit(hal::AngleChannel::bogie_left) == kFaultBogieLeft &&
              channel_bit(hal::AngleChannel::bogie_right) == kFaultBogieRight &&
              channel_bit(hal::AngleChannel::differential) == kFaultDifferential &&
              channel_bit(hal::AngleChannel::pitch) == kFaultPitch &&
              channel_bit(hal::AngleChannel::roll) == kFaultRoll);
// Angle channels are the first converter channels, in the same order.
static_assert(static_cast<uint8_t>(hal::AdcChannel::bogie_left) == 0 &&
              static_cast<uint8_t>(hal::AdcChannel::bogie_right) == 1 &&
              static_cast<uint8_t>(hal::AdcChannel::differential) == 2 &&
              static_cast<uint8_t>(hal::AdcChannel::pitch) == 3 &&
              static_cast<uint8_t>(hal::AdcChannel::roll) == 4);

inline constexpr uint8_t kAllAngles = (1u << hal::kAngleChannelCount) - 1u;

/// The angles of a step.
struct Angles {
    int16_t brad[hal::kAngleChannelCount] = {};  ///< 0 where not valid
    uint8_t valid = 0;                           ///< channel bits: the sensor gave an angle
    uint8_t faults = 0;  ///< channel bits: it is there, and not to be believed
    uint8_t stuck = 0;   ///< channel bits: it repeats what it said when it was found stuck

    constexpr int16_t operator[](hal::AngleChannel which) const {
        return brad[static_cast<uint8_t>(which)];
    }
    constexpr bool has(hal::AngleChannel which) const {
        return bit_and(valid, channel_bit(which)) != 0;
    }
};

/// angle = (count - zero) * gain, s16 brad, rounded half up in magnitude, saturating.
constexpr int16_t angle_from_count(uint16_t adc_q4_count,
                                   const hal::AngleCalibration& calibration) {
    const int32_t away_q4_count =
        sub_wrap(widen_s32(adc_q4_count), widen_s32(calibration.zero_q4_count));
    const bool below = away_q4_count < 0;
    const uint16_t offset = narrow_wrap_u16(away_q4_count);
    const uint16_t distance = below ? neg_wrap(offset) : offset;
    const uint16_t scaled = narrow_wrap_u16(
        shift_floor<16>(add_wrap(mul_wide(distance, calibration.gain_q16), uint32_t{0x8000})));
    int16_t magnitude = narrow_wrap_s16(scaled);
    // The upper byte alone tells; as a minimum it would be a comparison of words.
    if (narrow_wrap_u8(shift_floor<8>(scaled)) >= 0x80) [[unlikely]] {
        magnitude = kMaxOf<int16_t>;
    }
    return below != calibration.inverted ? neg_wrap(magnitude) : magnitude;
}

/// Watches for sensors that never change while the others do.
struct StuckWatch {
    uint16_t last_q4_count[hal::kAngleChannelCount] = {};
    uint8_t same_cycles[hal::kAngleChannelCount] = {};
    uint8_t stuck = 0;  ///< channel bits: at the last cycle
};

/// Channels whose sums are not those of the last cycle.
[[gnu::noinline]] constexpr uint8_t changed_channels(const StuckWatch& watch,
                                                     const hal::RawInputs& inputs) {
    uint8_t changed = 0;
    for (uint8_t i = hal::kAngleChannelCount; i != 0;) {
        --i;
        changed = shift_left_wrap<1>(changed);
        if (inputs.adc_q4_count[i] != watch.last_q4_count[i]) ++changed;
    }
    return changed;
}

/// Once a slip-and-sinkage cycle. A channel is stuck when its sum of 16 conversions has been the
/// same for kStuckCycles cycles in which at least one other channel changed.
[[gnu::noinline]] constexpr void watch_cycle(StuckWatch& watch, const hal::RawInputs& inputs) {
    const uint8_t changed = changed_channels(watch, inputs);
    if (changed == 0) return;
    static_assert(hal::kAngleChannelCount == 5, "one by one takes less than a loop");
    watch.last_q4_count[0] = inputs.adc_q4_count[0];
    watch.last_q4_count[1] = inputs.adc_q4_count[1];
    watch.last_q4_count[2] = inputs.adc_q4_count[2];
    watch.last_q4_count[3] = inputs.adc_q4_count[3];
    watch.last_q4_count[4] = inputs.adc_q4_count[4];
    uint8_t stuck = 0;
    uint8_t bit = 1;
    for (uint8_t& same_cycles : watch.same_cycles) {
        if (bit_and(changed, bit) != 0) {
            same_cycles = 0;
        } else if (same_cycles < kStuckCycles) {
            ++same_cycles;
        }
        if (same_cycles == kStuckCycles) stuck = bit_or(stuck, bit);
        bit = shift_left_wrap<1>(bit);
    }
    watch.stuck = stuck;
}

/// Rails and absence are the counts from -16 to 0, modulo 2^16.
constexpr bool is_no_angle(uint16_t q4_count) {
    static_assert(hal::kAdcMaxQ4Count == 65536 - 16);
    return add_wrap(q4_count, uint16_t{16}) <= 16;
}

/// A channel gives no angle, which is a fault unless it is absent.
[[gnu::noinline]] constexpr void refuse_angle(Angles& angles, uint16_t q4_count, uint8_t bit) {
    angles.valid = bit_xor(angles.valid, bit);
    if (q4_count <= hal::kAdcMaxQ4Count) angles.faults = bit_or(angles.faults, bit);
}

/// The angle of a channel; 0, and not valid, if it is at a rail, absent, uncalibrated or stuck.
/// That of the right bogie is left 0 while the left one is valid: nobody asks for it.
[[gnu::noinline]] constexpr int16_t read_angle(Angles& angles, uint16_t q4_count,
                                               const hal::AngleCalibration& calibration,
                                               uint8_t bit) {
    using enum hal::AngleChannel;
    if (is_no_angle(q4_count) || calibration.gain_q16 == 0 || bit_and(angles.stuck, bit) != 0) {
        refuse_angle(angles, q4_count, bit);
        return 0;
    }
    if (bit == channel_bit(bogie_right) && angles.has(bogie_left)) return 0;
    return angle_from_count(q4_count, calibration);
}

/// Angles of this step; a channel that is absent, at a rail, uncalibrated or stuck is not valid.
[[gnu::noinline]] constexpr void read_angles(const hal::RawInputs& inputs,
                                             const hal::Calibration& calibration,
                                             const StuckWatch& watch, Angles& angles) {
    using enum hal::AngleChannel;
    const uint16_t* const count = inputs.adc_q4_count;
    const hal::AngleCalibration* const by = calibration.angle;
    angles.valid = kAllAngles;
    angles.faults = 0;
    angles.stuck = watch.stuck;
    if (watch.stuck != 0) {
        angles.stuck = bit_and(watch.stuck, bit_xor(changed_channels(watch, inputs), kAllAngles));
    }
    angles.brad[0] = read_angle(angles, count[0], by[0], channel_bit(bogie_left));
    angles.brad[1] = read_angle(angles, count[1], by[1], channel_bit(bogie_right));
    angles.brad[2] = read_angle(angles, count[2], by[2], channel_bit(differential));
    angles.brad[3] = read_angle(angles, count[3], by[3], channel_bit(pitch));
    angles.brad[4] = read_angle(angles, count[4], by[4], channel_bit(roll));
}

}  // namespace rover
