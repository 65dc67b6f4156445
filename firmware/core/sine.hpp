// sine.hpp - sine and cosine of binary angles.
// Depends on   units.hpp, tables/sine_table.hpp (generated); rover_words.hpp.
// Bounds       two table reads and one 8 x 8 bit multiplication; no loop.
// Angles       the difference of two angles is sub_wrap(a, b) of Brad16: exact, the short way
//              round.
// Design note  docs/design/fixed-point.md     Tests  tests/firmware/core/sine_test.cpp
#pragma once

#include "firmware/core/tables/sine_table.hpp"
#include "firmware/core/units.hpp"
#include "rover_words.hpp"

namespace rover {

/// Sine.
/// @param angle_brad  s16 brad, any
/// @return     s16 Q14, [-16383, 16383]; odd and symmetric about a quarter turn, bit for bit
/// @accuracy   at most 1.1 LSB from the real sine (Sine.ErrorIsAtMostOneLsbAndATenthAtEveryAngle)
/// @rounding   half up in magnitude; +-1 saturates to +-16383
[[gnu::noinline]] constexpr S16 sine_q14(SameAs<S16> auto angle_brad) {
    // Half a turn on, the sine is the same with the other sign; in units of half a turn / 2^16.
    const U16 half_turn = shift_left_wrap<1>(narrow_wrap_u16(angle_brad));
    const U16 place = half_turn >= U16{0x8000} ? neg_wrap(half_turn) : half_turn;
    const U8 index = narrow_wrap_u8(shift_floor<8>(place));  // [0, 128]
    const U8 fraction_q8 = narrow_wrap_u8(place);
    const auto* const entry = kSineQuarterQ14 + index_of(index);
    const U16 low_q14 = entry[0];
    const U16 high_q14 = entry[1];
    // Neighbours differ by 201 at most.
    const U8 step_q14 = sub_wrap(narrow_wrap_u8(high_q14), narrow_wrap_u8(low_q14));
    const U16 rise_q22 = add_wrap(mul_wide(step_q14, fraction_q8), U16{0x80});
    const S16 magnitude_q14 = narrow_wrap_s16(add_wrap(low_q14, shift_floor<8>(rise_q22)));
    return angle_brad < S16{0} ? neg_wrap(magnitude_q14) : magnitude_q14;
}

/// Cosine: the sine a quarter turn on; same bounds.
constexpr S16 cosine_q14(SameAs<S16> auto angle_brad) {
    return sine_q14(add_wrap(angle_brad, S16{0x4000}));
}

/// The same between units.
constexpr Q15 sine(SameAs<Brad16> auto angle) {
    return to_unit<Q15>(shift_left_wrap<1>(sine_q14(S16{raw(angle)})));
}
constexpr Q15 cosine(SameAs<Brad16> auto angle) {
    return to_unit<Q15>(shift_left_wrap<1>(cosine_q14(S16{raw(angle)})));
}

}  // namespace rover
