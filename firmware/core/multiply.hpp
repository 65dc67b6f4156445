// multiply.hpp - products, quotients and interpolation; part of arith.hpp, which see.
// Depends on   sums.hpp.
// Bounds       no loop, no state.    Tests  tests/firmware/core/multiply_test.cpp
#pragma once

#include "firmware/core/sums.hpp"

namespace rover {

// -- Products ------------------------------------------------------------------------------------

/// Type of an exact product: 8 x 8 -> 16 bits, otherwise 32; signed if either operand is.
template <bool kSigned, bool kWide>
struct ProductType {
    using Type = uint16_t;
};
template <>
struct ProductType<true, false> {
    using Type = int16_t;
};
template <>
struct ProductType<false, true> {
    using Type = uint32_t;
};
template <>
struct ProductType<true, true> {
    using Type = int32_t;
};
template <NarrowWord A, NarrowWord B>
using Product =
    typename ProductType<SignedWord<A> || SignedWord<B>, (sizeof(A) > 1 || sizeof(B) > 1)>::Type;

/// Exact product of two 8 or 16 bit words of any sign; see Product for the type.
template <NarrowWord A, NarrowWord B>
constexpr Product<A, B> mul_wide(A a, B b) {
    return static_cast<Product<A, B>>(static_cast<Product<A, B>>(a) *
                                      static_cast<Product<A, B>>(b));
}
/// a * b modulo 2^width.
template <Word T>
constexpr T mul_wrap(T a, T b) {
    return static_cast<T>(static_cast<uint32_t>(a) * static_cast<uint32_t>(b));
}
/// a * b clamped to the range of the 8 or 16 bit type.
template <NarrowWord T>
constexpr T mul_sat(T a, T b) {
    return convert_sat<T>(mul_wide(a, b));
}
/// Product of two s16 Q15 rounded half up to s16 Q15; -1 x -1 gives 32767.
constexpr int16_t mul_q15_sat(SameAs<int16_t> auto a_q15, SameAs<int16_t> auto b_q15) {
    return narrow_sat_s16(shift_round_half_up<15>(mul_wide(a_q15, b_q15)));  // s32 Q30 -> Q15
}

// -- Quotients -----------------------------------------------------------------------------------
// Division by zero saturates by the sign of the dividend, 0 / 0 = 0. The one overflow, most
// negative by -1, saturates too.

/// floor(a / b).
template <Word T>
constexpr T div_floor(T a, T b) {
    if (b == 0) return a == 0 ? T{0} : a < 0 ? kMinOf<T> : kMaxOf<T>;
    if constexpr (SignedWord<T>) {
        if (b == -1) return neg_sat(a);
    }
    const T quotient = static_cast<T>(a / b);
    if constexpr (SignedWord<T>) {
        const T remainder = static_cast<T>(a % b);
        if (remainder != 0 && (remainder < 0) != (b < 0)) return static_cast<T>(quotient - 1);
    }
    return quotient;
}
/// floor(a / b + 1/2).
template <Word T>
constexpr T div_round_half_up(T a, T b) {
    const T quotient = div_floor(a, b);
    if (b == 0 || quotient == kMaxOf<T>) return quotient;
    const T remainder = sub_wrap(a, mul_wrap(quotient, b));  // sign of b, smaller than b
    const T rest = sub_wrap(b, remainder);
    const bool round_up = b < 0 ? remainder <= rest : remainder >= rest;
    return round_up ? static_cast<T>(quotient + 1) : quotient;
}
/// a / b with a wide dividend and a narrow result, clamped to u16 or s16.
constexpr uint16_t div_floor_sat_u16(SameAs<uint32_t> auto a, SameAs<uint16_t> auto b) {
    return narrow_sat_u16(div_floor(a, widen_u32(b)));
}
constexpr uint16_t div_round_sat_u16(SameAs<uint32_t> auto a, SameAs<uint16_t> auto b) {
    return narrow_sat_u16(div_round_half_up(a, widen_u32(b)));
}
constexpr int16_t div_floor_sat_s16(SameAs<int32_t> auto a, SameAs<int16_t> auto b) {
    return narrow_sat_s16(div_floor(a, widen_s32(b)));
}
constexpr int16_t div_round_sat_s16(SameAs<int32_t> auto a, SameAs<int16_t> auto b) {
    return narrow_sat_s16(div_round_half_up(a, widen_s32(b)));
}

// -- Interpolation -------------------------------------------------------------------------------

/// a + (b - a) * fraction / 2^kShift, the difference and the sum modulo 2^16, the correction
/// rounded half up. A fraction beyond 2^kShift extrapolates.
template <uint8_t kShift>
constexpr int16_t lerp(SameAs<int16_t> auto a, SameAs<int16_t> auto b,
                       SameAs<uint8_t> auto fraction) {
    constexpr int32_t kHalf = int32_t{1} << (kShift - 1);
    const int32_t scaled = add_wrap(mul_wide(sub_wrap(b, a), fraction), kHalf);  // 24 bits
    return add_wrap(a, narrow_wrap_s16(shift_floor<kShift>(scaled)));
}
/// Fraction in 1/64.
constexpr int16_t lerp_q6(SameAs<int16_t> auto a, SameAs<int16_t> auto b,
                          SameAs<uint8_t> auto fraction_q6) {
    return lerp<6>(a, b, fraction_q6);
}
/// Fraction in 1/256.
constexpr int16_t lerp_q8(SameAs<int16_t> auto a, SameAs<int16_t> auto b,
                          SameAs<uint8_t> auto fraction_q8) {
    return lerp<8>(a, b, fraction_q8);
}

}  // namespace rover
