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
inline constexpr uint8_t kPriorStepsPerHalfBin = 2048 >> kPriorShift;

inline constexpr uint8_t kHalfBinCount = 2 * kResidualCount - 1;

/// The minimum of the weighted sum of squares and what surrounds it.
struct Match {
    U16 cost_q6[kHalfBinCount] = {};  ///< candidate i is at first + i; the others hold fits alone
    uint8_t first = 0;
    uint8_t best = 0;  ///< candidate with the least cost
    U16 least_q6{0};
    U16 fit_q6{0};  ///< squared residual part at the minimum

    constexpr U16 cost(uint8_t candidate) const { return cost_q6[first + candidate]; }
};
static_assert(kHalfBinCount >= kHalfBinCandidates + 1);

/// Residual sigma now: a share of the roughness, wider when matching has gone badly. mm Q8.
[[gnu::noinline]] constexpr U16 residual_sigma_q8_mm(const MapGrid& map) {
    const U16 base = max(shift_floor<kSigmaPerRoughShift>(map.rough_q8_mm), U16{kSigmaFloorQ8Mm});
    const U16 widen_q8 =
        narrow_sat_u16(shift_floor<10>(mul_wide(map.match_cost_q10, U16{kWidenPerCostQ8})));
    const U16 bounded_q8 = clamp(widen_q8, U16{256}, U16{kWidenMaxQ8});
    return narrow_wrap_u16(shift_floor<8>(add_wrap(mul_wide(base, bounded_q8), U32{128})));
}

/// Square of a distance in 1/16 sigma, in 1/64 squared sigma; saturates at 256 squared sigma.
constexpr U16 square_q6(S16 distance) {
    return look_up(kSquareQ6, narrow_sat_u8(abs_u16(distance)));
}

/// Expected advance of this cycle: the learned mean of a 6 cm cycle and the odd bit of odometry.
[[gnu::noinline]] constexpr S16 expected_advance_q12_bin(const MapGrid& map,
                                                         const MapGridInput& input) {
    const S16 odometer_q12_bin = shift_left_sat<6>(input.odometer_q6_bin);
    return add_sat(map.mean_q12_bin, sub_sat(odometer_q12_bin, S16{kMeanNoSlipQ12Bin}));
}

/// Squared misfits of the middle wheel at half bins: the rear wheel on `first_node`, half a bin
/// behind it, on the next node, and so on.
[[gnu::noinline]] constexpr void squared_misfits(const MapGrid& map, const MapGridInput& input,
                                                 U16 first_node, U16 (&square)[kHalfBinCount]) {
    // 16 steps per sigma, 16 units per mm: 2^20 / sigma_q8 is steps per unit in Q12, and sigma is
    // at least kSigmaFloorQ8Mm. The other 4 bits come from the misfit, so the product is Q16.
    static_assert(1048576 / kSigmaFloorQ8Mm <= 65535);
    const U16 per_sigma_q12 =
        narrow_wrap_u16(div_floor(U32{1048576}, widen_u32(residual_sigma_q8_mm(map))));
    const S16 height_q4_mm = input.middle_height_q4_mm;
    const U16 middle_split = split_place(input.middle_distance_q6_bin);
    const U8 fraction_q8 = fraction_q8_of(middle_split);
    U8 rear = narrow_wrap_u8(first_node);
    U8 middle = add_wrap(rear, node_of(middle_split));
    S16 before_q4_mm = node_height(map, middle);
    S16 last{0};
    for (uint8_t i = 0; i < kHalfBinCount; i += 2) {
        middle = add_wrap(middle, U8{1});
        const S16 after_q4_mm = node_height(map, middle);
        const S16 rise_q4_mm =
            sub_wrap(lerp_q8(before_q4_mm, after_q4_mm, fraction_q8), node_height(map, rear));
        const S16 misfit_q4_mm =
            clamp(sub_wrap(height_q4_mm, rise_q4_mm), S16{-kMisfitMaxQ4Mm}, S16{kMisfitMaxQ4Mm});
        const S32 product_q16 = mul_wide(shift_left_wrap<4>(misfit_q4_mm), per_sigma_q12);
        const S16 scaled = narrow_wrap_s16(shift_floor<16>(add_wrap(product_q16, S32{0x8000})));
        const S16 misfit = clamp(scaled, S16{-1023}, S16{1023});
        square[i] = square_q6(misfit);
        if (i > 0) square[i - 1] = square_q6(halve_floor(add_wrap(last, misfit)));
        last = misfit;
        before_q4_mm = after_q4_mm;
        rear = add_wrap(rear, U8{1});
    }
}

/// The costs of kHalfBinCandidates places from `first_half_bin` on, and their first minimum.
/// @param expected_q12_bin  advance that the prior expects
[[gnu::noinline]] constexpr void match_costs(const MapGrid& map, const MapGridInput& input,
                                             U16 first_half_bin, S16 expected_q12_bin,
                                             Match& match) {
    squared_misfits(map, input, shift_floor<1>(first_half_bin), match.cost_q6);
    match.first = index_of(narrow_wrap_u8(bit_and(first_half_bin, U16{1})));
    const U16 first_place = shift_left_wrap<5>(first_half_bin);
    const S16 offset_q12 =
        sub_sat(shift_left_sat<6>(ahead_of(map.place_q6_bin, first_place)), expected_q12_bin);
    // A quarter of the squares of x, x + 16, x + 32 ...: differences 8 x + 64, 8 x + 192 ...
    const S16 offset = shift_round_half_up<kPriorShift>(offset_q12);  // 1/16 of the prior's sigma
    U16 prior_q6 = square_q6(offset);
    S16 difference = add_wrap(shift_left_wrap<3>(offset), S16{64});
    U16 least{0xFFFF};
    for (uint8_t i = 0; i < kHalfBinCandidates; ++i) {
        U16& cost = match.cost_q6[match.first + i];
        const U16 fit = cost;
        cost = add_wrap(fit, prior_q6);
        if (cost < least) {
            least = cost;
            match.best = i;
            match.fit_q6 = fit;
        }
        prior_q6 = add_wrap(prior_q6, narrow_wrap_u16(difference));
        difference = add_wrap(difference, S16{128});
    }
    match.least_q6 = least;
}

/// Running cost, loss of lock and its return.
[[gnu::noinline]] constexpr void judge_match(MapGrid& map, U16 cost_q6) {
    const S16 now_q10 = narrow_wrap_s16(shift_left_wrap<4>(min(cost_q6, U16{kCostCapQ6})));
    // An eighth of the way, rounded half up.
    const S16 step_q10 =
        shift_round_half_up<3>(sub_wrap(now_q10, narrow_wrap_s16(map.match_cost_q10)));
    map.match_cost_q10 = add_wrap(map.match_cost_q10, narrow_wrap_u16(step_q10));
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

/// Place of a parabola's minimum and how narrow it is.
struct Parabola {
    S16 offset_q6_bin{0};  ///< from the middle one of the three costs, [-16, 16]
    U16 variance_q12{kPriorVarianceQ12};
};

/// Parabola through the least cost and its neighbours. A half bin is 32 units; rounded half up.
[[gnu::noinline]] constexpr void fit_parabola(U16 before, U16 least, U16 after, Parabola& result) {
    U16 bend = add_wrap(sub_wrap(before, least), sub_wrap(after, least));
    if (bend == U16{0}) return;
    // 2^17 / bend; below 128 that is more than the prior's variance.
    if (bend > U16{128}) result.variance_q12 = div_floor(U16{65535}, halve_floor(bend));
    // 16 (before - after) / bend, bit by bit: |before - after| <= bend.
    const bool ahead = before >= after;
    U16 rest = ahead ? sub_wrap(before, after) : sub_wrap(after, before);
    if (bend >= U16{0x8000}) {  // room for the bit that comes in below
        bend = halve_floor(bend);
        rest = halve_floor(rest);
    }
    U8 whole{0};
    for (uint8_t bit = 0; bit < 5; ++bit) {
        whole = shift_left_wrap<1>(whole);
        if (rest >= bend) {
            rest = sub_wrap(rest, bend);
            whole = add_wrap(whole, U8{1});
        }
        if (bit < 4) rest = shift_left_wrap<1>(rest);
    }
    // Half up: away from zero ahead, towards it behind.
    const U16 missing = sub_wrap(bend, rest);
    if (ahead ? rest >= missing : rest > missing) whole = add_wrap(whole, U8{1});
    const S16 offset = narrow_wrap_s16(widen_u16(whole));
    result.offset_q6_bin = ahead ? offset : neg_wrap(offset);
}

/// A cycle adds at most 1024 = 32^2, so the root grows by at most 32.
inline constexpr uint8_t kSpreadStepsMax = kPriorVarianceQ12 / 32;

/// Adds to the variance of the position and follows with its root, rounded down, unit by unit.
[[gnu::noinline]] constexpr void add_variance(MapGrid& map, U16 variance_q12) {
    map.variance_q12 = add_sat(map.variance_q12, widen_u32(variance_q12));
    U32 rest = sub_wrap(map.variance_q12, mul_wide(map.spread_q6_bin, map.spread_q6_bin));
    for (uint8_t i = 0; i < kSpreadStepsMax; ++i) {
        const U32 twice = shift_left_wrap<1>(widen_u32(map.spread_q6_bin));
        if (rest <= twice) return;
        rest = sub_wrap(rest, add_wrap(twice, U32{1}));
        map.spread_q6_bin = add_wrap(map.spread_q6_bin, U16{1});
    }
}

/// Finds the advance that fits best, and books how sure it is.
/// @return  s16 1/64 bin, [0, kReachQ6Bin + 31]
[[gnu::noinline]] constexpr S16 match_advance(MapGrid& map, const MapGridInput& input) {
    const S16 expected_q12 = expected_advance_q12_bin(map, input);
    const S16 expected_q6 = max(shift_round_half_up<6>(expected_q12), S16{0});
    const U16 first_half_bin = shift_floor<5>(add_wrap(map.place_q6_bin, U16{31}));
    Match match;
    match_costs(map, input, first_half_bin, expected_q12, match);
    const uint8_t best = match.best;
    const bool inside = best > 0 && best < kHalfBinCandidates - 1;
    Parabola minimum;
    if (inside) {
        fit_parabola(match.cost(static_cast<uint8_t>(best - 1)), match.least_q6,
                     match.cost(static_cast<uint8_t>(best + 1)), minimum);
    }
    add_variance(map, minimum.variance_q12);
    if (minimum.variance_q12 > U16{kUninformedVarianceQ12}) {
        const S16 share_q12 = shift_floor<2>(expected_q6);  // mean / 256: q6 << 6 >> 8
        map.drift_q12_bin = add_sat(map.drift_q12_bin, widen_u32(narrow_wrap_u16(share_q12)));
    }
    judge_match(map, match.least_q6);
    if (!inside && match.fit_q6 > U16{kCredibleFitQ6}) return expected_q6;
    const U16 half_bins = add_wrap(first_half_bin, widen_u16(U8{best}));
    const U16 place =
        add_wrap(shift_left_wrap<5>(half_bins), narrow_wrap_u16(minimum.offset_q6_bin));
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
