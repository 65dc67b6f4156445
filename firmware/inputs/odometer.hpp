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

/// Wheels of a side, front to rear.
inline constexpr uint8_t kLeftWheels[3] = {0, 2, 4};
inline constexpr uint8_t kRightWheels[3] = {1, 3, 5};

struct Odometer {
    uint16_t last_count[hal::kWheelCount] = {};
    bool started = false;
    int32_t rest_q17_mm = 0;  ///< travel not yet in the total, below 1/16 mm
    int32_t turn_rest_q17_mm = 0;
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
    int16_t turn_q4_mm = 0;
    bool moving = false;  ///< any present wheel counted
    bool valid = false;   ///< at least one side has a tachometer
};

/// Middle one of three.
constexpr int16_t median3(int16_t a, int16_t b, int16_t c) {
    return max(min(a, b), min(max(a, b), c));
}

constexpr bool is_present(uint8_t present, uint8_t wheel) {
    return bit_and(shift_floor(present, wheel), uint8_t{1}) != 0;
}

/// What stands for one side: median of three, mean of two rounded down, the one.
/// @return  number of wheels present; with 0, `result` is untouched
constexpr uint8_t middle_of_side(const int16_t (&value)[hal::kWheelCount], uint8_t present,
                                 const uint8_t (&wheels)[3], int16_t& result) {
    int16_t seen[3] = {};
    uint8_t count = 0;
    for (const uint8_t wheel : wheels) {
        if (!is_present(present, wheel)) continue;
        seen[count] = value[wheel];
        ++count;
    }
    if (count == 1) result = seen[0];
    if (count == 2) result = average(seen[0], seen[1]);
    if (count == 3) result = median3(seen[0], seen[1], seen[2]);
    return count;
}

/// Pulses that a side advances in this step: its middle wheel's, counted since reset. What the
/// other wheels are ahead or behind is kept, so that wheels which count in turn lose nothing; of
/// two wheels it is the odd pulse.
/// @return  false when no wheel of the side is present
constexpr bool side_pulses(Odometer& odometer, const int16_t (&pulses)[hal::kWheelCount],
                           uint8_t present, const uint8_t (&wheels)[3], int16_t& result) {
    for (const uint8_t wheel : wheels) {
        int16_t& lead = odometer.lead_count[wheel];
        lead = is_present(present, wheel) ? add_wrap(lead, pulses[wheel]) : int16_t{0};
    }
    const uint8_t count = middle_of_side(odometer.lead_count, present, wheels, result);
    int16_t odd_pulse = 0;
    for (const uint8_t wheel : wheels) {
        if (!is_present(present, wheel)) continue;
        int16_t& lead = odometer.lead_count[wheel];
        lead = sub_wrap(lead, result);
        odd_pulse = add_wrap(odd_pulse, lead);
        if (count == 2) lead = 0;
        lead = clamp(lead, static_cast<int16_t>(-kTachLeadMaxCount), kTachLeadMaxCount);
    }
    if (count == 2) {
        const uint8_t first = is_present(present, wheels[0]) ? wheels[0] : wheels[1];
        odometer.lead_count[first] = odd_pulse;  // 0 or 1
    }
    return count > 0;
}

/// Takes whole sixteenths of a millimetre out of a remainder in Q17.
constexpr int16_t take_whole_q4_mm(int32_t& rest_q17_mm) {
    const int16_t whole = narrow_sat_s16(shift_floor<13>(rest_q17_mm));
    rest_q17_mm = sub_wrap(rest_q17_mm, shift_left_wrap<13>(widen_s32(whole)));
    return whole;
}

/// One control step. The first call only remembers the counters.
constexpr OdometerStep odometer_step(Odometer& odometer, const hal::RawInputs& inputs,
                                     const hal::Calibration& calibration) {
    int16_t pulses[hal::kWheelCount] = {};
    OdometerStep step;
    for (uint8_t wheel = 0; wheel < hal::kWheelCount; ++wheel) {
        const int16_t difference =
            narrow_wrap_s16(sub_wrap(inputs.tach_count[wheel], odometer.last_count[wheel]));
        odometer.last_count[wheel] = inputs.tach_count[wheel];
        if (!odometer.started || !is_present(inputs.tach_present, wheel)) continue;
        // A counter that jumps by about a quarter of its range has been upset, not driven.
        if (abs_u16(difference) > kTachStepMaxCount) continue;
        pulses[wheel] = difference;
        odometer.wheel_cycle_count[wheel] = add_sat(odometer.wheel_cycle_count[wheel], difference);
        if (difference != 0) step.moving = true;
    }
    odometer.started = true;
    int16_t left = 0;
    int16_t right = 0;
    const bool has_left = side_pulses(odometer, pulses, inputs.tach_present, kLeftWheels, left);
    const bool has_right = side_pulses(odometer, pulses, inputs.tach_present, kRightWheels, right);
    if (!has_left && !has_right) return step;
    if (!has_left) left = right;
    if (!has_right) right = left;
    // Twice the mean, so that no half pulse is lost: Q16 per pulse becomes Q17.
    const int32_t forward = mul_wide(add_sat(left, right), calibration.tach_q16_mm_per_count);
    const int32_t turn = mul_wide(sub_sat(right, left), calibration.tach_q16_mm_per_count);
    odometer.rest_q17_mm = add_sat(odometer.rest_q17_mm, forward);
    odometer.turn_rest_q17_mm = add_sat(odometer.turn_rest_q17_mm, turn);
    step.travel_q4_mm = take_whole_q4_mm(odometer.rest_q17_mm);
    step.turn_q4_mm = take_whole_q4_mm(odometer.turn_rest_q17_mm);
    odometer.travel_q4_mm = add_wrap(odometer.travel_q4_mm, widen_s32(step.travel_q4_mm));
    odometer.turn_q4_mm = add_wrap(odometer.turn_q4_mm, widen_s32(step.turn_q4_mm));
    step.valid = true;
    return step;
}

/// Once a cycle: does a present wheel disagree with the median of its side by more than
/// kTachDisagreeQ4Mm? Clears the cycle counts.
constexpr bool tachometers_disagree(Odometer& odometer, uint8_t present,
                                    const hal::Calibration& calibration) {
    bool disagree = false;
    for (uint8_t side = 0; side < 2; ++side) {
        const auto& wheels = side == 0 ? kLeftWheels : kRightWheels;
        int16_t middle = 0;
        if (middle_of_side(odometer.wheel_cycle_count, present, wheels, middle) == 0) continue;
        for (const uint8_t wheel : wheels) {
            if (!is_present(present, wheel)) continue;
            const int16_t off = sub_sat(odometer.wheel_cycle_count[wheel], middle);
            const uint32_t off_q4_mm =
                shift_floor<12>(mul_wide(abs_u16(off), calibration.tach_q16_mm_per_count));
            if (off_q4_mm > kTachDisagreeQ4Mm) disagree = true;
        }
    }
    for (int16_t& count : odometer.wheel_cycle_count) count = 0;
    return disagree;
}

}  // namespace rover
