// probe_core.cpp - runs the helpers of firmware/core over the probe inputs, group by group.
#include "firmware/core/atan2.hpp"
#include "firmware/core/isqrt.hpp"
#include "firmware/core/ring.hpp"
#include "firmware/core/sine.hpp"
#include "probe.hpp"

namespace probe {
namespace {

using namespace rover;

constexpr uint16_t kRounds = 500;

template <class T>
void check_sums(Inputs& inputs, Checksum& sum) {
    const T a = inputs.next<T>();
    const T b = inputs.next<T>();
    const T c = inputs.next<T>();
    sum.add(add_wrap(a, b));
    sum.add(sub_wrap(a, b));
    sum.add(neg_wrap(a));
    sum.add(add_sat(a, b));
    sum.add(sub_sat(a, b));
    sum.add(average(a, b));
    sum.add(rover::min(a, b));
    sum.add(rover::max(a, b));
    sum.add(clamp(a, b, c));
    if constexpr (SignedWord<T>) {
        sum.add(neg_sat(a));
        sum.add(abs_sat(a));
    } else {
        sum.add(bit_and(a, b));
        sum.add(bit_or(a, b));
        sum.add(bit_xor(a, b));
    }
}

template <class T>
void check_shifts(Inputs& inputs, Checksum& sum) {
    const T a = inputs.next<T>();
    const auto count = bit_and(inputs.next<uint8_t>(), uint8_t{63});
    sum.add(shift_floor(a, count));
    sum.add(shift_round_half_up(a, count));
    sum.add(shift_left_wrap(a, count));
    sum.add(shift_left_sat(a, count));
    sum.add(shift_floor<5>(a));
    sum.add(shift_round_half_up<5>(a));
    sum.add(shift_left_wrap<5>(a));
    sum.add(shift_left_sat<5>(a));
    sum.add(halve_floor(a));
}

template <class T>
void check_conversions(Inputs& inputs, Checksum& sum) {
    const T a = inputs.next<T>();
    sum.add(narrow_wrap_u8(a));
    sum.add(narrow_wrap_s8(a));
    sum.add(narrow_wrap_u16(a));
    sum.add(narrow_wrap_s16(a));
    sum.add(narrow_wrap_u32(a));
    sum.add(narrow_wrap_s32(a));
    sum.add(narrow_sat_u8(a));
    sum.add(narrow_sat_s8(a));
    sum.add(narrow_sat_u16(a));
    sum.add(narrow_sat_s16(a));
    sum.add(narrow_sat_u32(a));
    sum.add(narrow_sat_s32(a));
    if constexpr (Fits<T, uint16_t>) sum.add(widen_u16(a));
    if constexpr (Fits<T, int16_t>) sum.add(widen_s16(a));
    if constexpr (Fits<T, uint32_t>) sum.add(widen_u32(a));
    if constexpr (Fits<T, int32_t>) sum.add(widen_s32(a));
}

template <class T>
void check_products(Inputs& inputs, Checksum& sum) {
    const T a = inputs.next<T>();
    const T b = inputs.next<T>();
    sum.add(mul_wrap(a, b));
    if constexpr (NarrowWord<T>) {
        sum.add(mul_sat(a, b));
        sum.add(mul_wide(a, inputs.next<uint8_t>()));
        sum.add(mul_wide(a, inputs.next<int8_t>()));
        sum.add(mul_wide(a, inputs.next<uint16_t>()));
        sum.add(mul_wide(a, inputs.next<int16_t>()));
    }
    if constexpr (SameAs<T, int16_t>) sum.add(mul_q15_sat(a, b));
}

template <class T>
void check_quotients(Inputs& inputs, Checksum& sum) {
    const T a = inputs.next<T>();
    const T b = inputs.next<T>();
    sum.add(div_floor(a, b));
    sum.add(div_round_half_up(a, b));
    sum.add(div_floor(a, T{0}));
    if constexpr (SignedWord<T>) sum.add(div_round_half_up(a, T{-1}));
}

void check_narrow_quotients(Inputs& inputs, Checksum& sum) {
    const auto a = inputs.next<uint32_t>();
    const auto b = inputs.next<uint16_t>();
    sum.add(div_floor_sat_u16(a, b));
    sum.add(div_round_sat_u16(a, b));
    sum.add(div_floor_sat_s16(narrow_wrap_s32(a), narrow_wrap_s16(b)));
    sum.add(div_round_sat_s16(narrow_wrap_s32(a), narrow_wrap_s16(b)));
}

void check_lerp(Inputs& inputs, Checksum& sum) {
    const auto a = inputs.next<int16_t>();
    const auto b = inputs.next<int16_t>();
    const auto fraction = inputs.next<uint8_t>();
    sum.add(lerp_q6(a, b, fraction));
    sum.add(lerp_q8(a, b, fraction));
}

void check_units(Inputs& inputs, Checksum& sum) {
    const auto a = inputs.next<int16_t>();
    const auto b = inputs.next<int16_t>();
    sum.add(raw(add_wrap(Brad16{a}, Brad16{b})));
    sum.add(raw(sub_wrap(Brad16{a}, Brad16{b})));
    sum.add(raw(add_sat(Q4Mm{a}, Q4Mm{b})));
    sum.add(raw(scale(Q4Mm{a}, Q15{b})));
    sum.add(raw(widen(Q4Mm{a})));
    sum.add(raw(narrow_sat(Q4MmWide{inputs.next<int32_t>()})));
}

void check_roots(Inputs& inputs, Checksum& sum) {
    sum.add(isqrt(inputs.next<uint16_t>()));
    sum.add(isqrt(inputs.next<uint32_t>()));
}

void check_angles(Inputs& inputs, Checksum& sum) {
    const auto a = inputs.next<int16_t>();
    const auto b = inputs.next<int16_t>();
    sum.add(sine_q14(a));
    sum.add(cosine_q14(a));
    sum.add(atan2_brad(a, b));
}

void check_ring(Inputs& inputs, Checksum& sum) {
    Ring<int16_t, 8> ring;
    for (uint8_t i = 0; i < 12; ++i) ring.push(inputs.next<int16_t>());
    ring.advance(inputs.next<uint8_t>());
    sum.add(ring.at(inputs.next<uint8_t>()));
    sum.add(ring.origin);
}

/// A group for every word type.
template <class T>
void run_for(const char* const (&names)[5]) {
    run(names[0], kRounds, check_sums<T>);
    run(names[1], kRounds, check_shifts<T>);
    run(names[2], kRounds, check_conversions<T>);
    run(names[3], kRounds, check_products<T>);
    run(names[4], kRounds, check_quotients<T>);
}

}  // namespace

void run_core_groups() {
    run_for<uint8_t>({"sums_u8", "shifts_u8", "conversions_u8", "products_u8", "quotients_u8"});
    run_for<int8_t>({"sums_s8", "shifts_s8", "conversions_s8", "products_s8", "quotients_s8"});
    run_for<uint16_t>(
        {"sums_u16", "shifts_u16", "conversions_u16", "products_u16", "quotients_u16"});
    run_for<int16_t>(
        {"sums_s16", "shifts_s16", "conversions_s16", "products_s16", "quotients_s16"});
    run_for<uint32_t>(
        {"sums_u32", "shifts_u32", "conversions_u32", "products_u32", "quotients_u32"});
    run_for<int32_t>(
        {"sums_s32", "shifts_s32", "conversions_s32", "products_s32", "quotients_s32"});
    run("narrow_quotients", kRounds, check_narrow_quotients);
    run("lerp", kRounds, check_lerp);
    run("units", kRounds, check_units);
    run("roots", kRounds, check_roots);
    run("angles", kRounds, check_angles);
    run("ring", kRounds, check_ring);
}

}  // namespace probe
