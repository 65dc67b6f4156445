// map_grid.hpp - slip and sinkage from articulation, the estimator that flies: one cycle, in two
// halves of about the same length.
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

/// A quarter of a distance that nothing but the wheels measured.
[[gnu::noinline]] constexpr void add_odometry_doubt(MapGrid& map, S16 distance_q6_bin) {
    const U32 quarter_q12 = shift_left_wrap<4>(widen_u32(abs_u16(distance_q6_bin)));
    map.drift_q12_bin = add_sat(map.drift_q12_bin, quarter_q12);
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
    map.drift_q12_bin =
        add_sat(map.drift_q12_bin, U32{turning ? kDriftPerTurnQ12Bin : kDriftPerMoveQ12Bin});
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
    look_ahead(map, input, rear_height_q4_mm, front);
}

constexpr void step_forward(MapGrid& map, MapGridInput& input) {
    input.linkage = usable_linkage(input);
    if (input.linkage && can_match(map, input)) {
        if (map.mode != SlipMode::tracking) map.mode = SlipMode::reacquiring;
        const S16 advance = match_advance(map, input);
        move_by(map, advance);
        learn_advance(map, advance);
    } else {
        const S16 expected =
            shift_floor<6>(add_wrap(expected_advance_q12_bin(map, input), S16{32}));
        move_by(map, max(expected, S16{0}));
        add_odometry_doubt(map, map.advance_q6_bin);
        map.mode = input.linkage ? SlipMode::reacquiring : SlipMode::odometry_only;
    }
}

/// Slip of the learned mean against a wheel that does not slip, percent [0, 84].
constexpr S8 slip_percent(const MapGrid& map) {
    const U32 share = mul_wide(narrow_wrap_u16(map.mean_q12_bin), U16{kPercentPerMeanQ16});
    return sub_wrap(S8{100}, narrow_wrap_s8(shift_floor<16>(add_wrap(share, U32{0x8000}))));
}

}  // namespace slip

/// First half of a cycle: how far the vehicle got, how sure that is, and the slip alarm.
/// @param map    changed in place
/// @param input  any values; where its distances are out of range, `linkage` is taken back
/// @context      control step; not re-entrant
[[gnu::noinline]] constexpr void map_grid_match(MapGrid& map, MapGridInput& input) {
    map.lost_lock = false;
    switch (input.motion) {
        case CycleMotion::forward:
            slip::step_forward(map, input);
            break;
        case CycleMotion::reverse:
            slip::step_reverse(map, input);
            break;
        case CycleMotion::turn:
            slip::step_displaced(map, true);
            break;
        case CycleMotion::moved:
            slip::step_displaced(map, false);
            break;
    }
    // The running cost restarts lower when lock is lost, so the loss itself counts.
    map.slip_alarm = map.lost_lock || map.match_cost_q10 > U16{slip::kSlipAlarmCostQ10} ||
                     map.mean_q12_bin < S16{slip::kSlipAlarmMeanQ12Bin};
}

/// Second half: the ground that the wheels stand on now goes into the map, and the sinkage.
/// @param input  as map_grid_match() left it
[[gnu::noinline]] constexpr void map_grid_extend(MapGrid& map, const MapGridInput& input) {
    if (input.motion != CycleMotion::forward) return;
    map.sinkage_valid = false;
    if (input.linkage) slip::update_map(map, input);
}

/// One slip-and-sinkage cycle, due every 6.0 cm of wheel odometry: both halves.
/// @param map    changed in place
/// @param input  any values; distances out of range are treated as no linkage
constexpr void map_grid_step(MapGrid& map, MapGridInput input) {
    map_grid_match(map, input);
    map_grid_extend(map, input);
}

/// One sigma of the position, u16 Q4 mm, saturating: covers the error in 90 % of drives.
constexpr U16 position_sigma_q4_mm(const MapGrid& map) {
    if (map.drift_q12_bin >= U32{slip::kDriftReportedQ12Bin}) return U16{65535};
    const U16 drift_q6_bin = narrow_wrap_u16(shift_floor<6>(map.drift_q12_bin));
    const U16 total_q6_bin = add_sat(map.spread_q6_bin, drift_q6_bin);
    if (total_q6_bin > U16{10485}) return U16{65535};
    // 1/64 bin is 25/4 units of 1/16 mm.
    const U16 twice = shift_left_wrap<1>(total_q6_bin);
    return add_wrap(add_wrap(twice, shift_left_wrap<1>(twice)), shift_floor<2>(total_q6_bin));
}

}  // namespace rover
