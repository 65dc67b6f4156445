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

/// The wheels of a side are every second one, front to rear: the left from 0, the right from 1 on.
inline constexpr uint8_t kSideStep = 2;

/// A wheel's counter plus its offset is its place, pulses modulo 2^16; a side has a place too. How
/// far a wheel is ahead of its side is kept, within +-kTachLeadMaxCount: the middle one of three
/// small whole numbers, taken anew in every step, would be a biased mean.
struct Odometer {
    uint16_t offset_count[hal::kWheelCount] = {};
    uint16_t side_count[kSideStep] = {};         ///< minus its place, left and right
    uint8_t lead_count[hal::kWheelCount] = {};   ///< ahead of its side, modulo 2^8
    int16_t drift_count[hal::kWheelCount] = {};  ///< taken out of the lead in this cycle
    uint8_t present = 0;                         ///< wheels of the last step
    uint16_t rest_q20_mm = 0;                    ///< travel not yet in the total, below 1/16 mm
    uint16_t turn_rest_q20_mm = 0;               ///< the same of turn
    int32_t travel_q4_mm = 0;                    ///< mean rim travel of both sides since reset
    int16_t turn_q4_mm = 0;  ///< half the difference of the sides since the last cycle
};

/// What one step added.
struct OdometerStep {
    int16_t travel_q4_mm = 0;  ///< [-30400, 30400]
    bool moving = false;       ///< any present wheel counted
    bool valid = false;        ///< at least one side has a tachometer
};
static_assert(2l * 8 * kTachStepMaxCount <= 30400, "the travel of a step, a pulse below 1 mm");

/// Drift beyond this, which is a fault at any scale from 0.001 mm on, is not added up: it would
/// wrap.
inline constexpr uint16_t kTachDriftMaxCount = 16000;
static_assert(kTachDriftMaxCount + 2l * kTachStepMaxCount + 2l * kTachLeadMaxCount < 32768);

/// Middle one of three.
template <Word T>
constexpr T median3(T a, T b, T c) {
    return max(min(a, b), min(max(a, b), c));
}

/// A wheel's place from its side's, pulses modulo 2^16.
constexpr uint16_t ahead_of_side(const Odometer& odometer, const hal::RawInputs& inputs,
                                 uint8_t wheel) {
    const uint8_t side = bit_and(wheel, uint8_t{1});
    return add_wrap(add_wrap(inputs.tach_count[wheel], odometer.offset_count[wheel]),
                    odometer.side_count[side]);
}

/// Puts wheels where their sides stand: those that have just come.
/// @param come  bit w: wheel w
[[gnu::noinline]] constexpr void place_wheels(Odometer& odometer, const hal::RawInputs& inputs,
                                              uint8_t come) {
    for (uint8_t wheel = 0; wheel < hal::kWheelCount; ++wheel) {
        if (bit_and(come, uint8_t{1}) != 0) {
            odometer.offset_count[wheel] =
                sub_wrap(odometer.offset_count[wheel], ahead_of_side(odometer, inputs, wheel));
            odometer.lead_count[wheel] = 0;
            odometer.drift_count[wheel] = 0;
        }
        come = shift_floor<1>(come);
    }
}

/// Gives a present wheel a lead; what it is ahead beyond that is drift.
constexpr void set_lead(Odometer& odometer, uint8_t wheel, int16_t ahead, int16_t lead) {
    odometer.lead_count[wheel] = narrow_wrap_u8(lead);
    const int16_t drift = sub_wrap(ahead, lead);
    if (drift == 0) return;
    odometer.offset_count[wheel] = sub_wrap(odometer.offset_count[wheel], narrow_wrap_u16(drift));
    const int16_t before = odometer.drift_count[wheel];
    if (abs_u16(before) < kTachDriftMaxCount) odometer.drift_count[wheel] = add_wrap(before, drift);
}

/// A side in general: any wheels present, any numbers of pulses. Three: their middle one. Two:
/// their mean, rounded down; the odd pulse stays with the first. One: that wheel. A wheel ahead by
/// more than kTachStepMaxCount has been upset, not driven: it stands where its side stood.
/// @param first   the side's front wheel, 0 or 1
/// @param moving  set when a present wheel counted
/// @param pulses  what the side advances; untouched when no wheel of it is present
/// @return  number of wheels present
[[gnu::noinline]] constexpr uint8_t side_in_general(Odometer& odometer,
                                                    const hal::RawInputs& inputs, uint8_t first,
                                                    bool& moving, int16_t& pulses) {
    int16_t ahead[hal::kWheelCount];
    uint8_t count = 0;
    int16_t middle = 0;
    const uint8_t front_bit = add_wrap(first, uint8_t{1});
    uint8_t bit = front_bit;
    for (uint8_t wheel = first; wheel < hal::kWheelCount; wheel += kSideStep) {
        if (bit_and(inputs.tach_present, bit) != 0) {
            const uint16_t by = ahead_of_side(odometer, inputs, wheel);
            int16_t here = narrow_wrap_s16(by);
            if (abs_u16(here) > kTachStepMaxCount) {
                odometer.offset_count[wheel] = sub_wrap(odometer.offset_count[wheel], by);
                here = 0;
            } else if (here != narrow_wrap_s8(odometer.lead_count[wheel])) {
                moving = true;
            }
            ahead[wheel] = here;
            middle = add_wrap(middle, here);
            ++count;
        }
        bit = shift_left_wrap<kSideStep>(bit);
    }
    if (count == 0) return count;
    int16_t odd_pulse = 0;
    if (count == 3) middle = median3(ahead[first], ahead[first + 2], ahead[first + 4]);
    if (count == 2) {
        odd_pulse = bit_and(narrow_wrap_u8(middle), uint8_t{1});
        middle = halve_floor(middle);
    }
    pulses = middle;
    odometer.side_count[first] = sub_wrap(odometer.side_count[first], narrow_wrap_u16(middle));
    bit = front_bit;
    for (uint8_t wheel = first; wheel < hal::kWheelCount; wheel += kSideStep) {
        if (bit_and(inputs.tach_present, bit) != 0) {
            const int16_t rest = sub_wrap(ahead[wheel], middle);
            const int16_t lead = count == 2 ? odd_pulse
                                            : clamp(rest, static_cast<int16_t>(-kTachLeadMaxCount),
                                                    kTachLeadMaxCount);
            odd_pulse = 0;
            set_lead(odometer, wheel, rest, lead);
        }
        bit = shift_left_wrap<kSideStep>(bit);
    }
    return count;
}

[[gnu::noinline]] constexpr uint8_t median_byte(uint8_t a, uint8_t b, uint8_t c) {
    return median3(a, b, c);
}
constexpr bool is_small_lead(uint8_t lead) {
    return add_wrap(lead, uint8_t{kTachLeadMaxCount}) <= uint8_t{2 * kTachLeadMaxCount};
}

/// The usual case of a side: all wheels present, about 120 pulses at most, leads within the limit.
/// The same as side_in_general(), in bytes.
/// @return  false: it is not that, and nothing has been changed
template <uint8_t kFirst>
constexpr bool side_in_bytes(Odometer& odometer, const hal::RawInputs& inputs, bool& moving,
                             int16_t& pulses) {
    constexpr uint8_t kMiddle = kFirst + kSideStep;
    constexpr uint8_t kRear = kMiddle + kSideStep;
    constexpr uint8_t kAll = 0x15 << kFirst;
    if (bit_and(inputs.tach_present, kAll) != kAll) return false;
    constexpr uint8_t kZero = 128;  // makes a small number of either sign a byte
    const uint16_t from = add_wrap(odometer.side_count[kFirst], uint16_t{kZero});
    const uint16_t front =
        add_wrap(add_wrap(inputs.tach_count[kFirst], odometer.offset_count[kFirst]), from);
    if (shift_floor<8>(front) != 0) return false;
    const uint16_t middle =
        add_wrap(add_wrap(inputs.tach_count[kMiddle], odometer.offset_count[kMiddle]), from);
    if (shift_floor<8>(middle) != 0) return false;
    const uint16_t rear =
        add_wrap(add_wrap(inputs.tach_count[kRear], odometer.offset_count[kRear]), from);
    if (shift_floor<8>(rear) != 0) return false;
    const uint8_t side =
        median_byte(narrow_wrap_u8(front), narrow_wrap_u8(middle), narrow_wrap_u8(rear));
    const uint8_t front_lead = sub_wrap(narrow_wrap_u8(front), side);
    const uint8_t middle_lead = sub_wrap(narrow_wrap_u8(middle), side);
    const uint8_t rear_lead = sub_wrap(narrow_wrap_u8(rear), side);
    if (!is_small_lead(front_lead) || !is_small_lead(middle_lead) || !is_small_lead(rear_lead)) {
        return false;
    }
    if (side != kZero || front_lead != odometer.lead_count[kFirst] ||
        middle_lead != odometer.lead_count[kMiddle] || rear_lead != odometer.lead_count[kRear]) {
        moving = true;
    }
    odometer.lead_count[kFirst] = front_lead;
    odometer.lead_count[kMiddle] = middle_lead;
    odometer.lead_count[kRear] = rear_lead;
    const uint16_t by = sub_wrap(widen_u16(side), uint16_t{kZero});
    odometer.side_count[kFirst] = sub_wrap(odometer.side_count[kFirst], by);
    pulses = narrow_wrap_s16(by);
    return true;
}

/// Rim travel of a number of pulses, s32 Q20 mm. Exact.
/// @param pulses_q1  twice the mean of both sides, so that no half pulse is lost; at most
///                   4 kTachStepMaxCount either way
[[gnu::noinline]] constexpr int32_t travel_q20_mm(int16_t pulses_q1, uint16_t q16_mm_per_count) {
    const uint32_t size = mul_wide(shift_left_wrap<3>(abs_u16(pulses_q1)), q16_mm_per_count);
    return narrow_wrap_s32(pulses_q1 < 0 ? neg_wrap(size) : size);
}

/// Whole sixteenths of a millimetre of a travel; the rest is kept.
constexpr int16_t take_whole(int32_t travel_q20_mm, uint16_t& rest_q20_mm) {
    const uint32_t sum = add_wrap(narrow_wrap_u32(travel_q20_mm), widen_u32(rest_q20_mm));
    rest_q20_mm = narrow_wrap_u16(sum);
    return narrow_wrap_s16(narrow_wrap_u16(shift_floor<16>(sum)));
}

/// Pulses of both sides; one without tachometers follows the other.
/// @return  false: no wheel is present
constexpr bool side_pulses(Odometer& odometer, const hal::RawInputs& inputs, bool& moving,
                           int16_t& left, int16_t& right) {
    bool has_left = true;
    bool has_right = true;
    if (!side_in_bytes<0>(odometer, inputs, moving, left)) {
        has_left = side_in_general(odometer, inputs, 0, moving, left) != 0;
    }
    if (!side_in_bytes<1>(odometer, inputs, moving, right)) {
        has_right = side_in_general(odometer, inputs, 1, moving, right) != 0;
    }
    if (!has_left) left = right;
    if (!has_right) right = left;
    return has_left || has_right;
}

/// One control step. The first one with a wheel only remembers its counter.
[[gnu::noinline]] constexpr void odometer_step(Odometer& odometer, const hal::RawInputs& inputs,
                                               const hal::Calibration& calibration,
                                               OdometerStep& step) {
    step.travel_q4_mm = 0;
    step.moving = false;
    const uint8_t come = bit_and(inputs.tach_present, bit_xor(odometer.present, uint8_t{0xFF}));
    odometer.present = inputs.tach_present;
    if (come != 0) place_wheels(odometer, inputs, come);
    int16_t left = 0;
    int16_t right = 0;
    step.valid = side_pulses(odometer, inputs, step.moving, left, right);
    const uint16_t scale = calibration.tach_q16_mm_per_count;
    if (left != right) {
        const int16_t turn =
            take_whole(travel_q20_mm(sub_wrap(right, left), scale), odometer.turn_rest_q20_mm);
        odometer.turn_q4_mm = add_wrap(odometer.turn_q4_mm, turn);
    }
    const int16_t both = add_wrap(left, right);
    if (both == 0) return;
    step.travel_q4_mm = take_whole(travel_q20_mm(both, scale), odometer.rest_q20_mm);
    odometer.travel_q4_mm = add_wrap(odometer.travel_q4_mm, widen_s32(step.travel_q4_mm));
}
constexpr OdometerStep odometer_step(Odometer& odometer, const hal::RawInputs& inputs,
                                     const hal::Calibration& calibration) {
    OdometerStep step;
    odometer_step(odometer, inputs, calibration, step);
    return step;
}

/// Once a cycle: has a present wheel gone kTachDisagreeMm or more beyond or behind its side? Begins
/// the next cycle.
/// @cost  a product for a wheel that is off by 15 pulses; fewer are less than 15 mm at any scale
[[gnu::noinline]] constexpr bool tachometers_disagree(Odometer& odometer, uint8_t present,
                                                      const hal::Calibration& calibration) {
    bool disagree = false;
    for (uint8_t wheel = 0; wheel < hal::kWheelCount; ++wheel) {
        const int16_t lead = widen_s16(narrow_wrap_s8(odometer.lead_count[wheel]));
        const uint16_t off = abs_u16(add_wrap(odometer.drift_count[wheel], lead));
        odometer.drift_count[wheel] = neg_wrap(lead);
        if (off >= kTachDisagreeMm && bit_and(present, uint8_t{1}) != 0) {
            const uint32_t off_q16_mm = mul_wide(off, calibration.tach_q16_mm_per_count);
            if (narrow_wrap_u16(shift_floor<16>(off_q16_mm)) >= kTachDisagreeMm) disagree = true;
        }
        present = shift_floor<1>(present);
    }
    return disagree;
}

}  // namespace rover
