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

    constexpr int16_t operator[](hal::AngleChannel which) const {
        return brad[static_cast<uint8_t>(which)];
    }
    constexpr bool has(hal::AngleChannel which) const {
        return bit_and(valid, channel_bit(which)) != 0;
    }
};

/// angle = (count - zero) * gain, s16 brad, rounded half up in magnitude, saturating.
[[gnu::noinline]] constexpr int16_t angle_from_count(uint16_t adc_q4_count,
                                                     const hal::AngleCalibration& calibration) {
    const bool above = adc_q4_count >= calibration.zero_q4_count;
    const uint16_t offset = sub_wrap(adc_q4_count, calibration.zero_q4_count);
    const uint16_t away = above ? offset : neg_wrap(offset);
    const uint16_t scaled = narrow_wrap_u16(
        shift_floor<16>(add_wrap(mul_wide(away, calibration.gain_q16), uint32_t{0x8000})));
    const int16_t magnitude = narrow_sat_s16(scaled);
    return above != calibration.inverted ? magnitude : neg_wrap(magnitude);
}

/// Watches for sensors that never change while the others do.
struct StuckWatch {
    uint16_t last_q4_count[hal::kAngleChannelCount] = {};
    uint8_t same_cycles[hal::kAngleChannelCount] = {};
    uint8_t stuck = 0;  ///< channel bits: at the last cycle
};

/// Once a slip-and-sinkage cycle. A channel is stuck when its sum of 16 conversions has been the
/// same for kStuckCycles cycles in which at least one other channel changed.
[[gnu::noinline]] constexpr void watch_cycle(StuckWatch& watch, const hal::RawInputs& inputs) {
    const uint16_t* count = inputs.adc_q4_count;
    uint16_t* last = watch.last_q4_count;
    uint8_t i = hal::kAngleChannelCount;
    for (; i != 0 && *count == *last; --i) {
        ++count;
        ++last;
    }
    if (i == 0) return;  // nothing has changed
    count = inputs.adc_q4_count;
    last = watch.last_q4_count;
    uint8_t stuck = 0;
    uint8_t bit = 1;
    for (uint8_t& same_cycles : watch.same_cycles) {
        if (*count != *last) {
            *last = *count;
            same_cycles = 0;
        } else if (same_cycles < kStuckCycles) {
            ++same_cycles;
        }
        if (same_cycles == kStuckCycles) stuck = bit_or(stuck, bit);
        ++count;
        ++last;
        bit = shift_left_wrap<1>(bit);
    }
    watch.stuck = stuck;
}

/// A channel that gives no angle: it is absent, or that is a fault.
[[gnu::noinline]] constexpr void refuse_angle(Angles& angles, uint16_t q4_count, uint8_t bit) {
    angles.valid = bit_xor(angles.valid, bit);
    if (q4_count <= hal::kAdcMaxQ4Count) angles.faults = bit_or(angles.faults, bit);
}

/// Channels that repeat what they said when they were found stuck.
[[gnu::noinline]] constexpr void refuse_stuck(const StuckWatch& watch, const hal::RawInputs& inputs,
                                              Angles& angles) {
    uint8_t bit = 1;
    for (uint8_t i = 0; i < hal::kAngleChannelCount; ++i) {
        const uint16_t q4_count = inputs.adc_q4_count[i];
        const bool stuck = bit_and(bit_and(watch.stuck, angles.valid), bit) != 0;
        if (stuck && q4_count == watch.last_q4_count[i]) refuse_angle(angles, q4_count, bit);
        bit = shift_left_wrap<1>(bit);
    }
}

/// Is a channel there, calibrated, and off its rails? Else it is refused.
template <hal::AngleChannel kChannel>
constexpr void judge_angle(const hal::RawInputs& inputs, const hal::Calibration& calibration,
                           Angles& angles) {
    constexpr uint8_t kIndex = static_cast<uint8_t>(kChannel);
    const uint16_t q4_count = inputs.adc_q4_count[kIndex];
    // Rails and absence are the counts from -16 to 0, modulo 2^16.
    const bool no_angle = add_wrap(q4_count, uint16_t{16}) <= 16;
    if (no_angle || calibration.angle[kIndex].gain_q16 == 0) {
        refuse_angle(angles, q4_count, channel_bit(kChannel));
    }
}
static_assert(hal::kAdcMaxQ4Count == 65536 - 16);

template <hal::AngleChannel kChannel>
constexpr void take_angle(const hal::RawInputs& inputs, const hal::Calibration& calibration,
                          Angles& angles) {
    constexpr uint8_t kIndex = static_cast<uint8_t>(kChannel);
    if (!angles.has(kChannel)) return;
    angles.brad[kIndex] = angle_from_count(inputs.adc_q4_count[kIndex], calibration.angle[kIndex]);
}

/// Angles of this step; a channel that is absent, at a rail, uncalibrated or stuck is not valid.
/// That of the right bogie is left 0 while the left one is valid: nobody asks for it.
[[gnu::noinline]] constexpr void read_angles(const hal::RawInputs& inputs,
                                             const hal::Calibration& calibration,
                                             const StuckWatch& watch, Angles& angles) {
    using enum hal::AngleChannel;
    angles = Angles{};
    angles.valid = kAllAngles;
    judge_angle<bogie_left>(inputs, calibration, angles);
    judge_angle<bogie_right>(inputs, calibration, angles);
    judge_angle<differential>(inputs, calibration, angles);
    judge_angle<pitch>(inputs, calibration, angles);
    judge_angle<roll>(inputs, calibration, angles);
    if (watch.stuck != 0) refuse_stuck(watch, inputs, angles);
    take_angle<bogie_left>(inputs, calibration, angles);
    if (!angles.has(bogie_left)) take_angle<bogie_right>(inputs, calibration, angles);
    take_angle<differential>(inputs, calibration, angles);
    take_angle<pitch>(inputs, calibration, angles);
    take_angle<roll>(inputs, calibration, angles);
}

}  // namespace rover
