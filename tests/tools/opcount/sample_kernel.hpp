// sample_kernel.hpp - a kernel in the style of firmware/estimation that touches every helper once
// or more; compiled with plain integers (sample_plain.cpp) and with counting ones
// (counted_test.cpp).
#pragma once

#include <initializer_list>

#include "firmware/core/atan2.hpp"
#include "firmware/core/isqrt.hpp"
#include "firmware/core/ring.hpp"
#include "firmware/core/sine.hpp"
#include "rover_words.hpp"

namespace rover::sample {

inline constexpr uint16_t kSquares[8] = {0, 1, 4, 9, 16, 25, 36, 49};

/// Folds the results of every helper into one word.
template <class W16>
constexpr U32 fold(U32 sum, W16 value) {
    return add_wrap(mul_wrap(sum, U32{31}), narrow_wrap_u32(value));
}

constexpr U32 arithmetic(S16 a, S16 b, U8 fraction) {
    U32 sum{0};
    for (const S16 value : {add_wrap(a, b),
                            sub_wrap(a, b),
                            neg_wrap(a),
                            add_sat(a, b),
                            sub_sat(a, b),
                            neg_sat(a),
                            abs_sat(a),
                            average(a, b),
                            min(a, b),
                            max(a, b),
                            clamp(a, S16{-50}, S16{50}),
                            shift_floor<3>(a),
                            shift_round_half_up<3>(a),
                            shift_left_wrap<3>(a),
                            shift_left_sat<3>(a),
                            shift_floor(a, fraction),
                            shift_round_half_up(a, 2),
                            halve_floor(a),
                            mul_q15_sat(a, b),
                            mul_sat(a, b),
                            div_floor(a, b),
                            div_round_half_up(a, b),
                            lerp_q6(a, b, fraction),
                            lerp_q8(a, b, fraction),
                            narrow_sat_s16(mul_wide(a, b)),
                            div_round_sat_s16(mul_wide(a, b), b),
                            div_floor_sat_s16(mul_wide(a, b), b)}) {
        sum = fold(sum, value);
    }
    return sum;
}

constexpr U32 unsigned_arithmetic(U16 a, U16 b) {
    U32 sum{0};
    for (const U16 value :
         {bit_and(a, b), bit_or(a, b), bit_xor(a, b), add_sat(a, b), sub_sat(a, b),
          narrow_sat_u16(mul_wide(a, b)), div_floor_sat_u16(mul_wide(a, b), b),
          div_round_sat_u16(mul_wide(a, b), b), look_up(kSquares, a),
          widen_u16(narrow_sat_u8(a))}) {
        sum = fold(sum, value);
    }
    return sum;
}

constexpr U32 functions(S16 a, S16 b) {
    Ring<S16, 4> ring;
    ring.push(a);
    ring.push(b);
    U32 sum = fold(U32{0}, ring.at(U8{3}));
    sum = fold(sum, sine_q14(a));
    sum = fold(sum, cosine_q14(b));
    sum = fold(sum, atan2_brad(a, b));
    sum = fold(sum, isqrt(narrow_wrap_u16(a)));
    sum = fold(sum, isqrt(widen_u32(narrow_wrap_u16(b))));
    if (a < b || a == S16{7}) sum = fold(sum, S16{raw(to_unit<Brad16>(a))});
    return sum;
}

// Its signature is the same in both builds, so it must not be shared between them.
static constexpr uint32_t everything(int16_t a, int16_t b) {
    const U32 first = arithmetic(S16{a}, S16{b}, narrow_wrap_u8(S16{b}));
    const U32 second = unsigned_arithmetic(narrow_wrap_u16(S16{a}), narrow_wrap_u16(S16{b}));
    const U32 third = functions(S16{a}, S16{b});
    return native(fold(fold(first, second), third));
}

}  // namespace rover::sample
