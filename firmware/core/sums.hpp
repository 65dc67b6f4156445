// sums.hpp - words, conversions, sums, shifts, order and table access; part of arith.hpp, which
// see. Depends on   <stdint.h> only. Bounds       no loop, no state.    Tests
// tests/firmware/core/sums_test.cpp
#pragma once

#include <stdint.h>

namespace rover {

template <class A, class B>
inline constexpr bool kSameType = false;
template <class A>
inline constexpr bool kSameType<A, A> = true;

/// Exactly the type T; used so that a wrong argument type is an error and not a conversion.
template <class A, class T>
concept SameAs = kSameType<A, T>;

/// Words of 8 or 16 bits, and of 8, 16 or 32 bits.
template <class T>
concept UnsignedNarrowWord = SameAs<T, uint8_t> || SameAs<T, uint16_t>;
template <class T>
concept SignedNarrowWord = SameAs<T, int8_t> || SameAs<T, int16_t>;
template <class T>
concept NarrowWord = UnsignedNarrowWord<T> || SignedNarrowWord<T>;
template <class T>
concept UnsignedWord = UnsignedNarrowWord<T> || SameAs<T, uint32_t>;
template <class T>
concept SignedWord = SignedNarrowWord<T> || SameAs<T, int32_t>;
template <class T>
concept Word = UnsignedWord<T> || SignedWord<T>;

/// Width, range and unsigned partner of a word.
template <Word T>
struct WordTraits {
    static constexpr bool kSigned = SignedWord<T>;
    static constexpr uint8_t kWidth = sizeof(T) * 8u;
    static constexpr uint32_t kMagnitudeMax = 0xFFFF'FFFFu >> (32u - kWidth + (kSigned ? 1u : 0u));
    static constexpr T kMax = static_cast<T>(kMagnitudeMax);
    static constexpr T kMin = kSigned ? static_cast<T>(-kMax - 1) : T{0};
};
template <Word T>
inline constexpr T kMaxOf = WordTraits<T>::kMax;
template <Word T>
inline constexpr T kMinOf = WordTraits<T>::kMin;

// -- Conversions ---------------------------------------------------------------------------------

/// The low bits of `value` as a T: modulo 2^width, two's complement.
template <Word T>
constexpr T convert_wrap(Word auto value) {
    return static_cast<T>(value);
}

/// The T nearest to `value`.
template <Word T, Word From>
constexpr T convert_sat(From value) {
    if constexpr (SignedWord<From> && SignedWord<T> && sizeof(T) < sizeof(From)) {
        // It fits when nothing is above the range, moved up to begin at 0.
        constexpr uint32_t kHalf = uint32_t{1} << (WordTraits<T>::kWidth - 1);
        if (static_cast<uint32_t>(value) + kHalf < 2 * kHalf) return static_cast<T>(value);
        return value < 0 ? kMinOf<T> : kMaxOf<T>;
    } else if constexpr (SignedWord<From>) {
        if (value < 0) {
            if constexpr (UnsignedWord<T>) return T{0};
            return static_cast<T>(value);
        }
    }
    if (static_cast<uint32_t>(value) > WordTraits<T>::kMagnitudeMax) return kMaxOf<T>;
    return static_cast<T>(value);
}

// clang-format off
constexpr uint8_t  narrow_wrap_u8 (Word auto value) { return convert_wrap<uint8_t>(value); }
constexpr int8_t   narrow_wrap_s8 (Word auto value) { return convert_wrap<int8_t>(value); }
constexpr uint16_t narrow_wrap_u16(Word auto value) { return convert_wrap<uint16_t>(value); }
constexpr int16_t  narrow_wrap_s16(Word auto value) { return convert_wrap<int16_t>(value); }
constexpr uint32_t narrow_wrap_u32(Word auto value) { return convert_wrap<uint32_t>(value); }
constexpr int32_t  narrow_wrap_s32(Word auto value) { return convert_wrap<int32_t>(value); }

constexpr uint8_t  narrow_sat_u8 (Word auto value) { return convert_sat<uint8_t>(value); }
constexpr int8_t   narrow_sat_s8 (Word auto value) { return convert_sat<int8_t>(value); }
constexpr uint16_t narrow_sat_u16(Word auto value) { return convert_sat<uint16_t>(value); }
constexpr int16_t  narrow_sat_s16(Word auto value) { return convert_sat<int16_t>(value); }
constexpr uint32_t narrow_sat_u32(Word auto value) { return convert_sat<uint32_t>(value); }
constexpr int32_t  narrow_sat_s32(Word auto value) { return convert_sat<int32_t>(value); }
// clang-format on

/// True when every From is a To of the same value.
template <class From, class To>
concept Fits = Word<From> && Word<To> &&
               ((SignedWord<From> == SignedWord<To> && sizeof(From) <= sizeof(To)) ||
                (UnsignedWord<From> && SignedWord<To> && sizeof(From) < sizeof(To)));

// Exact, from any type whose range is contained.
constexpr uint16_t widen_u16(Fits<uint16_t> auto value) {
    return value;
}
constexpr int16_t widen_s16(Fits<int16_t> auto value) {
    return value;
}
constexpr uint32_t widen_u32(Fits<uint32_t> auto value) {
    return value;
}
constexpr int32_t widen_s32(Fits<int32_t> auto value) {
    return value;
}

// -- Sums ----------------------------------------------------------------------------------------

/// a + b modulo 2^width. Computed in u32, so that no width of `int` can overflow.
template <Word T>
constexpr T add_wrap(T a, T b) {
    return static_cast<T>(static_cast<uint32_t>(a) + static_cast<uint32_t>(b));
}
/// a - b modulo 2^width.
template <Word T>
constexpr T sub_wrap(T a, T b) {
    return static_cast<T>(static_cast<uint32_t>(a) - static_cast<uint32_t>(b));
}
/// -a modulo 2^width; the most negative value maps to itself.
template <Word T>
constexpr T neg_wrap(T a) {
    return sub_wrap(T{0}, a);
}

/// a + b clamped to the range of T.
template <Word T>
constexpr T add_sat(T a, T b) {
    T sum = 0;
    if (!__builtin_add_overflow(a, b, &sum)) return sum;
    return a < 0 ? kMinOf<T> : kMaxOf<T>;
}
/// a - b clamped to the range of T.
template <Word T>
constexpr T sub_sat(T a, T b) {
    T difference = 0;
    if (!__builtin_sub_overflow(a, b, &difference)) return difference;
    return UnsignedWord<T> || a < 0 ? kMinOf<T> : kMaxOf<T>;
}
/// -a; the most negative value maps to the largest.
template <SignedWord T>
constexpr T neg_sat(T a) {
    return a == kMinOf<T> ? kMaxOf<T> : neg_wrap(a);
}
/// |a|; the most negative value maps to the largest.
template <SignedWord T>
constexpr T abs_sat(T a) {
    return a < 0 ? neg_sat(a) : a;
}
/// |a|, exact for every a.
constexpr uint8_t abs_u8(SameAs<int8_t> auto a) {
    return convert_wrap<uint8_t>(a < 0 ? neg_wrap(a) : a);
}
constexpr uint16_t abs_u16(SameAs<int16_t> auto a) {
    return convert_wrap<uint16_t>(a < 0 ? neg_wrap(a) : a);
}
constexpr uint32_t abs_u32(SameAs<int32_t> auto a) {
    return convert_wrap<uint32_t>(a < 0 ? neg_wrap(a) : a);
}

// -- Shifts --------------------------------------------------------------------------------------

/// floor(value / 2^count). count >= width gives 0, or -1 for a negative value.
template <Word T>
constexpr T shift_floor(T value, uint8_t count) {
    if (count >= WordTraits<T>::kWidth) return value < 0 ? static_cast<T>(-1) : T{0};
    return static_cast<T>(value >> count);
}
/// floor(value / 2^count + 1/2), never overflows. count > width gives 0; count = width gives 0, or
/// 1 for an unsigned value of at least half its range.
template <Word T>
constexpr T shift_round_half_up(T value, uint8_t count) {
    if (count == 0) return value;
    if (count > WordTraits<T>::kWidth) return T{0};
    const T half = shift_floor(value, static_cast<uint8_t>(count - 1u));
    return static_cast<T>(shift_floor(value, count) + (half & 1));
}
/// value * 2^count modulo 2^width; count >= width gives 0.
template <Word T>
constexpr T shift_left_wrap(T value, uint8_t count) {
    if (count >= WordTraits<T>::kWidth) return T{0};
    return static_cast<T>(static_cast<uint32_t>(value) << count);
}
/// value * 2^count clamped to the range of T.
template <Word T>
constexpr T shift_left_sat(T value, uint8_t count) {
    const T shifted = shift_left_wrap(value, count);
    if (shift_floor(shifted, count) == value && count < WordTraits<T>::kWidth) return shifted;
    if (value == 0) return T{0};
    return value < 0 ? kMinOf<T> : kMaxOf<T>;
}
/// The same with a count known at compile time: shift_floor<4>(height).
template <uint8_t kCount>
constexpr auto shift_floor(Word auto value) {
    return shift_floor(value, kCount);
}
template <uint8_t kCount>
constexpr auto shift_round_half_up(Word auto value) {
    return shift_round_half_up(value, kCount);
}
template <uint8_t kCount>
constexpr auto shift_left_wrap(Word auto value) {
    return shift_left_wrap(value, kCount);
}
template <uint8_t kCount>
constexpr auto shift_left_sat(Word auto value) {
    return shift_left_sat(value, kCount);
}
/// floor(value / 2).
template <Word T>
constexpr T halve_floor(T value) {
    return shift_floor(value, 1);
}
/// floor((a + b) / 2), cannot overflow.
template <Word T>
constexpr T average(T a, T b) {
    return static_cast<T>((a & b) + shift_floor(static_cast<T>(a ^ b), 1));
}

// -- Order and bits ------------------------------------------------------------------------------

template <Word T>
constexpr T min(T a, T b) {
    return b < a ? b : a;
}
template <Word T>
constexpr T max(T a, T b) {
    return a < b ? b : a;
}
/// `value` limited to [low, high]; `low` wins when low > high.
template <Word T>
constexpr T clamp(T value, T low, T high) {
    return max(low, min(value, high));
}
template <UnsignedWord T>
constexpr T bit_and(T a, T b) {
    return static_cast<T>(a & b);
}
template <UnsignedWord T>
constexpr T bit_or(T a, T b) {
    return static_cast<T>(a | b);
}
template <UnsignedWord T>
constexpr T bit_xor(T a, T b) {
    return static_cast<T>(a ^ b);
}

// -- Table access --------------------------------------------------------------------------------

/// The machine integer behind `value`; itself here, unwrapped where operations are counted. For the
/// boundary of a kernel, where results go into plain structs.
template <Word T>
constexpr T native(T value) {
    return value;
}
/// The subscript that `index` stands for: table[index_of(i)]. The range is the caller's business.
template <UnsignedNarrowWord T>
constexpr T index_of(T index) {
    return index;
}
/// table[index]; an index beyond the end reads the last entry.
template <Word T, uint16_t kSize, UnsignedNarrowWord I>
constexpr T look_up(const T (&table)[kSize], I index) {
    return table[index < kSize ? index : kSize - 1u];
}

}  // namespace rover
