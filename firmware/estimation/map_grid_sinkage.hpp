// map_grid_sinkage.hpp - sinkage: undisturbed ground seen ahead minus the surface the wheel found.
// Depends on   map_grid_surface.hpp.
// Source       Wilcox 1994, "primary function being estimated is the loadbearing surface"; sinkage
//              from the look-ahead samples, shrunk by what their noise allows.
// Bounds       at most kSampleCount samples are looked at or moved.
// Tests        tests/firmware/estimation/map_grid_sinkage_test.cpp
#pragma once

#include "firmware/estimation/map_grid_surface.hpp"

namespace rover::slip {

/// Merges the sample into one nearer than kMergeQ6Bin, else inserts it by place; a full list keeps
/// what it has.
[[gnu::noinline]] constexpr void insert_sample(MapGrid& map, U16 place_q6_bin, S16 height_q4_mm) {
    uint8_t after = map.sample_count;  // new samples are far ahead: the search begins at the end
    while (after > 0 &&
           ahead_of(place_q6_bin, sample_at(map, static_cast<uint8_t>(after - 1)).place_q6_bin) >
               S16{0}) {
        --after;
    }
    for (uint8_t step = 0; step < 2; ++step) {  // the one ahead first, then the one behind
        const uint8_t near = static_cast<uint8_t>(after - step);
        if (near >= map.sample_count) continue;
        GroundSample& sample = sample_at(map, near);
        const S16 apart = ahead_of(place_q6_bin, sample.place_q6_bin);
        if (abs_u16(apart) >= U16{kMergeQ6Bin}) continue;
        sample.place_q6_bin = add_wrap(place_q6_bin, narrow_wrap_u16(halve_floor(apart)));
        sample.height_q4_mm =
            add_wrap(height_q4_mm, halve_floor(sub_wrap(sample.height_q4_mm, height_q4_mm)));
        return;
    }
    if (map.sample_count == kSampleCount) return;
    for (uint8_t i = map.sample_count; i > after; --i) {
        sample_at(map, i) = sample_at(map, static_cast<uint8_t>(i - 1));
    }
    sample_at(map, after) = GroundSample{place_q6_bin, height_q4_mm};
    ++map.sample_count;
}

/// Forgets samples until at most one is behind the front wheel.
constexpr void forget_passed(MapGrid& map) {
    for (uint8_t i = 0; i < kSampleCount; ++i) {
        if (map.sample_count < 2) return;
        if (ahead_of(sample_at(map, 1).place_q6_bin, map.front_place_q6_bin) <= S16{0}) return;
        map.sample_first = static_cast<uint8_t>(map.sample_first + 1u);
        --map.sample_count;
    }
}

/// Share of the smoothed sinkage to believe, Q8 [0, 256]: 1 - noise^2 / signal^2.
[[gnu::noinline]] constexpr U16 believed_share_q8(const MapGrid& map) {
    const U16 by_rough_q8_mm =
        narrow_sat_u16(shift_floor<8>(mul_wide(map.rough_q8_mm, U16{kLookPerRoughQ8})));
    const U16 larger = max(by_rough_q8_mm, U16{kLookNoiseQ8Mm});
    const U16 smaller = min(by_rough_q8_mm, U16{kLookNoiseQ8Mm});
    // Root of the sum of squares, within 7 %: larger + 3/8 smaller.
    const U16 noise_q8_mm =
        add_sat(larger, add_wrap(shift_floor<2>(smaller), shift_floor<3>(smaller)));
    const U32 after_smoothing_q16 = mul_wide(noise_q8_mm, U16{kSmoothedShareQ8});
    const U16 ratio_q8 = div_floor_sat_u16(after_smoothing_q16, map.sinkage_size_q8_mm);
    if (ratio_q8 >= U16{kBelieveNoneQ8}) return U16{0};
    const U16 squared_q8 = narrow_wrap_u16(shift_floor<8>(mul_wide(ratio_q8, ratio_q8)));
    const U16 doubt_q8 = narrow_wrap_u16(shift_floor<8>(mul_wide(squared_q8, U16{kBelieveQ8})));
    return sub_sat(U16{256}, doubt_q8);
}

/// Smooths one raw sinkage and shrinks it; never negative.
[[gnu::noinline]] constexpr void smooth_sinkage(MapGrid& map, S16 raw_q4_mm) {
    const uint8_t count = map.sinkage_count;
    const S16 raw_q6_mm = shift_left_sat<2>(raw_q4_mm);
    if (count == 0) {
        map.sinkage_smooth_q6_mm = raw_q6_mm;
        map.sinkage_size_q8_mm = shift_left_sat<2>(abs_u16(raw_q6_mm));
    } else {
        const uint8_t smooth = count < kSmoothSteps ? count : kSmoothSteps;
        map.sinkage_smooth_q6_mm =
            approach(map.sinkage_smooth_q6_mm, raw_q6_mm, kSmoothGainQ8[smooth]);
        const U16 size = min(shift_left_sat<2>(abs_u16(map.sinkage_smooth_q6_mm)), U16{32767});
        map.sinkage_size_q8_mm =
            narrow_wrap_u16(approach(narrow_wrap_s16(min(map.sinkage_size_q8_mm, U16{32767})),
                                     narrow_wrap_s16(size), kSizeGainQ8[count]));
    }
    if (count < kSizeSteps) ++map.sinkage_count;
    const S16 depth_q6_mm = max(map.sinkage_smooth_q6_mm, S16{0});
    const S32 believed = mul_wide(depth_q6_mm, believed_share_q8(map));
    map.sinkage_q4_mm = narrow_sat_s16(shift_round_half_up<10>(believed));
    map.sinkage_alarm = map.sinkage_q4_mm > S16{kSinkageAlarmQ4Mm};
}

/// Takes in this cycle's look-ahead samples and, when they bracket the front wheel, the sinkage.
constexpr void look_ahead(MapGrid& map, const MapGridInput& input, S16 rear_height_q4_mm) {
    for (uint8_t i = 0; i < input.ahead_count && i < kLookAheadMax; ++i) {
        insert_sample(map, add_wrap(map.place_q6_bin, input.ahead_distance_q6_bin[i]),
                      add_wrap(rear_height_q4_mm, input.ahead_height_q4_mm[i]));
    }
    forget_passed(map);
    const U16 front = add_wrap(map.place_q6_bin, input.front_distance_q6_bin);
    map.sinkage_valid = map.sample_count > 1 && front == map.front_place_q6_bin &&
                        ahead_of(sample_at(map, 0).place_q6_bin, map.front_place_q6_bin) >= S16{0};
    if (!map.sinkage_valid) return;
    const GroundSample& a = sample_at(map, 0);
    const GroundSample& b = sample_at(map, 1);
    const U16 span = sub_wrap(b.place_q6_bin, a.place_q6_bin);
    const U16 along = sub_wrap(map.front_place_q6_bin, a.place_q6_bin);
    const U8 fraction_q8 =
        narrow_sat_u8(div_floor_sat_u16(shift_left_wrap<8>(widen_u32(along)), span));
    const S16 ground = lerp_q8(a.height_q4_mm, b.height_q4_mm, fraction_q8);
    smooth_sinkage(map, sub_wrap(ground, map.front_height_q4_mm));
}

}  // namespace rover::slip
