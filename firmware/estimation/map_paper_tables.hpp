// map_paper_tables.hpp - the paper's cost terms as look-ups: exact squares and the prior table.
// Source       Wilcox 1994, "Computational Requirements": squaring by table look-up, prior in a
// table. Unit         all costs are u32 in quarters of a squared height step (1/16 mm). Divided by
//              kCostPerSigmaSquared they are squares of the wheel noise, 0.04 mm.
// Depends on   firmware/core/arith.hpp, rover_words.hpp.
// Bounds       512 bytes of constants; at most three look-ups per square, no multiplication.
// Tests        tests/firmware/estimation/map_paper_tables_test.cpp
#pragma once

#include "firmware/core/arith.hpp"
#include "rover_words.hpp"

namespace rover {

/// Cost that stands for one squared sigma of the wheel noise: 4 * (0.04 mm * 16 / mm)^2 = 1.6384.
inline constexpr uint16_t kMapPaperCostPerSigmaSquaredQ14 = 26844;
inline constexpr uint8_t kMapPaperCostShift = 2;

struct MapPaperSquares {
    uint16_t square[256] = {};
    constexpr MapPaperSquares() {
        for (uint16_t root = 0; root < 256; ++root) square[root] = mul_wrap(root, root);
    }
};
inline constexpr MapPaperSquares kMapPaperSquares{};
static_assert(kMapPaperSquares.square[255] == 65025);

/// size^2, exact for every u16. With size = 256 h + l the mixed product comes from
/// 2 h l = h^2 + l^2 - (h - l)^2, so that 256 entries suffice.
constexpr U32 map_paper_square(U16 size) {
    const U8 low = narrow_wrap_u8(size);
    const U8 high = narrow_wrap_u8(shift_floor<8>(size));
    const U32 low_square = widen_u32(U16{look_up(kMapPaperSquares.square, low)});
    if (high == U8{0}) return low_square;
    const U8 apart = high > low ? sub_wrap(high, low) : sub_wrap(low, high);
    const U32 high_square = widen_u32(U16{look_up(kMapPaperSquares.square, high)});
    const U32 apart_square = widen_u32(U16{look_up(kMapPaperSquares.square, apart)});
    const U32 mixed = sub_wrap(add_wrap(high_square, low_square), apart_square);  // 2 h l
    return add_wrap(add_wrap(shift_left_wrap<16>(high_square), shift_left_wrap<8>(mixed)),
                    low_square);
}

/// Cost of a height residual. @param residual_q4_mm  s16 Q4 mm, any
/// @return  4 residual^2; saturates only at -2048 mm
constexpr U32 map_paper_height_cost(S16 residual_q4_mm) {
    return shift_left_sat<kMapPaperCostShift>(map_paper_square(abs_u16(residual_q4_mm)));
}

/// What the vehicle is expected to do in one cycle.
struct MapPaperPrior {
    uint16_t mean_q4_mm = 960;   ///< u16 Q4 mm, 60 mm; [0, 8192]
    uint16_t sigma_q8_mm = 128;  ///< u16 Q8 mm, 0.5 mm; 0 means no advance but the mean is possible
};

/// Cost of an advance: the squared distance to the prior mean, in wheel-noise units.
/// @param advance_q4_mm  u16 Q4 mm, [0, 8192]
/// @rounding  the distance in sigmas is rounded to 1/16 step before it is squared: the error of
///            the cost is below sqrt(cost)/16 + 1; a distance of 4096 steps and more saturates
constexpr U32 map_paper_prior_cost(U16 advance_q4_mm, const MapPaperPrior& prior) {
    const U16 mean_q4_mm{prior.mean_q4_mm};
    const U16 apart_q4_mm = advance_q4_mm > mean_q4_mm ? sub_wrap(advance_q4_mm, mean_q4_mm)
                                                       : sub_wrap(mean_q4_mm, advance_q4_mm);
    // 2 * 0.64 steps / (sigma_q8_mm / 16 steps) * 16 = 327.68 / sigma_q8_mm = 2^13 / (25 sigma).
    const U32 dividend = shift_left_sat<13>(widen_u32(apart_q4_mm));
    const U32 divisor = mul_wide(U16{prior.sigma_q8_mm}, U16{25});
    const U16 root_q4 = narrow_sat_u16(div_round_half_up(dividend, divisor));
    return shift_round_half_up<8>(map_paper_square(root_q4));
}

}  // namespace rover
