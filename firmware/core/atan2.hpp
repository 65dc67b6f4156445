// atan2.hpp - direction of a vector as a binary angle.
// Depends on   units.hpp, tables/arctangent_table.hpp (generated); rover_words.hpp.
// Bounds       one 32 by 16 bit division, two table reads, one 16 x 8 bit multiplication; no loop.
// Tests        tests/firmware/core/atan2_test.cpp      Design note  docs/design/fixed-point.md
#pragma once

#include "firmware/core/tables/arctangent_table.hpp"
#include "firmware/core/units.hpp"
#include "rover_words.hpp"

namespace rover {

/// Arctangent of a ratio.
/// @param ratio_q15  u16 Q15, [0, 32768]; more reads as 32768
/// @return           u16 brad, [0, 8192]
constexpr U16 arctangent_brad(SameAs<U16> auto ratio_q15) {
    const U16 index = shift_floor<8>(ratio_q15);  // [0, 128]
    const U8 fraction_q8 = narrow_wrap_u8(ratio_q15);
    // Entries use all 16 bits; their differences fit s16, which is all that lerp needs.
    const S16 low_q2 = narrow_wrap_s16(look_up(kArctangentQ2Brad, index));
    const S16 high_q2 = narrow_wrap_s16(look_up(kArctangentQ2Brad, add_wrap(index, U16{1})));
    return shift_round_half_up<2>(narrow_wrap_u16(lerp_q8(low_q2, high_q2, fraction_q8)));
}

/// Angle of the vector (x, y) from the x axis towards the y axis.
/// @param y, x  s16, same unit and format, any
/// @return      s16 brad; 0 at (0, 0); -32768 on the negative x axis (half a turn either way)
/// @accuracy    at most 1 brad, 0.0055 deg (Atan2.ErrorIsAtMostOneBrad); exact on the axes and the
///              diagonals; mirrored arguments give mirrored angles, bit for bit
/// @rounding    to nearest in the first octant
constexpr S16 atan2_brad(SameAs<S16> auto y, SameAs<S16> auto x) {
    const U16 rise = abs_u16(y);
    const U16 run = abs_u16(x);
    const U16 longer = max(rise, run);
    const U16 shorter = min(rise, run);
    if (longer == U16{0}) return S16{0};
    const U32 dividend_q15 = shift_left_wrap<15>(widen_u32(shorter));  // <= 2^30
    U16 angle_brad = arctangent_brad(div_round_sat_u16(dividend_q15, longer));
    if (rise > run) angle_brad = sub_wrap(U16{0x4000}, angle_brad);
    if (x < S16{0}) angle_brad = sub_wrap(U16{0x8000}, angle_brad);
    if (y < S16{0}) angle_brad = neg_wrap(angle_brad);
    return narrow_wrap_s16(angle_brad);
}

/// The same as a unit.
constexpr Brad16 atan2(SameAs<S16> auto y, SameAs<S16> auto x) {
    return to_unit<Brad16>(atan2_brad(y, x));
}
constexpr Brad16 atan2(SameAs<Q4Mm> auto y, SameAs<Q4Mm> auto x) {
    return to_unit<Brad16>(atan2_brad(S16{raw(y)}, S16{raw(x)}));
}

}  // namespace rover
