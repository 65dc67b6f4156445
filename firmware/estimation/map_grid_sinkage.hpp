// map_grid_sinkage.hpp - sinkage: undisturbed ground seen ahead minus the surface the wheel found.
// Depends on   map_grid_surface.hpp, square_table.hpp.
// Source       Wilcox 1994, "primary function being estimated is the loadbearing surface"; sinkage
//              from the look-ahead samples, shrunk by what their noise allows.
// Bounds       at most the 32 bins of the ring are looked at.
// Tests        tests/firmware/estimation/map_grid_sinkage_test.cpp
#pragma once

#include "firmware/estimation/map_grid_surface.hpp"
#include "firmware/estimation/tables/square_table.hpp"

namespace rover::slip {

/// Puts the sample into its bin; two in one bin are averaged. Bins that the front wheel has passed
/// or that are beyond the ring take none.
[[gnu::noinline]] constexpr void insert_sample(MapGrid& map, U16 place_q6_bin, S16 height_q4_mm) {
    const U16 split = split_place(place_q6_bin);
    const U8 bin = node_of(split);
    if (sub_wrap(bin, map.passed_bin) > U8{kSampleReach}) return;
    const uint8_t i = ring_index(bin);
    U8 fraction = bit_or(fraction_q8_of(split), U8{1});
    const U8 old = map.ahead.fraction_q8[i];
    if (old != U8{0}) {
        fraction = bit_or(bit_and(average(fraction, old), U8{0xFC}), U8{1});
        const S16 seen = map.ahead.height_q4_mm[i];
        height_q4_mm = add_wrap(seen, halve_floor(sub_wrap(height_q4_mm, seen)));
    }
    map.ahead.fraction_q8[i] = fraction;
    map.ahead.height_q4_mm[i] = height_q4_mm;
}

/// Place of a sample, as node and fraction.
constexpr U16 sample_place(U8 bin, U8 fraction_q8) {
    return bit_or(shift_left_wrap<8>(widen_u16(bin)), widen_u16(bit_and(fraction_q8, U8{0xFC})));
}

/// Share of the smoothed sinkage to believe, Q7 [0, 128]: 1 - 0.64 noise^2 / signal^2.
constexpr U8 believed_share_q7(const MapGrid& map) {
    const U8 size =  // Q4
        narrow_wrap_u8(
            shift_floor<8>(shift_left_wrap<1>(narrow_wrap_u16(map.sinkage_size_q11_mm))));
    const U8 rough = narrow_wrap_u8(shift_floor<7>(map.rough_q8_mm));  // Q1
    // 0.378 of the root of the sum of squares, as larger + 3/8 smaller. 0.378 * 0.3 * 8 = 0.91.
    const U8 by_rough = sub_wrap(rough, shift_floor<3>(rough));
    const U8 noise = by_rough < U8{kNoiseFloorQ4Mm}
                         ? add_wrap(shift_floor<2>(add_wrap(by_rough, shift_floor<1>(by_rough))),
                                    U8{kNoiseFloorQ4Mm})
                         : add_wrap(by_rough, U8{4});
    const U8 signal = add_sat(size, shift_floor<2>(size));  // 0.64 = (4/5)^2
    if (noise >= signal) return U8{0};
    const U8 ratio_q5 = shift_floor<3>(ratio_q8(widen_u16(noise), widen_u16(signal)));
    return sub_wrap(U8{128}, kSquareQ3[index_of(add_wrap(ratio_q5, U8{128}))]);
}

/// Smooths one raw sinkage and shrinks it; never negative.
/// @param raw_q4_mm  modulo 2 m: more than 1 m counts as less than nothing
constexpr void smooth_sinkage(MapGrid& map, S16 raw_q4_mm) {
    const uint8_t count = map.sinkage_count;
    const S16 raw = shift_left_wrap<1>(raw_q4_mm);
    S16 smooth = raw;
    if (count > 0) {
        const S16 way = sub_wrap(raw, map.sinkage_smooth_q5_mm);
        smooth = add_wrap(map.sinkage_smooth_q5_mm,
                          count == 1 ? halve_floor(way) : shift_floor<2>(add_wrap(way, S16{2})));
    }
    map.sinkage_smooth_q5_mm = smooth;
    const U16 size_q5 = abs_u16(smooth);
    const S16 size_q11 = narrow_wrap_s16(shift_left_wrap<6>(min(size_q5, U16{kSizeMaxQ5Mm})));
    map.sinkage_size_q11_mm = lerp_at(map.sinkage_size_q11_mm, size_q11, U8{kSizeGainQ8[count]});
    if (count < kSizeSteps) ++map.sinkage_count;
    S16 sinkage{0};
    if (smooth > S16{0}) {
        sinkage = narrow_wrap_s16(shift_floor<8>(mul_wide(smooth, believed_share_q7(map))));
    }
    map.sinkage_q4_mm = sinkage;
    map.sinkage_alarm = sinkage > S16{kSinkageAlarmQ4Mm};
}

/// Moves on to the bin of the front wheel: the last sample that it passed is kept, all others of
/// passed bins are forgotten.
/// @param split  place of the front wheel as node and fraction
constexpr void pass_samples(MapGrid& map, U16 split) {
    const U8 front_bin = node_of(split);
    U8 bin = map.passed_bin;
    for (uint8_t i = 0; i < kNodeCount; ++i) {
        U8& fraction = map.ahead.fraction_q8[ring_index(bin)];
        if (fraction != U8{0}) {
            if (bin == front_bin && fraction > bit_or(fraction_q8_of(split), U8{1})) break;
            map.has_behind = true;
            map.behind_place_q8_bin = sample_place(bin, fraction);
            map.behind_height_q4_mm = map.ahead.height_q4_mm[ring_index(bin)];
            fraction = U8{0};
        }
        if (bin == front_bin) break;
        bin = add_wrap(bin, U8{1});
    }
    map.passed_bin = front_bin;
}

/// The ground under the front wheel between the samples on both sides of it.
/// @return  true: there are two
constexpr bool ground_at_front(const MapGrid& map, U16 split, S16& ground_q4_mm) {
    if (!map.has_behind) return false;
    U8 bin = map.passed_bin;
    for (uint8_t i = 0; i < kSearchBins; ++i) {
        const U8 fraction = map.ahead.fraction_q8[ring_index(bin)];
        if (fraction != U8{0}) {
            const U16 span = sub_wrap(sample_place(bin, fraction), map.behind_place_q8_bin);
            const U16 along = sub_wrap(split, map.behind_place_q8_bin);
            if (span >= U16{kSpanMaxQ8Bin}) return false;
            ground_q4_mm = lerp_at(map.behind_height_q4_mm, map.ahead.height_q4_mm[ring_index(bin)],
                                   ratio_q8(along, span));
            return true;
        }
        bin = add_wrap(bin, U8{1});
    }
    return false;
}

/// Takes in this cycle's look-ahead samples.
constexpr void insert_samples(MapGrid& map, const MapGridInput& input, S16 rear_height_q4_mm) {
    static_assert(kLookAheadMax == 2);
    if (input.ahead_count > 0) {
        insert_sample(map, add_wrap(map.place_q6_bin, input.ahead_distance_q6_bin[0]),
                      add_wrap(rear_height_q4_mm, input.ahead_height_q4_mm[0]));
    }
    if (input.ahead_count > 1) {
        insert_sample(map, add_wrap(map.place_q6_bin, input.ahead_distance_q6_bin[1]),
                      add_wrap(rear_height_q4_mm, input.ahead_height_q4_mm[1]));
    }
}

/// The sinkage under the front wheel, when samples bracket it.
constexpr void sense_sinkage(MapGrid& map) {
    const U16 split = split_place(map.front_place_q6_bin);
    pass_samples(map, split);
    S16 ground{0};
    map.sinkage_valid = ground_at_front(map, split, ground);
    if (map.sinkage_valid) smooth_sinkage(map, sub_wrap(ground, map.front_height_q4_mm));
}

}  // namespace rover::slip
