// map_paper.hpp - slip and sinkage from articulation: the paper's own procedure, integers only.
// Source       Wilcox 1994, steps 1 to 5 and "Computational Requirements"; the reading of the text
//              is docs/design/slip-and-sinkage-paper.md. Kept so that the paper's Table 1 can be
//              reproduced; the estimator that flies is map_grid.
// Map          two histograms ahead of the rear contact, ground y and sinkage s, in rings with a
//              pointer. Heights are absolute modulo 4096 mm: only differences count, so moving the
//              map up by y - s at the new contact costs nothing.
// Depends on   firmware/core/arith.hpp, firmware/core/ring.hpp, map_paper_tables.hpp.
// Bounds       bin 2.5 cm: 9 candidates, 54 bins. No heap, no recursion, every loop bounded.
// Tests        tests/firmware/estimation/map_paper_test.cpp, map_paper_double_test.cpp
#pragma once

#include "firmware/core/arith.hpp"
#include "firmware/core/ring.hpp"
#include "firmware/estimation/map_paper_tables.hpp"
#include "rover_words.hpp"

namespace rover {

/// One cycle's heights above the rear contact, s16 Q4 mm; any values.
struct MapPaperHeights {
    int16_t middle_q4_mm = 0;      ///< z(1), wheel at 25 cm
    int16_t front_q4_mm = 0;       ///< z(2), wheel at 50 cm
    int16_t near_ahead_q4_mm = 0;  ///< z(3), look-ahead sample at 60 cm
    int16_t far_ahead_q4_mm = 0;   ///< z(4), look-ahead sample at 80 cm
};

/// Place of every sensor as a bin number: floor(distance / bin), as the paper's program must have
/// had it. @tparam kBinQuarterCm  bin size in 0.25 cm, [1, 32]
template <uint8_t kBinQuarterCm>
struct MapPaperLayout {
    static_assert(kBinQuarterCm >= 1 && kBinQuarterCm <= 32, "the paper's bins: 0.25 to 8 cm");
    static constexpr uint16_t kBinQ4Mm = 40u * kBinQuarterCm;
    static constexpr uint16_t kMiddle = 100u / kBinQuarterCm;
    static constexpr uint16_t kFront = 200u / kBinQuarterCm;  ///< last bin of the sinkage
    static constexpr uint16_t kNearAhead = 240u / kBinQuarterCm;
    static constexpr uint16_t kFarAhead = 320u / kBinQuarterCm;  ///< last bin of the ground
    /// Farthest candidate whose bins all lie in the histograms.
    static constexpr uint16_t kLimit =
        kFront - kMiddle < kFarAhead - kNearAhead ? kFront - kMiddle : kFarAhead - kNearAhead;
};

/// Smallest power of two of at least `count`: the size of a ring.
constexpr uint16_t map_paper_ring_size(uint16_t count) {
    uint16_t size = 2;
    while (size < count) size = shift_left_wrap<1>(size);
    return size;
}

/// Place of the minimum of the parabola through three equally spaced values whose middle one is
/// not above its neighbours.
/// @return    s16 Q8 spacings from the middle, [-128, 128]; 0 when all three are equal
/// @rounding  to the nearest 1/256 of the exact place after both rises are cut to 15 bits
constexpr S16 map_paper_parabola_q8(U32 left, U32 middle, U32 right) {
    U32 rise_left = sub_sat(left, middle);
    U32 rise_right = sub_sat(right, middle);
    for (uint8_t bit = 0; bit < 17; ++bit) {
        if (bit_or(rise_left, rise_right) < U32{0x8000}) break;
        rise_left = shift_floor<1>(rise_left);
        rise_right = shift_floor<1>(rise_right);
    }
    const S32 sum = narrow_wrap_s32(add_wrap(rise_left, rise_right));
    if (sum == S32{0}) return S16{0};
    const S32 difference = narrow_wrap_s32(sub_wrap(rise_left, rise_right));
    return narrow_wrap_s16(div_round_half_up(shift_left_wrap<7>(difference), sum));
}

template <uint8_t kBinQuarterCm>
class MapPaper {
public:
    using Layout = MapPaperLayout<kBinQuarterCm>;
    /// The vehicle's own spread of the advance, 1 cm: the search reaches four of it past the mean.
    static constexpr uint16_t kVehicleSigmaQ4Mm = 160;

    /// Starts on known ground, at position 0.
    /// @param ground_q4_mm   y at bins 0 to kFarAhead, heights above a level of the caller's choice
    /// @param sinkage_q4_mm  s at bins 0 to kFront
    constexpr void reset(const int16_t (&ground_q4_mm)[Layout::kFarAhead + 1u],
                         const int16_t (&sinkage_q4_mm)[Layout::kFront + 1u],
                         const MapPaperPrior& prior) {
        ground_.fill(S16{0});
        sinkage_.fill(S16{0});
        for (uint16_t bin = 0; bin <= Layout::kFarAhead; ++bin) {
            cell(ground_, bin) = S16{ground_q4_mm[bin]};
        }
        for (uint16_t bin = 0; bin <= Layout::kFront; ++bin) {
            cell(sinkage_, bin) = S16{sinkage_q4_mm[bin]};
        }
        for (uint16_t bin = 0; bin <= Layout::kLimit; ++bin) {
            prior_cost_[bin] = map_paper_prior_cost(U16{mul_wrap(bin, Layout::kBinQ4Mm)}, prior);
        }
        const uint16_t reach_q4_mm =
            add_sat(prior.mean_q4_mm, static_cast<uint16_t>(4u * kVehicleSigmaQ4Mm));
        const uint16_t reach = div_floor(reach_q4_mm, Layout::kBinQ4Mm);
        search_last_ = min(Layout::kLimit, add_wrap(reach, uint16_t{4}));
        search_more_ = 0;
        least_cost_ = U32{0};
    }

    /// One cycle: finds the advance, moves the map by it and works the measurements in.
    /// @return    u16 Q4 mm, advance in [0, kLimit + 1/2] bins
    /// @rounding  the place is rounded to 1/256 bin, map heights to 1/16 mm at every resampling
    constexpr uint16_t step(const MapPaperHeights& heights) {
        const uint16_t advance_q8 = find_advance_q8(S16{heights.middle_q4_mm});
        translate(advance_q8, heights);
        split_the_difference(heights);
        const uint32_t advance = mul_wide(advance_q8, Layout::kBinQ4Mm);
        return narrow_sat_u16(shift_round_half_up<8>(advance));
    }

    /// Estimated sinkage under the front wheel, s16 Q4 mm. Not clipped: noise makes it negative.
    [[nodiscard]] constexpr int16_t sinkage_q4_mm() const {
        return native(cell(sinkage_, Layout::kFront));
    }
    /// Cost of the last match, in units of map_paper_tables.hpp.
    [[nodiscard]] constexpr uint32_t least_cost() const { return native(least_cost_); }
    /// Last candidate that the next cycle looks at; [0, kLimit].
    [[nodiscard]] constexpr uint16_t search_last() const {
        return min(Layout::kLimit, add_wrap(search_last_, search_more_));
    }
    /// Ground height at a bin above the load-bearing surface under the rear wheel, s16 Q4 mm.
    /// @param bin  [0, kFarAhead]; beyond it the last bin
    [[nodiscard]] constexpr int16_t ground_q4_mm(uint16_t bin) const {
        return native(sub_wrap(cell(ground_, min(bin, Layout::kFarAhead)), surface(0)));
    }
    /// The load-bearing surface at a bin above that under the rear wheel, s16 Q4 mm.
    /// @param bin  [0, kFront]; beyond it the last bin
    [[nodiscard]] constexpr int16_t surface_q4_mm(uint16_t bin) const {
        return native(sub_wrap(surface(min(bin, Layout::kFront)), surface(0)));
    }

private:
    using GroundRing = Ring<S16, map_paper_ring_size(Layout::kFarAhead + 1u)>;
    using SinkageRing = Ring<S16, map_paper_ring_size(Layout::kFront + 1u)>;

    template <class R>
    static constexpr auto index(uint16_t bin) {
        using Native = decltype(native(typename R::Index{}));
        return typename R::Index{convert_wrap<Native>(bin)};
    }
    template <class R>
    static constexpr S16& cell(R& ring, uint16_t bin) {
        return ring.at(index<R>(bin));
    }
    template <class R>
    static constexpr const S16& cell(const R& ring, uint16_t bin) {
        return ring.at(index<R>(bin));
    }

    [[nodiscard]] constexpr S16 surface(uint16_t bin) const {
        return sub_wrap(cell(ground_, bin), cell(sinkage_, bin));
    }

    /// Weighted sum of squares of a candidate: middle wheel and prior.
    [[nodiscard]] constexpr U32 cost(uint16_t bin, S16 middle_q4_mm) const {
        const uint16_t middle_bin = add_wrap(Layout::kMiddle, bin);
        const S16 expected_q4_mm = sub_wrap(surface(middle_bin), surface(bin));
        const S16 residual_q4_mm = sub_wrap(middle_q4_mm, expected_q4_mm);
        return add_sat(map_paper_height_cost(residual_q4_mm), prior_cost_[bin]);
    }

    /// @return  u16 Q8 bins, [0, 256 kLimit + 128]
    constexpr uint16_t find_advance_q8(S16 middle_q4_mm) {
        U32 costs[Layout::kLimit + 1u];
        const uint16_t last = search_last();
        uint16_t best = 0;
        for (uint16_t bin = 0; bin <= last; ++bin) {
            costs[bin] = cost(bin, middle_q4_mm);
            if (costs[bin] < costs[best]) best = bin;
        }
        least_cost_ = costs[best];
        extend_search(costs, best, last);
        const uint16_t whole_q8 = shift_left_wrap<8>(best);
        // No candidate lies behind bin 0, so nothing bounds a minimum there.
        if (best == 0 || best == Layout::kLimit) return whole_q8;
        const uint16_t next = add_wrap(best, uint16_t{1});
        const U32 right = best == last ? cost(next, middle_q4_mm) : costs[next];
        if (right < costs[best]) return whole_q8;
        const S16 offset_q8 = map_paper_parabola_q8(costs[best - 1u], costs[best], right);
        return add_wrap(whole_q8, narrow_wrap_u16(native(offset_q8)));
    }

    /// Secondary-minimum rule: a minimum beyond the best one and within a factor of three of it
    /// widens the next search by their distance.
    constexpr void extend_search(const U32 (&costs)[Layout::kLimit + 1u], uint16_t best,
                                 uint16_t last) {
        const U32 worst_allowed = add_sat(costs[best], add_sat(costs[best], costs[best]));
        uint16_t second = best;
        for (uint16_t bin = add_wrap(best, uint16_t{1}); bin <= last; ++bin) {
            const bool falls = costs[bin] < costs[bin - 1u];
            const bool rises = bin == last || !(costs[bin + 1u] < costs[bin]);
            if (!falls || !rises) continue;
            if (second == best || costs[bin] < costs[second]) second = bin;
        }
        const bool promising = second != best && !(worst_allowed < costs[second]);
        search_more_ = promising ? sub_wrap(second, best) : uint16_t{0};
    }

    /// Moves the origin of one histogram by advance_q8, linear between bins, and continues it with
    /// a straight line from its old end to `measured` at its new end, kEnd.
    template <uint16_t kEnd, class R>
    static constexpr S16 resample(R& ring, uint16_t advance_q8) {
        const uint16_t whole = shift_floor<8>(advance_q8);
        const U8 fraction_q8{narrow_wrap_u8(advance_q8)};
        const S16 old_end = cell(ring, kEnd);
        ring.advance(index<R>(whole));
        const uint16_t known = sub_wrap(kEnd, whole);
        for (uint16_t bin = 0; bin < known; ++bin) {
            const uint16_t next = add_wrap(bin, uint16_t{1});
            cell(ring, bin) = lerp_q8(cell(ring, bin), cell(ring, next), fraction_q8);
        }
        return old_end;
    }
    template <uint16_t kEnd, class R>
    static constexpr void extend(R& ring, uint16_t advance_q8, S16 old_end, S16 measured) {
        cell(ring, kEnd) = measured;
        const S32 whole_way_q8{static_cast<int32_t>(advance_q8)};
        const S16 rise = sub_wrap(measured, old_end);
        U16 along_q8{widen_u16(narrow_wrap_u8(advance_q8))};
        for (uint16_t bin = sub_wrap(kEnd, shift_floor<8>(advance_q8)); bin < kEnd; ++bin) {
            const S32 part = div_round_half_up(mul_wide(rise, along_q8), whole_way_q8);
            cell(ring, bin) = add_wrap(old_end, narrow_wrap_s16(part));
            along_q8 = add_wrap(along_q8, U16{256});
        }
    }

    constexpr void translate(uint16_t advance_q8, const MapPaperHeights& heights) {
        const S16 ground_end = resample<Layout::kFarAhead>(ground_, advance_q8);
        const S16 sinkage_end = resample<Layout::kFront>(sinkage_, advance_q8);
        rear_q4_mm_ = surface(0);
        const S16 far_q4_mm = add_wrap(S16{heights.far_ahead_q4_mm}, rear_q4_mm_);
        extend<Layout::kFarAhead>(ground_, advance_q8, ground_end, far_q4_mm);
        const S16 front_q4_mm = add_wrap(S16{heights.front_q4_mm}, rear_q4_mm_);
        const S16 sunk_q4_mm = sub_wrap(cell(ground_, Layout::kFront), front_q4_mm);
        extend<Layout::kFront>(sinkage_, advance_q8, sinkage_end, sunk_q4_mm);
    }

    template <class R>
    static constexpr void force(R& ring, uint16_t bin, S16 value) {
        cell(ring, bin) = value;
        S16& before = cell(ring, sub_wrap(bin, uint16_t{1}));
        S16& after = cell(ring, add_wrap(bin, uint16_t{1}));
        before = add_wrap(value, halve_floor(sub_wrap(before, value)));
        after = add_wrap(value, halve_floor(sub_wrap(after, value)));
    }

    /// The 60 cm sample sets the ground, the middle wheel the sinkage; their neighbours go halfway.
    constexpr void split_the_difference(const MapPaperHeights& heights) {
        force(ground_, Layout::kNearAhead, add_wrap(S16{heights.near_ahead_q4_mm}, rear_q4_mm_));
        const S16 middle_q4_mm = add_wrap(S16{heights.middle_q4_mm}, rear_q4_mm_);
        force(sinkage_, Layout::kMiddle, sub_wrap(cell(ground_, Layout::kMiddle), middle_q4_mm));
    }

    GroundRing ground_;
    SinkageRing sinkage_;
    U32 prior_cost_[Layout::kLimit + 1u] = {};
    U32 least_cost_{0};
    S16 rear_q4_mm_{0};
    uint16_t search_last_ = 0;
    uint16_t search_more_ = 0;
};

}  // namespace rover
