// rover_words.hpp - the integer types of the estimation kernels, with every operation counted.
// A host build that puts this folder before firmware/config/native on the include path compiles the
// same kernels; results are the same bits, and operation_tally() says what they took.
// Counted      one elementary operation per named helper of firmware/core/arith.hpp and per
//              comparison: what the helper stands for (mul_wide is one multiplication, however many
//              instructions the machine needs). average, clamp and lerp are sums of such.
// Not counted  loop counters and branches on plain integers, copies, wrapping and widening.
// One program  holds either plain or counting kernels: functions without words in their signature
//              would have two definitions.
// Tests        tests/tools/opcount/counted_test.cpp
#pragma once

#include "counted_multiply.hpp"
#include "counted_word.hpp"

namespace rover {

// -- Sums -----------------------------------------------------------------------------------------

template <class... A>
    requires AnyCounted<A...>
constexpr auto add_wrap(A... words) {
    return forward_counted<Operation::add_sub>([](auto... w) { return add_wrap(w...); }, words...);
}
template <class... A>
    requires AnyCounted<A...>
constexpr auto sub_wrap(A... words) {
    return forward_counted<Operation::add_sub>([](auto... w) { return sub_wrap(w...); }, words...);
}
template <class... A>
    requires AnyCounted<A...>
constexpr auto neg_wrap(A... words) {
    return forward_counted<Operation::add_sub>([](auto... w) { return neg_wrap(w...); }, words...);
}
template <class... A>
    requires AnyCounted<A...>
constexpr auto add_sat(A... words) {
    return forward_counted<Operation::add_sub>([](auto... w) { return add_sat(w...); }, words...);
}
template <class... A>
    requires AnyCounted<A...>
constexpr auto sub_sat(A... words) {
    return forward_counted<Operation::add_sub>([](auto... w) { return sub_sat(w...); }, words...);
}
template <class... A>
    requires AnyCounted<A...>
constexpr auto neg_sat(A... words) {
    return forward_counted<Operation::add_sub>([](auto... w) { return neg_sat(w...); }, words...);
}
template <class... A>
    requires AnyCounted<A...>
constexpr auto abs_sat(A... words) {
    return forward_counted<Operation::add_sub>([](auto... w) { return abs_sat(w...); }, words...);
}
template <class... A>
    requires AnyCounted<A...>
constexpr auto abs_u8(A... words) {
    return forward_counted<Operation::add_sub>([](auto... w) { return abs_u8(w...); }, words...);
}
template <class... A>
    requires AnyCounted<A...>
constexpr auto abs_u16(A... words) {
    return forward_counted<Operation::add_sub>([](auto... w) { return abs_u16(w...); }, words...);
}
template <class... A>
    requires AnyCounted<A...>
constexpr auto abs_u32(A... words) {
    return forward_counted<Operation::add_sub>([](auto... w) { return abs_u32(w...); }, words...);
}

template <class... A>
    requires AnyCounted<A...>
constexpr auto average(A... words) {
    note(Operation::add_sub);
    note(Operation::shift);
    return forward_bare([](auto... w) { return average(w...); }, words...);
}

// -- Shifts: a count may be a constant, a U8 or a uint8_t -----------------------------------------

template <class T>
constexpr Counted<T> shift_floor(Counted<T> value, U8 count) {
    note(Operation::shift);
    return shift_floor(value.value, count.value);
}
template <uint8_t kCount, class T>
constexpr Counted<T> shift_floor(Counted<T> value) {
    return shift_floor(value, U8{kCount});
}
template <class T>
constexpr Counted<T> shift_round_half_up(Counted<T> value, U8 count) {
    note(Operation::shift);
    return shift_round_half_up(value.value, count.value);
}
template <uint8_t kCount, class T>
constexpr Counted<T> shift_round_half_up(Counted<T> value) {
    return shift_round_half_up(value, U8{kCount});
}
template <class T>
constexpr Counted<T> shift_left_wrap(Counted<T> value, U8 count) {
    note(Operation::shift);
    return shift_left_wrap(value.value, count.value);
}
template <uint8_t kCount, class T>
constexpr Counted<T> shift_left_wrap(Counted<T> value) {
    return shift_left_wrap(value, U8{kCount});
}
template <class T>
constexpr Counted<T> shift_left_sat(Counted<T> value, U8 count) {
    note(Operation::shift);
    return shift_left_sat(value.value, count.value);
}
template <uint8_t kCount, class T>
constexpr Counted<T> shift_left_sat(Counted<T> value) {
    return shift_left_sat(value, U8{kCount});
}
template <class T>
constexpr Counted<T> halve_floor(Counted<T> value) {
    return shift_floor(value, U8{1});
}

// -- Order: a saturation is one comparison ------------------------------------------

template <class... A>
    requires AnyCounted<A...>
constexpr auto min(A... words) {
    return forward_counted<Operation::compare>([](auto... w) { return min(w...); }, words...);
}
template <class... A>
    requires AnyCounted<A...>
constexpr auto max(A... words) {
    return forward_counted<Operation::compare>([](auto... w) { return max(w...); }, words...);
}
template <class... A>
    requires AnyCounted<A...>
constexpr auto narrow_sat_u8(A... words) {
    return forward_counted<Operation::compare>([](auto... w) { return narrow_sat_u8(w...); },
                                               words...);
}
template <class... A>
    requires AnyCounted<A...>
constexpr auto narrow_sat_s8(A... words) {
    return forward_counted<Operation::compare>([](auto... w) { return narrow_sat_s8(w...); },
                                               words...);
}
template <class... A>
    requires AnyCounted<A...>
constexpr auto narrow_sat_u16(A... words) {
    return forward_counted<Operation::compare>([](auto... w) { return narrow_sat_u16(w...); },
                                               words...);
}
template <class... A>
    requires AnyCounted<A...>
constexpr auto narrow_sat_s16(A... words) {
    return forward_counted<Operation::compare>([](auto... w) { return narrow_sat_s16(w...); },
                                               words...);
}
template <class... A>
    requires AnyCounted<A...>
constexpr auto narrow_sat_u32(A... words) {
    return forward_counted<Operation::compare>([](auto... w) { return narrow_sat_u32(w...); },
                                               words...);
}
template <class... A>
    requires AnyCounted<A...>
constexpr auto narrow_sat_s32(A... words) {
    return forward_counted<Operation::compare>([](auto... w) { return narrow_sat_s32(w...); },
                                               words...);
}

template <class T>
constexpr Counted<T> clamp(Counted<T> value, Counted<T> low, Counted<T> high) {
    return max(low, min(value, high));
}

// -- Bits -----------------------------------------------------------------------------------------

template <class... A>
    requires AnyCounted<A...>
constexpr auto bit_and(A... words) {
    return forward_counted<Operation::logic>([](auto... w) { return bit_and(w...); }, words...);
}
template <class... A>
    requires AnyCounted<A...>
constexpr auto bit_or(A... words) {
    return forward_counted<Operation::logic>([](auto... w) { return bit_or(w...); }, words...);
}
template <class... A>
    requires AnyCounted<A...>
constexpr auto bit_xor(A... words) {
    return forward_counted<Operation::logic>([](auto... w) { return bit_xor(w...); }, words...);
}

// -- Conversions that cost nothing ----------------------------------------------------------------

template <class... A>
    requires AnyCounted<A...>
constexpr auto narrow_wrap_u8(A... words) {
    return forward_bare([](auto... w) { return narrow_wrap_u8(w...); }, words...);
}
template <class... A>
    requires AnyCounted<A...>
constexpr auto narrow_wrap_s8(A... words) {
    return forward_bare([](auto... w) { return narrow_wrap_s8(w...); }, words...);
}
template <class... A>
    requires AnyCounted<A...>
constexpr auto narrow_wrap_u16(A... words) {
    return forward_bare([](auto... w) { return narrow_wrap_u16(w...); }, words...);
}
template <class... A>
    requires AnyCounted<A...>
constexpr auto narrow_wrap_s16(A... words) {
    return forward_bare([](auto... w) { return narrow_wrap_s16(w...); }, words...);
}
template <class... A>
    requires AnyCounted<A...>
constexpr auto narrow_wrap_u32(A... words) {
    return forward_bare([](auto... w) { return narrow_wrap_u32(w...); }, words...);
}
template <class... A>
    requires AnyCounted<A...>
constexpr auto narrow_wrap_s32(A... words) {
    return forward_bare([](auto... w) { return narrow_wrap_s32(w...); }, words...);
}
template <class... A>
    requires AnyCounted<A...>
constexpr auto widen_u16(A... words) {
    return forward_bare([](auto... w) { return widen_u16(w...); }, words...);
}
template <class... A>
    requires AnyCounted<A...>
constexpr auto widen_s16(A... words) {
    return forward_bare([](auto... w) { return widen_s16(w...); }, words...);
}
template <class... A>
    requires AnyCounted<A...>
constexpr auto widen_u32(A... words) {
    return forward_bare([](auto... w) { return widen_u32(w...); }, words...);
}
template <class... A>
    requires AnyCounted<A...>
constexpr auto widen_s32(A... words) {
    return forward_bare([](auto... w) { return widen_s32(w...); }, words...);
}

// -- Memory and boundaries -----------------------------------------------------------------------

template <class T>
constexpr T native(Counted<T> value) {
    return value.value;
}
template <class T>
constexpr T index_of(Counted<T> index) {
    note(Operation::table_lookup);
    return index.value;
}
template <class T, uint16_t kSize, class I>
    requires AnyCounted<T, I>
constexpr auto look_up(const T (&table)[kSize], I index) {
    note(Operation::table_lookup);
    const auto position = bare(index);
    return Counted{bare(table[position < kSize ? position : kSize - 1u])};
}
template <Unit U, class T>
constexpr U to_unit(Counted<T> value) {
    return to_unit<U>(value.value);
}

}  // namespace rover
