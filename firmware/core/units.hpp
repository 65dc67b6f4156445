// units.hpp - strong integer types for every physical quantity that crosses a module boundary.
//
// Each type is a scoped enum over a fixed-width integer: distinct at compile time, yet passed and
// returned as the bare integer by every calling convention (a one-member struct is not).
//
// | type     | quantity       | format  | one LSB    | range               | at the edge    |
// |----------|----------------|---------|------------|---------------------|----------------|
// | Brad16   | angle          | s16     | 2^-16 turn | [-1/2, +1/2) turn   | wraps          |
// | Q15      | ratio, sine    | s16 Q15 | 2^-15      | [-1, +1)            | saturates      |
// | Q4Mm     | height, length | s16 Q4  | 1/16 mm    | [-2048, +2048) mm   | wrap or sat    |
// | Q4MmWide | place on track | s32 Q4  | 1/16 mm    | +-134 km            | wrap or sat    |
// Tests  tests/firmware/core/units_test.cpp, must_not_compile.cpp
#pragma once

#include "firmware/core/arith.hpp"

namespace rover {

enum class Brad16 : int16_t {};
enum class Q15 : int16_t {};
enum class Q4Mm : int16_t {};
enum class Q4MmWide : int32_t {};

/// The integer under a unit.
constexpr int16_t raw(Brad16 angle) {
    return static_cast<int16_t>(angle);
}
constexpr int16_t raw(Q15 ratio) {
    return static_cast<int16_t>(ratio);
}
constexpr int16_t raw(Q4Mm length) {
    return static_cast<int16_t>(length);
}
constexpr int32_t raw(Q4MmWide length) {
    return static_cast<int32_t>(length);
}

template <class U>
concept NarrowUnit = SameAs<U, Brad16> || SameAs<U, Q15> || SameAs<U, Q4Mm>;
template <class U>
concept WideUnit = SameAs<U, Q4MmWide>;
template <class U>
concept Unit = NarrowUnit<U> || WideUnit<U>;
/// Units that are closed under sums modulo their range. A ratio is not: it saturates.
template <class U>
concept WrappingUnit = SameAs<U, Brad16> || SameAs<U, Q4Mm> || SameAs<U, Q4MmWide>;

/// The unit whose integer is `value`: to_unit<Q4Mm>(height_q4_mm).
template <NarrowUnit U>
constexpr U to_unit(SameAs<int16_t> auto value) {
    return static_cast<U>(value);
}
template <WideUnit U>
constexpr U to_unit(SameAs<int32_t> auto value) {
    return static_cast<U>(value);
}

/// Sum, difference and negation modulo the range. Exact for angles; exact for lengths as long as
/// the true result is in range.
template <WrappingUnit U>
constexpr U add_wrap(U a, U b) {
    return static_cast<U>(add_wrap(raw(a), raw(b)));
}
template <WrappingUnit U>
constexpr U sub_wrap(U a, U b) {
    return static_cast<U>(sub_wrap(raw(a), raw(b)));
}
template <WrappingUnit U>
constexpr U neg_wrap(U a) {
    return static_cast<U>(neg_wrap(raw(a)));
}

/// Sum and difference clamped to the range: lengths and ratios, not angles.
template <Unit U>
    requires(!SameAs<U, Brad16>)
constexpr U add_sat(U a, U b) {
    return static_cast<U>(add_sat(raw(a), raw(b)));
}
template <Unit U>
    requires(!SameAs<U, Brad16>)
constexpr U sub_sat(U a, U b) {
    return static_cast<U>(sub_sat(raw(a), raw(b)));
}

/// Product of two ratios rounded half up; -1 x -1 gives the largest ratio.
constexpr Q15 mul_q15_sat(SameAs<Q15> auto a, SameAs<Q15> auto b) {
    return static_cast<Q15>(mul_q15_sat(raw(a), raw(b)));
}

/// `length` times `ratio`, rounded half up to 1/16 mm. -2048 mm x -1 gives the largest length.
constexpr Q4Mm scale(SameAs<Q4Mm> auto length, SameAs<Q15> auto ratio) {
    return static_cast<Q4Mm>(mul_q15_sat(raw(length), raw(ratio)));
}

/// A length on the track; exact.
constexpr Q4MmWide widen(SameAs<Q4Mm> auto length) {
    return static_cast<Q4MmWide>(widen_s32(raw(length)));
}
/// The nearest short length.
constexpr Q4Mm narrow_sat(SameAs<Q4MmWide> auto length) {
    return static_cast<Q4Mm>(narrow_sat_s16(raw(length)));
}

static_assert(add_wrap(Brad16{0x4000}, Brad16{0x4000}) == Brad16{-32768}, "90 + 90 deg = -180 deg");

}  // namespace rover
