// map_grid_match.hpp - where along the map does the middle wheel's height fit? Weighted sum of
//                      squares by table look-up over nine places, then a parabola.
// Depends on   map_grid_surface.hpp, square_table.hpp.
// Source       Wilcox 1994, step 2 (two terms: middle wheel and prior), on half bins.
// Bounds       6 residuals, 9 candidates.
// Tests        tests/firmware/estimation/map_grid_match_test.cpp
#pragma once

#include "firmware/estimation/map_grid_surface.hpp"
#include "firmware/estimation/tables/square_table.hpp"

namespace rover::slip {

inline constexpr uint8_t kResidualCount = 6;

/// The minimum of the weighted sum of squares and what surrounds it.
struct Match {
    U16 cost_q6[kHalfBinCandidates] = {};
    U16 fit_q6{0};     ///< squared residual part at the minimum
    uint8_t best = 0;  ///< index of the minimum
};

/// Residual sigma now: a share of the roughness, wider when matching has gone badly. mm Q8.
constexpr U16 residual_sigma_q8_mm(const MapGrid& map) {
    const U16 base = max(shift_floor<kSigmaPerRoughShift>(map.rough_q8_mm), U16{kSigmaFloorQ8Mm});
    const U16 widen_q8 =
        narrow_sat_u16(shift_floor<10>(mul_wide(map.match_cost_q10, U16{kWidenPerCostQ8})));
    const U16 bounded_q8 = clamp(widen_q8, U16{256}, U16{kWidenMaxQ8});
    return narrow_sat_u16(shift_round_half_up<8>(mul_wide(base, bounded_q8)));
}

/// Misfit of the middle wheel if the rear wheel stood at `node`, in 1/16 sigma, within +-1023.
constexpr S16 scaled_residual(const MapGrid& map, U16 node, const MapGridInput& input,
                              U16 per_sigma_q12) {
    const U16 middle = add_wrap(shift_left_wrap<6>(node), input.middle_distance_q6_bin);
    const S16 rise = sub_wrap(surface_at(map, middle), node_height(map, node));
    const S16 misfit_q4_mm = sub_wrap(input.middle_height_q4_mm, rise);
    const S16 scaled =
        narrow_sat_s16(shift_round_half_up<12>(mul_wide(misfit_q4_mm, per_sigma_q12)));
    return clamp(scaled, S16{-1023}, S16{1023});
}

/// Square of a distance in 1/16 sigma, in 1/64 squared sigma; saturates at 256 squared sigma.
constexpr U16 square_q6(S16 distance) {
    return look_up(kSquareQ6, narrow_sat_u8(abs_u16(distance)));
}

/// Expected advance of this cycle: the learned mean of a 6 cm cycle and the odd bit of odometry.
constexpr S16 expected_advance_q12_bin(const MapGrid& map, const MapGridInput& input) {
    const S16 odometer_q12_bin = shift_left_sat<6>(input.odometer_q6_bin);
    return add_sat(map.mean_q12_bin, sub_sat(odometer_q12_bin, S16{kMeanNoSlipQ12Bin}));
}

/// All nine costs and their first minimum.
constexpr Match match_costs(const MapGrid& map, const MapGridInput& input, U16 first_half_bin) {
    // 16 steps per sigma, 16 units per mm: 2^20 / sigma_q8 is steps per unit in Q12.
    const U16 per_sigma_q12 = div_floor_sat_u16(U32{1048576}, residual_sigma_q8_mm(map));
    const U16 first_node = shift_floor<1>(first_half_bin);
    S16 residual[kResidualCount] = {};
    for (uint8_t i = 0; i < kResidualCount; ++i) {
        residual[i] =
            scaled_residual(map, add_wrap(first_node, widen_u16(U8{i})), input, per_sigma_q12);
    }
    const S16 expected_q12 = expected_advance_q12_bin(map, input);
    const U16 first_place = shift_left_wrap<5>(first_half_bin);
    S16 offset_q12 =
        sub_sat(shift_left_sat<6>(ahead_of(map.place_q6_bin, first_place)), expected_q12);
    bool between = bit_and(first_half_bin, U16{1}) != U16{0};
    Match match;
    uint8_t node = 0;
    for (uint8_t i = 0; i < kHalfBinCandidates; ++i) {
        const S16 misfit = between ? average(residual[node], residual[node + 1]) : residual[node];
        const U16 fit = square_q6(misfit);
        const U16 prior = square_q6(shift_round_half_up<kPriorShift>(offset_q12));
        match.cost_q6[i] = add_wrap(fit, prior);
        if (i == 0 || match.cost_q6[i] < match.cost_q6[match.best]) {
            match.best = i;
            match.fit_q6 = fit;
        }
        if (between) ++node;
        between = !between;
        offset_q12 = add_sat(offset_q12, S16{2048});  // half a bin
    }
    return match;
}

/// Running cost, loss of lock and its return.
constexpr void judge_match(MapGrid& map, U16 cost_q6) {
    const S16 now_q10 = narrow_wrap_s16(shift_left_wrap<4>(min(cost_q6, U16{kCostCapQ6})));
    map.match_cost_q10 =
        narrow_wrap_u16(approach(narrow_wrap_s16(map.match_cost_q10), now_q10, 32));
    if (map.match_cost_q10 > U16{kReacquireCostQ10}) {
        if (map.mode != SlipMode::reacquiring) {
            map.lost_lock = true;
            map.drift_q12_bin = add_sat(map.drift_q12_bin, U32{kDriftPerLossQ12Bin});
        }
        map.mode = SlipMode::reacquiring;
        map.mean_q12_bin = max(map.mean_q12_bin, S16{kMeanReacquireQ12Bin});
        map.learned = 0;
        map.match_cost_q10 = U16{kAfterLossCostQ10};
    } else if (map.mode != SlipMode::reacquiring || map.match_cost_q10 < U16{kTrackingCostQ10}) {
        map.mode = SlipMode::tracking;
    }
}

/// Finds the advance that fits best, and books how sure it is.
/// @return  s16 1/64 bin, [0, kReachQ6Bin + 31]
constexpr S16 match_advance(MapGrid& map, const MapGridInput& input) {
    const S16 expected_q6 =
        max(shift_round_half_up<6>(expected_advance_q12_bin(map, input)), S16{0});
    const U16 first_half_bin = shift_floor<5>(add_wrap(map.place_q6_bin, U16{31}));
    const Match match = match_costs(map, input, first_half_bin);
    const uint8_t best = match.best;
    const bool inside = best > 0 && best < kHalfBinCandidates - 1;
    S16 fine_q6{0};
    U16 variance_q12{kPriorVarianceQ12};
    if (inside) {
        const S32 before = widen_s32(match.cost_q6[best - 1]);
        const S32 after = widen_s32(match.cost_q6[best + 1]);
        const S32 bend =
            sub_wrap(add_wrap(before, after), shift_left_wrap<1>(widen_s32(match.cost_q6[best])));
        if (bend > S32{0}) {
            const S32 tilt = shift_left_wrap<4>(sub_wrap(before, after));
            fine_q6 = narrow_sat_s16(div_round_half_up(tilt, bend));
            variance_q12 = min(variance_q12, div_floor_sat_u16(U32{131072}, narrow_sat_u16(bend)));
        }
    }
    map.variance_q12 = add_sat(map.variance_q12, widen_u32(variance_q12));
    if (variance_q12 > U16{kUninformedVarianceQ12}) {
        const S16 share_q12 = shift_floor<2>(expected_q6);  // mean / 256: q6 << 6 >> 8
        map.drift_q12_bin = add_sat(map.drift_q12_bin, widen_u32(narrow_wrap_u16(share_q12)));
    }
    judge_match(map, match.cost_q6[best]);
    if (!inside && match.fit_q6 > U16{kCredibleFitQ6}) return expected_q6;
    const U16 half_bins = add_wrap(first_half_bin, widen_u16(U8{best}));
    const U16 place = add_wrap(shift_left_wrap<5>(half_bins), narrow_wrap_u16(fine_q6));
    return max(ahead_of(map.place_q6_bin, place), S16{0});
}

/// Moves the learned mean towards an observed advance.
constexpr void learn_advance(MapGrid& map, S16 advance_q6_bin) {
    map.mean_q12_bin = clamp(
        approach(map.mean_q12_bin, shift_left_sat<6>(advance_q6_bin), kLearnGainQ8[map.learned]),
        S16{kMeanMinQ12Bin}, S16{kMeanNoSlipQ12Bin});
    if (map.learned < kLearnSteps) ++map.learned;
}

}  // namespace rover::slip
