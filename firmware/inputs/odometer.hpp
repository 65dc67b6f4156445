// odometer.hpp - six tachometer counters to rim travel: forward, and turning on the spot.
// Depends on   hal/io.hpp, hal/calibration.hpp, core/arith.hpp.
// Bounds       six wheels; no rounding is lost: remainders are carried.
// Design note  docs/design/controller.md, "Odometry": a side is its middle wheel, so one dead or
//              racing tachometer in three changes nothing but its fault bit.
#pragma once

#include "firmware/config/controller_tuning.hpp"
#include "firmware/core/arith.hpp"
#include "hal/calibration.hpp"
#include "hal/io.hpp"

namespace rover {

struct Odometer {
    uint16_t last_count[hal::kWheelCount] = {};
    bool started = false;
    uint16_t rest_q17_mm = 0;  ///< travel not yet in the total, below 1/16 mm
    uint16_t turn_rest_q17_mm = 0;
    int32_t travel_q4_mm = 0;  ///< mean rim travel of both sides since reset
    int32_t turn_q4_mm = 0;    ///< half the difference of the sides since reset
    /// Pulses that a wheel is ahead of its side, within +-kTachLeadMaxCount. The middle one of
    /// three small whole numbers, taken anew in every step, would be a biased mean.
    int16_t lead_count[hal::kWheelCount] = {};
    int16_t wheel_cycle_count[hal::kWheelCount] = {};  ///< pulses since the last cycle, saturating
};

/// What one step added.
struct OdometerStep {
    int16_t travel_q4_mm = 0;
    bool moving = false;  ///< any present wheel counted
    bool valid = false;   ///< at least one side has a tachometer
};

/// Middle one of three.
constexpr int16_t median3(int16_t a, int16_t b, int16_t c) {
    return max(min(a, b), min(max(a, b), c));
}

/// The wheels of a side are every second one, front to rear: the left from 0, the right from 1 on.
inline constexpr uint8_t kSideStep = 2;

/// What stands for one side: median of three, mean of two rounded down, the one.
/// @param value    of the side's front wheel and every second one behind it
/// @param present  bit 0: the front wheel, bit 2, bit 4
/// @return  number of wheels present; with 0, `result` is untouched
constexpr uint8_t middle_of_side(const int16_t* value, uint8_t present, int16_t& result) {
    if (bit_and(present, uint8_t{0x15}) == 0x15) {
        result = median3(value[0], value[kSideStep], value[2 * kSideStep]);
        return 3;
    }
    uint8_t count = 0;
    for (uint8_t wheel = 0; wheel < hal::kWheelCount; wheel += kSideStep) {
        if (bit_and(present, uint8_t{1}) != 0) {
            result = count == 0 ? value[wheel] : average(result, value[wheel]);
            ++count;
        }
        present = shift_floor<kSideStep>(present);
    }
    return count;
}

/// Pulses that a side advances in this step: its middle wheel's, counted since reset. What the
/// other wheels are ahead or behind is kept, so that wheels which count in turn lose nothing; of
/// two wheels it is the odd pulse.
/// @param lead     of the side's front wheel and every second one behind it; this step's pulses
/// added
/// @param present  bit 0: the front wheel, bit 2, bit 4
/// @return  false when no wheel of the side is present
constexpr bool side_pulses(int16_t* lead, uint8_t present, int16_t& result) {
    const uint8_t count = middle_of_side(lead, present, result);
    int16_t odd_pulse = 0;
    uint8_t first = hal::kWheelCount;
    for (uint8_t wheel = 0; wheel < hal::kWheelCount; wheel += kSideStep) {
        if (bit_and(present, uint8_t{1}) != 0) {
            if (first == hal::kWheelCount) first = wheel;
            const int16_t rest = sub_wrap(lead[wheel], result);
            odd_pulse = add_wrap(odd_pulse, rest);
            lead[wheel] = clamp(rest, static_cast<int16_t>(-kTachLeadMaxCount), kTachLeadMaxCount);
            if (count == 2) lead[wheel] = 0;
        }
        present = shift_floor<kSideStep>(present);
    }
    if (count == 2) lead[first] = odd_pulse;  // 0 or 1
    return count > 0;
}

/// Adds pulses to a total in whole sixteenths of a millimetre; the rest is kept.
/// @param pulses_q1  twice the mean of both sides, so that no half pulse is lost; at most 32000
///                   either way, so that no sum overflows
/// @return  what was added, saturated
[[gnu::noinline]] constexpr int16_t add_travel(int16_t pulses_q1, uint16_t q16_mm_per_count,
                                               uint16_t& rest_q17_mm, int32_t& total_q4_mm) {
    const int32_t sum_q17_mm =
        add_wrap(mul_wide(pulses_q1, q16_mm_per_count), widen_s32(rest_q17_mm));
    rest_q17_mm = bit_and(narrow_wrap_u16(sum_q17_mm), uint16_t{0x1FFF});
    const int32_t whole_q4_mm = shift_floor<13>(sum_q17_mm);
    total_q4_mm = add_wrap(total_q4_mm, whole_q4_mm);
    return narrow_sat_s16(whole_q4_mm);
}

/// Takes this step's counters: pulses go to the leads and to the counts of the cycle.
/// @return  true when a present wheel counted
constexpr bool count_pulses(Odometer& odometer, const hal::RawInputs& inputs) {
    bool moving = false;
    uint8_t present = inputs.tach_present;
    for (uint8_t wheel = 0; wheel < hal::kWheelCount; ++wheel) {
        const uint16_t count = inputs.tach_count[wheel];
        const int16_t pulses = narrow_wrap_s16(sub_wrap(count, odometer.last_count[wheel]));
        odometer.last_count[wheel] = count;
        const bool here = bit_and(present, uint8_t{1}) != 0;
        present = halve_floor(present);
        if (!here) {
            odometer.lead_count[wheel] = 0;
            continue;
        }
        // A counter that jumps by about a quarter of its range has been upset, not driven.
        if (pulses == 0 || !odometer.started || abs_u16(pulses) > kTachStepMaxCount) continue;
        odometer.lead_count[wheel] = add_wrap(odometer.lead_count[wheel], pulses);
        odometer.wheel_cycle_count[wheel] = add_sat(odometer.wheel_cycle_count[wheel], pulses);
        moving = true;
    }
    odometer.started = true;
    return moving;
}

/// One control step. The first call only remembers the counters.
[[gnu::noinline]] constexpr void odometer_step(Odometer& odometer, const hal::RawInputs& inputs,
                                               const hal::Calibration& calibration,
                                               OdometerStep& step) {
    step = OdometerStep{};
    step.moving = count_pulses(odometer, inputs);
    int16_t left = 0;
    int16_t right = 0;
    const bool has_left = side_pulses(odometer.lead_count, inputs.tach_present, left);
    const bool has_right =
        side_pulses(odometer.lead_count + 1, halve_floor(inputs.tach_present), right);
    if (!has_left && !has_right) return;
    if (!has_left) left = right;
    if (!has_right) right = left;
    const uint16_t scale = calibration.tach_q16_mm_per_count;
    step.travel_q4_mm =
        add_travel(add_sat(left, right), scale, odometer.rest_q17_mm, odometer.travel_q4_mm);
    add_travel(sub_sat(right, left), scale, odometer.turn_rest_q17_mm, odometer.turn_q4_mm);
    step.valid = true;
}
constexpr OdometerStep odometer_step(Odometer& odometer, const hal::RawInputs& inputs,
                                     const hal::Calibration& calibration) {
    OdometerStep step;
    odometer_step(odometer, inputs, calibration, step);
    return step;
}

/// Once a cycle: does a present wheel disagree with the median of its side by more than
/// kTachDisagreeQ4Mm? Clears the cycle counts.
[[gnu::noinline]] constexpr bool tachometers_disagree(Odometer& odometer, uint8_t present,
                                                      const hal::Calibration& calibration) {
    // More pulses than this are more than kTachDisagreeQ4Mm: |off| * k / 2^12 > limit, all whole.
    const uint16_t allowed_count =
        div_floor_sat_u16(shift_left_wrap<12>(uint32_t{kTachDisagreeQ4Mm + 1u}) - 1u,
                          calibration.tach_q16_mm_per_count);
    bool disagree = false;
    for (uint8_t side = 0; side < kSideStep; ++side) {
        int16_t middle = 0;
        int16_t* const count = odometer.wheel_cycle_count + side;
        middle_of_side(count, shift_floor(present, side), middle);
        uint8_t here = shift_floor(present, side);
        for (uint8_t wheel = 0; wheel < hal::kWheelCount; wheel += kSideStep) {
            const uint16_t off = abs_u16(sub_sat(count[wheel], middle));
            count[wheel] = 0;
            if (bit_and(here, uint8_t{1}) != 0 && off > allowed_count) disagree = true;
            here = shift_floor<kSideStep>(here);
        }
    }
    return disagree;
}

}  // namespace rover
