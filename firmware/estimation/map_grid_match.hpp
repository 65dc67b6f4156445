// map_grid_match.hpp - where along the map does the middle wheel's height fit? Weighted sum of
//                      squares by table look-up over nine places, then a parabola.
// Depends on   map_grid_surface.hpp, square_table.hpp.
// Source       Wilcox 1994, step 2 (two terms: middle wheel and prior), on half bins.
// Bounds       5 residuals, 9 candidates.
// Tests        tests/firmware/estimation/map_grid_match_test.cpp
#pragma once

#include "firmware/estimation/map_grid_surface.hpp"
#include "firmware/estimation/tables/square_table.hpp"

namespace rover::slip {

inline constexpr uint8_t kResidualCount = kHalfBinCandidates / 2 + 1;

/// Residual sigma in 1/8 mm, an octave: u8 [1, 128] for 0.125 to 16 mm. It is a quarter of the
/// roughness, wider when matching has gone badly.
constexpr U8 residual_sigma_q3_mm(const MapGrid& map) {
    U8 sigma{128};
    const U8 least_q1_mm = kRoughOf16MmQ1[index_of(shift_floor<8>(map.match_cost_q10))];
    U16 rough = shift_left_wrap<1>(map.rough_q8_mm);  // high byte Q1
    while (narrow_wrap_u8(shift_floor<8>(rough)) < least_q1_mm && sigma != U8{1}) {
        rough = shift_left_wrap<1>(rough);
        sigma = shift_floor<1>(sigma);
    }
    return sigma;
}

/// Squared distance in 1/8 squared sigma, saturating, from a distance in 1/8 sigma plus 128.
constexpr U8 square_q3(U8 steps) {
    return kSquareQ3[index_of(steps)];
}

/// Expected advance of this cycle: the learned mean of a 6 cm cycle and the odd bit of odometry,
/// which counts from 0 to 20 cm. Rounded half up, not negative.
[[gnu::noinline]] constexpr S16 expected_advance_q6_bin(const MapGrid& map,
                                                        const MapGridInput& input) {
    S16 odometer = input.odometer_q6_bin;
    if (narrow_wrap_u16(odometer) > U16{511}) odometer = odometer < S16{0} ? S16{0} : S16{511};
    const S16 advance_q12 = add_wrap(
        map.mean_q12_bin, add_wrap(shift_left_wrap<6>(odometer), S16{32 - kMeanNoSlipQ12Bin}));
    return max(shift_floor<6>(advance_q12), S16{0});
}

/// Adds to the systematic part of the position's uncertainty, saturating.
[[gnu::noinline]] constexpr void add_drift(MapGrid& map, U16 drift_q12_bin) {
    map.drift_q12_bin = add_sat(map.drift_q12_bin, widen_u32(drift_q12_bin));
}

/// Nine half bins around the expected place, and what is found there.
struct Match {
    /// Misfit of the middle wheel with the rear wheel on candidate i, in 1/8 sigma plus 128; then
    /// its cost. The first byte is no candidate.
    U8 steps[kHalfBinCandidates + 1];
    U8 last;       ///< misfit of the last node
    uint8_t best;  ///< candidate with the least cost
    U8 least_q3;   ///< 1/8 of a squared sigma
    U8 fit_q3;     ///< squared residual part of it
};

/// A misfit in 1/8 sigma plus 128, rounded down, saturating with its sign.
[[gnu::noinline]] constexpr U8 misfit_steps(U16 misfit_q7_mm, U8 sigma_q3_mm) {
    const U8 high = narrow_wrap_u8(shift_floor<8>(misfit_q7_mm));
    const U8 doubled = shift_left_wrap<1>(sigma_q3_mm);  // 16 sigma to both sides, in 2 mm
    if (add_wrap(high, sigma_q3_mm) > sub_wrap(doubled, U8{1})) {
        return narrow_wrap_u8(shift_floor<7>(narrow_wrap_s8(bit_xor(high, U8{255}))));
    }
    for (U8 left = doubled; left != U8{0}; left = shift_left_wrap<1>(left)) {
        misfit_q7_mm = shift_left_wrap<1>(misfit_q7_mm);
    }
    return add_wrap(narrow_wrap_u8(shift_floor<8>(misfit_q7_mm)), U8{128});
}

/// A word times a number of four bits, modulo 2^16.
constexpr U16 mul_nibble(U16 word, U8 nibble) {
    U16 product{0};
    U8 bits = shift_left_wrap<4>(nibble);
    uint8_t left = 4;
    do {
        product = shift_left_wrap<1>(product);
        if (bits >= U8{128}) product = add_wrap(product, word);
        bits = shift_left_wrap<1>(bits);
    } while (--left != 0);
    return product;
}

/// Misfits with the rear wheel on `rear`, the nodes behind it, and in between.
[[gnu::noinline]] constexpr void find_misfits(const MapGrid& map, const MapGridInput& input,
                                              U8 rear, Match& match) {
    const U8 sigma_q3_mm = residual_sigma_q3_mm(map);
    const U16 middle_split = split_place(add_wrap(input.middle_distance_q6_bin, U16{2}));
    const U8 fraction_q4 = shift_floor<4>(fraction_q8_of(middle_split));
    const U8 ahead = node_of(middle_split);
    U16 before_q4_mm = narrow_wrap_u16(node_height(map, add_wrap(rear, ahead)));
    match.last = U8{0};
    U8* out = match.steps;
    uint8_t left = kResidualCount;
    do {
        const U16 seen = sub_wrap(add_wrap(narrow_wrap_u16(node_height(map, rear)),
                                           narrow_wrap_u16(input.middle_height_q4_mm)),
                                  before_q4_mm);
        rear = add_wrap(rear, U8{1});
        const U16 after_q4_mm = narrow_wrap_u16(node_height(map, add_wrap(rear, ahead)));
        const S16 rise = narrow_wrap_s16(sub_wrap(after_q4_mm, before_q4_mm));
        before_q4_mm = after_q4_mm;
        const U16 misfit_q7_mm = sub_wrap(
            shift_left_wrap<3>(seen), mul_nibble(narrow_wrap_u16(halve_floor(rise)), fraction_q4));
        const U8 steps = misfit_steps(misfit_q7_mm, sigma_q3_mm);
        out[0] = average(match.last, steps);
        match.last = steps;
        out[1] = steps;
        out += 2;
    } while (--left != 0);
}

/// First minimum of the costs of kHalfBinCandidates half bins.
/// @param first  first candidate that is not behind the rear wheel: 0, 2 or 4
/// @param off_q6_bin  from the expected place to the middle candidate, [-31, 32]
[[gnu::noinline]] constexpr void find_minimum(uint8_t first, S8 off_q6_bin, Match& match) {
    // A half bin is one sigma of the prior, so candidate 4 + k is off + 16 k sixteenths of a sigma
    // away: (off + 16 k)^2 / 32 = off^2 / 32 + off k + 8 k^2, whose first term alone is looked up.
    // Ties to even: a rounding of one kind would shift every advance.
    const U8 tie = bit_and(narrow_wrap_u8(shift_floor<1>(off_q6_bin)), U8{1});
    const S8 off = halve_floor(add_wrap(off_q6_bin, narrow_wrap_s8(tie)));  // [-16, 16]
    const U8 vertex_q3 = square_q3(add_wrap(shift_floor<1>(abs_u8(off)), U8{128}));
    U8 prior_q3 = sub_wrap(add_wrap(vertex_q3, U8{128}), narrow_wrap_u8(shift_left_wrap<2>(off)));
    U8 step = add_wrap(narrow_wrap_u8(off), U8{256 + 8 - 64});
    for (uint8_t i = 0; i < first; ++i) {
        prior_q3 = add_wrap(prior_q3, step);
        step = add_wrap(step, U8{16});
    }
    U8 least{255};
    match.best = first;
    match.fit_q3 = U8{255};
    U8* place = match.steps + 1 + first;
    for (uint8_t i = first; i < kHalfBinCandidates; ++i) {
        const U8 fit = square_q3(*place);
        const U8 sum = add_sat(fit, prior_q3);
        *place = sum;
        if (sum < least) {
            least = sum;
            match.best = i;
            match.fit_q3 = fit;
        }
        ++place;
        prior_q3 = add_wrap(prior_q3, step);
        step = add_wrap(step, U8{16});
    }
    match.least_q3 = least;
}

/// Running cost, loss of lock and its return.
[[gnu::noinline]] constexpr void judge_match(MapGrid& map, U8 cost_q3) {
    const U16 now_q10 = shift_left_wrap<7>(widen_u16(min(cost_q3, U8{kCostCapQ3})));
    // An eighth of the way, rounded half up.
    const S16 way_q10 = narrow_wrap_s16(sub_wrap(now_q10, map.match_cost_q10));
    map.match_cost_q10 =
        add_wrap(map.match_cost_q10, narrow_wrap_u16(shift_floor<3>(add_wrap(way_q10, S16{4}))));
    if (map.match_cost_q10 > U16{kReacquireCostQ10}) {
        if (map.mode != SlipMode::reacquiring) {
            map.lost_lock = true;
            add_drift(map, U16{kDriftPerLossQ12Bin});
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

/// Parabola through the least cost and its neighbours. A half bin is 32 units; rounded half away.
constexpr void fit_parabola(U8 before, U8 least, U8 after, Parabola& result) {
    const U16 bend =
        add_wrap(widen_u16(sub_wrap(before, least)), widen_u16(sub_wrap(after, least)));
    if (bend == U16{0}) return;
    if (bend >= U16{kBendInformedQ3}) {
        const U8 sixteenth = narrow_wrap_u8(shift_floor<8>(shift_left_wrap<4>(bend)));
        result.variance_q12 = shift_left_wrap<2>(widen_u16(U8{kVarianceQ10[index_of(sixteenth)]}));
    }
    const bool ahead = before >= after;
    const U16 rest = widen_u16(ahead ? sub_wrap(before, after) : sub_wrap(after, before));
    const U8 size = ratio_q8(rest, shift_left_wrap<4>(bend));
    const S16 offset = widen_s16(narrow_wrap_s8(size));
    result.offset_q6_bin = ahead ? offset : neg_wrap(offset);
}

/// Adds to the variance of the position and follows with its root: rounded down to a multiple of
/// kSpreadStepQ6Bin, at most kSpreadStepsMax such steps a cycle. The variance wraps after 4 million
/// cycles (250 km) at least.
constexpr void add_variance(MapGrid& map, U16 variance_q12) {
    map.variance_q12 = add_wrap(map.variance_q12, widen_u32(variance_q12));
    if (map.spread_q6_bin >= U16{kSpreadMaxQ6Bin}) return;
    U16 rest = add_wrap(map.spread_rest_q12, variance_q12);
    // (s + 8)^2 = s^2 + 16 s + 64
    U16 next = add_wrap(shift_left_wrap<4>(map.spread_q6_bin), U16{64});
    uint8_t left = kSpreadStepsMax;
    do {
        if (rest < next) break;
        rest = sub_wrap(rest, next);
        next = add_wrap(next, U16{128});
        map.spread_q6_bin = add_wrap(map.spread_q6_bin, U16{kSpreadStepQ6Bin});
    } while (--left != 0);
    map.spread_rest_q12 = rest;
}

/// Finds the advance that fits best, and how sure it is: cost_q3, added_variance_q12 and the drift.
/// @return  s16 1/64 bin, [0, kReachQ6Bin + kBeyondQ6Bin]
[[gnu::noinline]] constexpr S16 match_advance(MapGrid& map, const MapGridInput& input) {
    const S16 expected_q6 = expected_advance_q6_bin(map, input);
    // Four half bins to both sides of the half bin nearest to the expected place.
    const U16 expected = add_wrap(map.place_q6_bin, narrow_wrap_u16(expected_q6));
    const U16 node = shift_floor<6>(sub_wrap(expected, U16{96}));
    const U16 first_place = shift_left_wrap<6>(node);
    const S16 off = ahead_of(expected, add_wrap(first_place, U16{128}));
    uint8_t first = 0;
    S16 behind = ahead_of(first_place, map.place_q6_bin);
    if (behind >= S16{64}) first = 2;
    if (behind >= S16{128}) first = 4;
    Match match;
    find_misfits(map, input, narrow_wrap_u8(node), match);
    find_minimum(first, narrow_wrap_s8(off), match);
    const bool inside = match.best > first && match.best < kHalfBinCandidates - 1;
    Parabola minimum;
    if (inside) {
        const U8* least = match.steps + 1 + match.best;
        fit_parabola(least[-1], match.least_q3, least[1], minimum);
    }
    map.added_variance_q12 = minimum.variance_q12;
    if (minimum.variance_q12 == U16{kPriorVarianceQ12}) {
        add_drift(map, narrow_wrap_u16(shift_floor<2>(expected_q6)));  // mean/256: q6 << 6 >> 8
    }
    map.cost_q3 = match.least_q3;
    if (!inside && match.fit_q3 > U8{kCredibleFitQ3}) return expected_q6;
    const U16 place = add_wrap(add_wrap(first_place, shift_left_wrap<5>(widen_u16(U8{match.best}))),
                               narrow_wrap_u16(minimum.offset_q6_bin));
    return max(ahead_of(map.place_q6_bin, place), S16{0});
}

/// Moves the learned mean towards an observed advance, 1/64 bin [0, 511].
constexpr void learn_advance(MapGrid& map, S16 advance_q6_bin) {
    const S16 mean = lerp_at(map.mean_q12_bin, shift_left_wrap<6>(advance_q6_bin),
                             U8{kLearnGainQ8[map.learned]});
    map.mean_q12_bin = clamp(mean, S16{kMeanMinQ12Bin}, S16{kMeanNoSlipQ12Bin});
    if (map.learned < kLearnSteps) ++map.learned;
}

}  // namespace rover::slip
