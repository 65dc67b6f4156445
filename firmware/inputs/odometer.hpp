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

inline constexpr uint8_t kSideCount = 2;
inline constexpr uint8_t kSideWheelCount = 3;
static_assert(kSideCount * kSideWheelCount == hal::kWheelCount);

/// A side's wheels are every second one, front to rear: the left from 0, the right from 1 on. As
/// bits, the right side's shifted down by one:
inline constexpr uint8_t kSideWheels = 0b01'01'01;

/// One wheel. How far it is ahead of its side is kept, within +-kTachLeadMaxCount: the middle one
/// of three small whole numbers, taken anew in every step, would be a biased mean.
struct OdometerWheel {
    uint16_t last_count = 0;  ///< its counter in the last step
    /// Pulses ahead of where its side stood before the last step, plus kTachLeadMaxCount: so a lead
    /// is never negative.
    int16_t ahead_count = 0;
    int16_t drift_count = 0;  ///< taken out of the lead in this cycle
};

struct OdometerSide {
    int16_t pulses = 0;     ///< what it advanced in the last step
    uint8_t odd_pulse = 0;  ///< of two wheels, whose mean is rounded down: 0 or 1
};

struct Odometer {
    OdometerWheel wheel[hal::kWheelCount];  ///< the left side's, then the right side's
    OdometerSide side[kSideCount];
    uint8_t present = 0;            ///< wheels of the last step
    uint16_t drift_max_count = 0;   ///< largest drift of any wheel in this cycle
    uint16_t rest_q20_mm = 0;       ///< travel not yet in the total, below 1/16 mm
    uint16_t turn_rest_q20_mm = 0;  ///< the same of turn
    int32_t travel_q4_mm = 0;       ///< mean rim travel of both sides since reset
    int16_t turn_q4_mm = 0;         ///< half the difference of the sides since the last cycle
};

/// What one step added.
struct OdometerStep {
    int16_t travel_q4_mm = 0;  ///< [-30400, 30400]
    bool moving = false;       ///< any present wheel counted
    bool valid = false;        ///< at least one wheel is present
};
static_assert(2l * 8 * kTachStepMaxCount <= 30400, "the travel of a step, a pulse below 1 mm");

/// A counter that has been upset, not driven.
constexpr bool is_upset(int16_t pulses) {
    return narrow_wrap_u16(add_wrap(pulses, int16_t{kTachStepMaxCount})) > 2 * kTachStepMaxCount;
}

constexpr bool is_less(int16_t a, int16_t b) {
    return sub_wrap(a, b) < 0;
}
/// Middle one of three that are less than 2^15 apart.
[[gnu::noinline]] constexpr int16_t median3(int16_t a, int16_t b, int16_t c) {
    const int16_t low = is_less(b, a) ? b : a;
    const int16_t high = is_less(b, a) ? a : b;
    if (is_less(c, low)) return low;
    return is_less(c, high) ? c : high;
}

/// Takes out of a lead what is beyond the limits: it is drift. A side that lacks a wheel keeps no
/// leads, because the mean of two would lose what is taken out of one.
/// @return  the lead, plus kTachLeadMaxCount
constexpr int16_t limit_lead(OdometerWheel& wheel, int16_t lead, bool whole,
                             uint16_t& drift_max_count) {
    int16_t kept = lead < 0 ? int16_t{0} : int16_t{2 * kTachLeadMaxCount};
    if (!whole) kept = kTachLeadMaxCount;
    wheel.drift_count = add_wrap(wheel.drift_count, sub_wrap(lead, kept));
    drift_max_count = max(drift_max_count, abs_u16(wheel.drift_count));
    return kept;
}

/// What a side advances: its middle wheel; or the mean of two, whose odd pulse stays for the next
/// step; or the only one.
/// @param wheel  its wheels, front first
constexpr int16_t side_pulses(const OdometerWheel* wheel, OdometerSide& side, uint8_t used) {
    const int16_t front = wheel[0].ahead_count;
    const int16_t middle = wheel[1].ahead_count;
    const int16_t rear = wheel[2].ahead_count;
    if (used == kSideWheels) return sub_wrap(median3(front, middle, rear), kTachLeadMaxCount);
    const int16_t sum = add_wrap(add_wrap(front, middle), rear);
    const int16_t pulses =
        add_wrap(sub_wrap(sum, int16_t{3 * kTachLeadMaxCount}), widen_s16(side.odd_pulse));
    side.odd_pulse = 0;
    if (used != 0b00'01'01 && used != 0b01'00'01 && used != 0b01'01'00) return pulses;
    side.odd_pulse = bit_and(narrow_wrap_u8(pulses), uint8_t{1});
    return halve_floor(pulses);
}

/// One step of a side.
/// @param wheel   the front one of its wheels
/// @param tach    its counter; those behind follow at every second place
/// @param used    the wheels that count: bits of kSideWheels
/// @param moving  set when one of them counted
/// @return  pulses
[[gnu::noinline]] constexpr int16_t side_step(OdometerWheel* wheel, OdometerSide& side,
                                              const uint16_t* tach, uint8_t used,
                                              uint16_t& drift_max_count, bool& moving) {
    const bool whole = used == kSideWheels;
    const OdometerWheel* const first = wheel;
    const int16_t before = side.pulses;
    uint8_t bits = bit_or(used, uint8_t{0x40});  // and one to end with
    do {
        const uint16_t count = *tach;
        tach += kSideCount;
        int16_t pulses = narrow_wrap_s16(sub_wrap(count, wheel->last_count));
        wheel->last_count = count;
        int16_t lead = sub_wrap(wheel->ahead_count, before);
        if (!whole || narrow_wrap_u16(lead) > 2 * kTachLeadMaxCount) {
            if (bit_and(bits, uint8_t{1}) != 0) {
                lead = limit_lead(*wheel, lead, whole, drift_max_count);
            } else {
                pulses = 0;
                lead = kTachLeadMaxCount;
                wheel->drift_count = 0;
            }
        }
        if (is_upset(pulses)) pulses = 0;
        if (pulses != 0) moving = true;
        wheel->ahead_count = add_wrap(lead, pulses);
        ++wheel;
        bits = shift_floor<kSideCount>(bits);
    } while (bits != 1);
    side.pulses = side_pulses(first, side, used);
    return side.pulses;
}

/// Adds the rim travel of a number of pulses to a rest, s32 Q20 mm. Exact.
/// @param pulses_q1  twice the mean of both sides, so that no half pulse is lost; at most
///                   2 kTachStepMaxCount either way
/// @return  whole sixteenths of a millimetre above the new rest
[[gnu::noinline]] constexpr uint32_t add_travel(int16_t pulses_q1, uint16_t rest_q20_mm,
                                                const hal::Calibration& calibration) {
    const uint16_t pulses_q4 = shift_left_wrap<3>(abs_u16(pulses_q1));
    const uint32_t size = mul_wide(pulses_q4, calibration.tach_q16_mm_per_count);
    const uint32_t rest = widen_u32(rest_q20_mm);
    return pulses_q1 < 0 ? sub_wrap(rest, size) : add_wrap(rest, size);
}

/// One control step. A wheel that has just come only shows its counter; a side without wheels
/// follows the other.
[[gnu::noinline]] constexpr void odometer_step(Odometer& odometer, const hal::RawInputs& inputs,
                                               const hal::Calibration& calibration,
                                               OdometerStep& step) {
    step.travel_q4_mm = 0;
    step.moving = false;
    const uint8_t present = bit_and(inputs.tach_present, uint8_t{0b11'11'11});
    step.valid = present != 0;
    const uint8_t used = bit_and(present, odometer.present);
    odometer.present = present;
    const uint8_t used_left = bit_and(used, kSideWheels);
    const uint8_t used_right = bit_and(shift_floor<1>(used), kSideWheels);
    int16_t left = side_step(odometer.wheel, odometer.side[0], inputs.tach_count, used_left,
                             odometer.drift_max_count, step.moving);
    int16_t right =
        side_step(odometer.wheel + kSideWheelCount, odometer.side[1], inputs.tach_count + 1,
                  used_right, odometer.drift_max_count, step.moving);
    if (used_left == 0) left = right;
    if (used_right == 0) right = left;
    if (left != right) {
        const uint32_t turn =
            add_travel(sub_wrap(right, left), odometer.turn_rest_q20_mm, calibration);
        odometer.turn_rest_q20_mm = narrow_wrap_u16(turn);
        odometer.turn_q4_mm = add_wrap(odometer.turn_q4_mm, narrow_wrap_s16(shift_floor<16>(turn)));
    }
    const int16_t both = add_wrap(left, right);
    if (both == 0) return;
    const uint32_t travel = add_travel(both, odometer.rest_q20_mm, calibration);
    odometer.rest_q20_mm = narrow_wrap_u16(travel);
    step.travel_q4_mm = narrow_wrap_s16(shift_floor<16>(travel));
    odometer.travel_q4_mm = add_wrap(odometer.travel_q4_mm, widen_s32(step.travel_q4_mm));
}
constexpr OdometerStep odometer_step(Odometer& odometer, const hal::RawInputs& inputs,
                                     const hal::Calibration& calibration) {
    OdometerStep step;
    odometer_step(odometer, inputs, calibration, step);
    return step;
}

/// Once a cycle: has a wheel gone kTachDisagreeMm or more ahead of its side, or behind it, since
/// the last one? What its lead holds counts in full. Begins the next cycle.
/// @cost  a product when a wheel is off by 15 pulses; fewer are less than 15 mm at any scale
[[gnu::noinline]] constexpr bool tachometers_disagree(Odometer& odometer,
                                                      const hal::Calibration& calibration) {
    if (odometer.drift_max_count == 0) return false;
    const uint16_t off = add_wrap(odometer.drift_max_count, uint16_t{kTachLeadMaxCount});
    odometer.drift_max_count = 0;
    static_assert(hal::kWheelCount == 6, "one by one takes less than a loop");
    odometer.wheel[0].drift_count = 0;
    odometer.wheel[1].drift_count = 0;
    odometer.wheel[2].drift_count = 0;
    odometer.wheel[3].drift_count = 0;
    odometer.wheel[4].drift_count = 0;
    odometer.wheel[5].drift_count = 0;
    if (off < kTachDisagreeMm) return false;
    const uint32_t off_q16_mm = mul_wide(off, calibration.tach_q16_mm_per_count);
    return narrow_wrap_u16(shift_floor<16>(off_q16_mm)) >= kTachDisagreeMm;
}

}  // namespace rover
