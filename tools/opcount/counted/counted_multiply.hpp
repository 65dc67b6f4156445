// counted_multiply.hpp - counting products, quotients and interpolation; part of rover_words.hpp.
// Depends on   counted_word.hpp.    Tests  tests/tools/opcount/counted_test.cpp
#pragma once

#include "counted_word.hpp"

namespace rover {

// -- Products; a saturation or a rounding after a product is part of it ---------------------------

template <class... A>
    requires AnyCounted<A...>
constexpr auto mul_wide(A... words) {
    return forward_counted<Operation::multiply>([](auto... w) { return mul_wide(w...); }, words...);
}
template <class... A>
    requires AnyCounted<A...>
constexpr auto mul_wrap(A... words) {
    return forward_counted<Operation::multiply>([](auto... w) { return mul_wrap(w...); }, words...);
}
template <class... A>
    requires AnyCounted<A...>
constexpr auto mul_sat(A... words) {
    return forward_counted<Operation::multiply>([](auto... w) { return mul_sat(w...); }, words...);
}
template <class... A>
    requires AnyCounted<A...>
constexpr auto mul_q15_sat(A... words) {
    return forward_counted<Operation::multiply>([](auto... w) { return mul_q15_sat(w...); },
                                                words...);
}

// -- Quotients ------------------------------------------------------------------------------------

template <class... A>
    requires AnyCounted<A...>
constexpr auto div_floor(A... words) {
    return forward_counted<Operation::divide>([](auto... w) { return div_floor(w...); }, words...);
}
template <class... A>
    requires AnyCounted<A...>
constexpr auto div_round_half_up(A... words) {
    return forward_counted<Operation::divide>([](auto... w) { return div_round_half_up(w...); },
                                              words...);
}
template <class... A>
    requires AnyCounted<A...>
constexpr auto div_floor_sat_u16(A... words) {
    return forward_counted<Operation::divide>([](auto... w) { return div_floor_sat_u16(w...); },
                                              words...);
}
template <class... A>
    requires AnyCounted<A...>
constexpr auto div_round_sat_u16(A... words) {
    return forward_counted<Operation::divide>([](auto... w) { return div_round_sat_u16(w...); },
                                              words...);
}
template <class... A>
    requires AnyCounted<A...>
constexpr auto div_floor_sat_s16(A... words) {
    return forward_counted<Operation::divide>([](auto... w) { return div_floor_sat_s16(w...); },
                                              words...);
}
template <class... A>
    requires AnyCounted<A...>
constexpr auto div_round_sat_s16(A... words) {
    return forward_counted<Operation::divide>([](auto... w) { return div_round_sat_s16(w...); },
                                              words...);
}

// -- Interpolation
// ----------------------------------------------------------------------------------

/// Difference, product, shift, sum.
template <uint8_t kShift, class... A>
    requires AnyCounted<A...>
constexpr auto lerp(A... words) {
    note(Operation::add_sub, 2);
    note(Operation::multiply);
    note(Operation::shift);
    return forward_bare([](auto... w) { return lerp<kShift>(w...); }, words...);
}
template <class... A>
    requires AnyCounted<A...>
constexpr auto lerp_q6(A... words) {
    return lerp<6>(words...);
}
template <class... A>
    requires AnyCounted<A...>
constexpr auto lerp_q8(A... words) {
    return lerp<8>(words...);
}

}  // namespace rover
