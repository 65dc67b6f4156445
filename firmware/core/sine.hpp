// sine.hpp - sine and cosine of binary angles.
// Depends on   units.hpp, tables/sine_table.hpp (generated); rover_words.hpp.
// Bounds       two table reads and one 16 x 8 bit multiplication; no loop.
// Angles       the difference of two angles is sub_wrap(a, b) of Brad16: exact, the short way
// round. Tests        tests/firmware/core/sine_test.cpp       Design note
// docs/design/fixed-point.md
#pragma once

#include "firmware/core/tables/sine_table.hpp"
#include "firmware/core/units.hpp"
#include "rover_words.hpp"

namespace rover {

/// Sine.
/// @param angle_brad  s16 brad, any
/// @return     s16 Q15, [-32767, 32767]; odd and symmetric about a quarter turn, bit for bit
/// @accuracy   at most 1 LSB from the real sine (Sine.ErrorIsAtMostOneLsbAtEveryAngle)
/// @rounding   half up in magnitude; +-1 saturates to +-32767
[[gnu::noinline]] constexpr S16 sine_q15(SameAs<S16> auto angle_brad) {
    U16 phase_brad = bit_and(narrow_wrap_u16(angle_brad), U16{0x7FFF});  // [0, 1/2) turn
    if (phase_brad > U16{0x4000}) phase_brad = sub_wrap(U16{0x8000}, phase_brad);
    const U16 index = shift_floor<6>(phase_brad);  // [0, 256]
    const U8 fraction_q8 = narrow_wrap_u8(shift_left_wrap<2>(phase_brad));
    // Entries use all 16 bits; their differences fit s16, which is all that lerp needs.
    const S16 low_q16 = narrow_wrap_s16(look_up(kSineQuarterQ16, index));
    const S16 high_q16 = narrow_wrap_s16(look_up(kSineQuarterQ16, add_wrap(index, U16{1})));
    const U16 sine_q16 = narrow_wrap_u16(lerp_q8(low_q16, high_q16, fraction_q8));
    const S16 magnitude_q15 = narrow_sat_s16(shift_round_half_up<1>(sine_q16));
    return angle_brad < S16{0} ? neg_wrap(magnitude_q15) : magnitude_q15;
}

/// Cosine: the sine a quarter turn on; same bounds.
constexpr S16 cosine_q15(SameAs<S16> auto angle_brad) {
    return sine_q15(add_wrap(angle_brad, S16{0x4000}));
}

/// The same between units.
constexpr Q15 sine(SameAs<Brad16> auto angle) {
    return to_unit<Q15>(sine_q15(S16{raw(angle)}));
}
constexpr Q15 cosine(SameAs<Brad16> auto angle) {
    return to_unit<Q15>(cosine_q15(S16{raw(angle)}));
}

}  // namespace rover
