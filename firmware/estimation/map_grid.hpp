// map_grid.hpp - slip and sinkage from articulation, the estimator that flies: one cycle, in three
// parts that a control step each can take.
// Depends on   map_grid_match.hpp, map_grid_surface.hpp, map_grid_sinkage.hpp.
// Source       Wilcox 1994; changes and why in docs/design/slip-and-sinkage.md.
// Bounds       no heap, no recursion; state in MapGrid. Any sequence of inputs leaves a defined
//              state (MapGrid.AnyInputSequenceLeavesADefinedState).
// Tests        tests/firmware/estimation/map_grid_test.cpp
#pragma once

#include "firmware/estimation/map_grid_match.hpp"
#include "firmware/estimation/map_grid_sinkage.hpp"

namespace rover {
namespace slip {

/// Is the ground under all candidate places of rear and middle wheel known?
constexpr bool can_match(MapGrid& map, const MapGridInput& input) {
    if (!map.has_map) return false;
    if (!map.measured) {
        map.measured = ahead_of(map.measured_from_q6_bin, map.place_q6_bin) >= S16{0};
        if (!map.measured) return false;
    }
    if (input.odometer_q6_bin < S16{0} || input.odometer_q6_bin > S16{kReachQ6Bin}) return false;
    if (ahead_of(map.lowest_q6_bin, map.place_q6_bin) < S16{0}) return false;
    const U16 middle = add_wrap(map.place_q6_bin, input.middle_distance_q6_bin);
    // The expected advance is the odometer's at most; with the nodes around the last candidate.
    const U16 reach = add_wrap(narrow_wrap_u16(input.odometer_q6_bin), U16{kBeyondQ6Bin + 64});
    const U16 needed = add_wrap(middle, reach);
    return ahead_of(needed, add_wrap(map.front_place_q6_bin, U16{64})) >= S16{0};
}

[[gnu::noinline]] constexpr void move_by(MapGrid& map, S16 advance_q6_bin) {
    map.advance_q6_bin = advance_q6_bin;
    map.place_q6_bin = add_wrap(map.place_q6_bin, narrow_wrap_u16(advance_q6_bin));
    map.travelled_q6_bin = add_wrap(map.travelled_q6_bin, widen_s32(advance_q6_bin));
}

/// A quarter of a distance that nothing but the wheels measured; at most 40 cm.
[[gnu::noinline]] constexpr void add_odometry_doubt(MapGrid& map, S16 distance_q6_bin) {
    add_drift(map, shift_left_wrap<4>(min(abs_u16(distance_q6_bin), U16{4095})));
}

constexpr void step_reverse(MapGrid& map, const MapGridInput& input) {
    move_by(map, input.odometer_q6_bin);
    add_odometry_doubt(map, input.odometer_q6_bin);
    map.mode = SlipMode::reversing;
    const S16 behind = ahead_of(map.place_q6_bin, map.lowest_q6_bin);
    if (behind > S16{kForgetBehindQ6Bin}) drop_map(map);
}

constexpr void step_displaced(MapGrid& map, bool turning) {
    drop_map(map);
    move_by(map, S16{0});
    map.mode = turning ? SlipMode::turning : SlipMode::moved;
    add_drift(map, U16{turning ? kDriftPerTurnQ12Bin : kDriftPerMoveQ12Bin});
}

/// Distances that the search can use; a linkage folded further is treated as no linkage.
constexpr bool usable_linkage(const MapGridInput& input) {
    if (!input.linkage) return false;
    const U16 middle = input.middle_distance_q6_bin;
    const U16 front = input.front_distance_q6_bin;
    return middle >= U16{kMiddleMinQ6Bin} && middle <= U16{kMiddleMaxQ6Bin} &&
           front <= U16{kFrontMaxQ6Bin} && front >= add_wrap(middle, U16{64});
}

/// Takes the new heights into the map, or starts a new one where the old does not reach.
constexpr void update_map(MapGrid& map, const MapGridInput& input) {
    const U16 front = add_wrap(map.place_q6_bin, input.front_distance_q6_bin);
    S16 rear_height_q4_mm{0};
    if (map.has_map && ahead_of(map.front_place_q6_bin, front) > S16{kGapMaxQ6Bin}) drop_map(map);
    if (!map.has_map) {
        begin_map(map, input, front);
    } else if (ahead_of(map.lowest_q6_bin, map.place_q6_bin) < S16{0}) {
        return;  // still behind the map
    } else {
        rear_height_q4_mm = extend_map(map, input, front);
    }
    insert_samples(map, input, rear_height_q4_mm);
}

constexpr void step_forward(MapGrid& map, MapGridInput& input) {
    input.linkage = usable_linkage(input);
    if (input.linkage && can_match(map, input)) {
        if (map.mode != SlipMode::tracking) map.mode = SlipMode::reacquiring;
        move_by(map, match_advance(map, input));
        map.matched = true;
    } else {
        move_by(map, expected_advance_q6_bin(map, input));
        add_odometry_doubt(map, map.advance_q6_bin);
        map.mode = input.linkage ? SlipMode::reacquiring : SlipMode::odometry_only;
    }
}

/// The learned mean as a share of the way without slip: u16 Q15, [5460, 32768].
constexpr U16 learned_share_q15(const MapGrid& map) {
    // 32768 / 9830 in Q14 is 54615.6; the product is at most 32768.2 in Q16.
    constexpr uint16_t kPerMeanQ14 =
        uint16_t{(536870912ul + kMeanNoSlipQ12Bin / 2) / kMeanNoSlipQ12Bin};
    const U16 mean_q14_bin = shift_left_wrap<2>(narrow_wrap_u16(map.mean_q12_bin));
    return narrow_wrap_u16(shift_floor<16>(mul_wide(mean_q14_bin, U16{kPerMeanQ14})));
}

/// Slip that goes with a learned share, percent [0, 84], rounded.
constexpr S8 slip_percent(U16 share_q15) {
    const U32 percent_q16 = mul_wide(U8{200}, share_q15);
    return sub_wrap(S8{100}, narrow_wrap_s8(shift_floor<16>(add_wrap(percent_q16, U32{0x8000}))));
}

}  // namespace slip

/// First part of a cycle: how far the vehicle got.
/// @param map    changed in place
/// @param input  any values; where its distances are out of range, `linkage` is taken back
/// @context      control step; not re-entrant
[[gnu::noinline]] constexpr void map_grid_match(MapGrid& map, MapGridInput& input) {
    map.lost_lock = false;
    map.matched = false;
    if (input.motion == CycleMotion::forward) {
        slip::step_forward(map, input);
    } else if (input.motion == CycleMotion::reverse) {
        slip::step_reverse(map, input);
    } else {
        slip::step_displaced(map, input.motion == CycleMotion::turn);
    }
}

/// Second part: what the match says about slip, and the ground that the wheels stand on now.
/// @param input  as map_grid_match() left it
[[gnu::noinline]] constexpr void map_grid_extend(MapGrid& map, const MapGridInput& input) {
    if (map.matched) {
        slip::add_variance(map, map.added_variance_q12);
        slip::judge_match(map, map.cost_q3);
        slip::learn_advance(map, map.advance_q6_bin);
    }
    // The running cost restarts lower when lock is lost, so the loss itself counts.
    bool alarm = map.lost_lock;
    if (map.match_cost_q10 > U16{slip::kSlipAlarmCostQ10}) alarm = true;
    if (map.mean_q12_bin < S16{slip::kSlipAlarmMeanQ12Bin}) alarm = true;
    map.slip_alarm = alarm;
    map.front_is_new = false;
    if (input.motion == CycleMotion::forward && input.linkage) slip::update_map(map, input);
}

/// Third part: sinkage, where the front wheel got to new ground.
/// @param motion  of the cycle. Only forward anything can be said about it
[[gnu::noinline]] constexpr void map_grid_sinkage(MapGrid& map, CycleMotion motion) {
    if (motion != CycleMotion::forward) return;
    map.sinkage_valid = false;
    if (map.front_is_new) slip::sense_sinkage(map);
}

/// One slip-and-sinkage cycle, due every 6.0 cm of wheel odometry: all parts.
/// @param map    changed in place
/// @param input  any values; distances out of range are treated as no linkage
constexpr void map_grid_step(MapGrid& map, const MapGridInput& measured) {
    MapGridInput input = measured;
    map_grid_match(map, input);
    map_grid_extend(map, input);
    map_grid_sinkage(map, input.motion);
}

/// 1/64 bin to mm Q4: times 25/4, rounded down.
/// @param q6_bin  [0, 10485]
[[gnu::noinline]] constexpr U16 q4_mm_from_q6_bin(U16 q6_bin) {
    const U16 twice = shift_left_wrap<1>(q6_bin);
    return add_wrap(add_wrap(twice, shift_left_wrap<1>(twice)), shift_floor<2>(q6_bin));
}

/// One sigma of the position, u16 Q4 mm, saturating: covers the error in 90 % of drives.
constexpr U16 position_sigma_q4_mm(const MapGrid& map) {
    const U16 upper = narrow_wrap_u16(shift_floor<16>(map.drift_q12_bin));
    if (upper >= U16{64}) return U16{65535};  // 25 m: does not fit in a word
    const U16 drift_q6_bin = narrow_wrap_u16(shift_floor<6>(map.drift_q12_bin));
    const U16 total_q6_bin = add_sat(map.spread_q6_bin, drift_q6_bin);
    return total_q6_bin > U16{10485} ? U16{65535} : q4_mm_from_q6_bin(total_q6_bin);
}

}  // namespace rover
