// map_paper_test.cpp - the integer estimator against closed forms and against its own promises.
#include "firmware/estimation/map_paper.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <random>

namespace {

using rover::MapPaper;
using rover::MapPaperHeights;
using rover::MapPaperPrior;

constexpr double kWheelSigmaMm = 0.04;

template <std::uint8_t kBin>
struct KnownGround {
    using Layout = rover::MapPaperLayout<kBin>;
    std::int16_t ground[Layout::kFarAhead + 1u] = {};
    std::int16_t sinkage[Layout::kFront + 1u] = {};
};

TEST(MapPaperParabola, MatchesTheExactPlaceWithin0p55Of256th) {
    constexpr std::uint64_t kSeed = 20261122;
    std::mt19937_64 random(kSeed);
    for (int i = 0; i < 200000; ++i) {
        const auto bits = static_cast<unsigned>(random() % 32);
        const auto middle = static_cast<std::uint32_t>(random()) >> 1;
        const auto left_rise = static_cast<std::uint32_t>(random()) >> 1 >> bits;
        const auto right_rise = static_cast<std::uint32_t>(random()) >> 1 >> (random() % 32);
        if (left_rise + right_rise == 0) continue;
        const double exact = 128.0 * (static_cast<double>(left_rise) - right_rise) /
                             (static_cast<double>(left_rise) + right_rise);
        const int offset =
            rover::map_paper_parabola_q8(middle + left_rise, middle, middle + right_rise);
        ASSERT_NEAR(offset, exact, 0.55) << left_rise << " " << right_rise << " seed " << kSeed;
    }
}

TEST(MapPaperParabola, EqualValuesGiveTheMiddleAndExtremesGiveHalf) {
    EXPECT_EQ(rover::map_paper_parabola_q8(7, 7, 7), 0);
    EXPECT_EQ(rover::map_paper_parabola_q8(9, 7, 7), 128);
    EXPECT_EQ(rover::map_paper_parabola_q8(7, 7, 9), -128);
    EXPECT_EQ(rover::map_paper_parabola_q8(0xFFFFFFFF, 0, 0), 128);
}

TEST(MapPaper, LevelGroundGivesThePriorMean) {
    const KnownGround<10> known;
    for (const unsigned mean : {500u, 800u, 960u, 1300u}) {
        const auto mean_q4_mm = static_cast<std::uint16_t>(mean);
        MapPaper<10> estimator;
        estimator.reset(known.ground, known.sinkage, {.mean_q4_mm = mean_q4_mm});
        // The parabola through the prior's own costs is exact up to their rounding.
        for (int i = 0; i < 50; ++i) EXPECT_NEAR(estimator.step({}), mean_q4_mm, 6);
    }
}

// On ground y = a x^2 the middle wheel's height is linear in the advance, so that the weighted sum
// of squares is a parabola and the answer has a closed form, floor(25 cm / bin) included.
template <std::uint8_t kBin>
void check_quadratic_ground(double advance_mm) {
    constexpr double kCurvaturePerMm = 1e-4;
    constexpr double kBinMm = 2.5 * kBin;
    constexpr double kPriorMm = 60, kPriorSigmaMm = 2;
    const auto height_mm = [](double x_mm) { return kCurvaturePerMm * x_mm * x_mm; };
    const auto q4 = [](double mm) { return static_cast<std::int16_t>(std::lround(16 * mm)); };
    KnownGround<kBin> known;
    using Layout = typename KnownGround<kBin>::Layout;
    for (std::uint16_t bin = 0; bin <= Layout::kFarAhead; ++bin) {
        known.ground[bin] = q4(height_mm(bin * kBinMm));
    }
    MapPaper<kBin> estimator;
    estimator.reset(known.ground, known.sinkage, MapPaperPrior{960, 512});
    const double middle_mm = height_mm(advance_mm + 250) - height_mm(advance_mm);
    const double arm_mm = std::floor(250 / kBinMm) * kBinMm;
    // middle - a (2 arm x + arm^2) = 0 at x = match; weight of the match per mm^2, then the mean.
    const double match_mm = (middle_mm / kCurvaturePerMm - arm_mm * arm_mm) / (2 * arm_mm);
    const double slope = 2 * kCurvaturePerMm * arm_mm;
    const double match_weight = slope * slope / (kWheelSigmaMm * kWheelSigmaMm);
    const double prior_weight = 1 / (kPriorSigmaMm * kPriorSigmaMm);
    const double exact_mm =
        (match_weight * match_mm + prior_weight * kPriorMm) / (match_weight + prior_weight);
    // Heights rounded to 1/16 mm: four of them make a residual, and the slope turns it into mm.
    const double bound_mm = 2.0 / 16 / slope + kBinMm / 256;
    const double estimate_mm = estimator.step({.middle_q4_mm = q4(middle_mm)}) / 16.0;
    EXPECT_NEAR(estimate_mm, exact_mm, bound_mm) << "bin " << kBinMm << " mm";
}

TEST(MapPaper, FirstAdvanceOnQuadraticGroundIsTheClosedFormMapEstimate) {
    for (const double advance_mm : {30.0, 42.0, 50.0, 55.5, 70.0}) {
        check_quadratic_ground<4>(advance_mm);
        check_quadratic_ground<8>(advance_mm);
        check_quadratic_ground<10>(advance_mm);
        check_quadratic_ground<12>(advance_mm);
        check_quadratic_ground<16>(advance_mm);
    }
}

TEST(MapPaper, SinkageIsTheGroundAtTheFrontWheelMinusItsHeight) {
    const KnownGround<10> known;
    MapPaper<10> estimator;
    estimator.reset(known.ground, known.sinkage, {});
    estimator.step({.front_q4_mm = -80});
    EXPECT_EQ(estimator.sinkage_q4_mm(), 80);
    estimator.step({.front_q4_mm = 33});
    EXPECT_EQ(estimator.sinkage_q4_mm(), -33);
}

TEST(MapPaper, MinimumAtBinZeroIsExactlyNoAdvance) {
    const KnownGround<32> known;
    MapPaper<32> estimator;
    estimator.reset(known.ground, known.sinkage, {.mean_q4_mm = 600});  // 8 cm bins, 3.75 cm prior
    EXPECT_EQ(estimator.step({}), 0);
}

TEST(MapPaper, ForcedBinsTakeTheMeasurementAndTheirNeighboursGoHalfway) {
    const KnownGround<10> known;
    MapPaper<10> estimator;
    estimator.reset(known.ground, known.sinkage, {});
    estimator.step({.middle_q4_mm = 0, .near_ahead_q4_mm = 64});
    EXPECT_EQ(estimator.ground_q4_mm(24), 64);
    EXPECT_EQ(estimator.ground_q4_mm(23), 32);
    EXPECT_EQ(estimator.ground_q4_mm(25), 32);
    EXPECT_EQ(estimator.ground_q4_mm(22), 0);
    EXPECT_EQ(estimator.ground_q4_mm(26), 0);
}

TEST(MapPaper, MiddleWheelSetsTheSurfaceAndItsNeighboursGoHalfway) {
    const KnownGround<10> known;
    MapPaper<10> estimator;
    estimator.reset(known.ground, known.sinkage, {.mean_q4_mm = 800, .sigma_q8_mm = 26});
    estimator.step({.middle_q4_mm = 4});
    EXPECT_EQ(estimator.surface_q4_mm(10), 4);
    EXPECT_EQ(estimator.surface_q4_mm(9), 2);
    EXPECT_EQ(estimator.surface_q4_mm(11), 2);
    EXPECT_EQ(estimator.surface_q4_mm(8), 0);
}

TEST(MapPaper, SecondaryMinimumBeyondTheBestWidensTheNextSearchOnce) {
    // Two equal bumps, 4 and 8 cm ahead of the middle wheel: its height fits both, and the prior
    // mean of 6 cm lies between them. The nearer one wins, the other one is 4 bins beyond it.
    KnownGround<4> known;  // 1 cm bins: the search ends at bin 14, the histogram allows 20
    known.ground[29] = 160;
    known.ground[33] = 160;
    MapPaper<4> estimator;
    estimator.reset(known.ground, known.sinkage, {.mean_q4_mm = 960, .sigma_q8_mm = 5120});
    ASSERT_EQ(estimator.search_last(), 14);
    EXPECT_NEAR(estimator.step({.middle_q4_mm = 160}), 640, 2);
    EXPECT_EQ(estimator.search_last(), 18);
    estimator.step({});
    EXPECT_EQ(estimator.search_last(), 14);
}

TEST(MapPaper, HeightsCountAsDifferencesOnly) {
    constexpr std::uint64_t kSeed = 7;
    std::mt19937_64 random(kSeed);
    KnownGround<10> low;
    KnownGround<10> high;
    for (std::uint16_t bin = 0; bin <= 32; ++bin) {
        low.ground[bin] = static_cast<std::int16_t>(random() % 200);
        high.ground[bin] = static_cast<std::int16_t>(low.ground[bin] + 32600);  // wraps within
    }
    MapPaper<10> one;
    MapPaper<10> other;
    one.reset(low.ground, low.sinkage, {});
    other.reset(high.ground, high.sinkage, {});
    for (int i = 0; i < 500; ++i) {
        const auto height = [&] { return static_cast<std::int16_t>(random() % 400); };
        const MapPaperHeights heights{height(), height(), height(), height()};
        ASSERT_EQ(one.step(heights), other.step(heights)) << "cycle " << i << " seed " << kSeed;
        ASSERT_EQ(one.sinkage_q4_mm(), other.sinkage_q4_mm());
    }
}

TEST(MapPaper, StateAt25CentimetresIs244Bytes) {
    EXPECT_EQ(sizeof(MapPaper<10>), 244u);
}

// Any inputs at all. The sanitizer build of this test sees an index out of range.
template <std::uint8_t kBin>
void check_any_sequence(std::uint64_t seed) {
    std::mt19937_64 random(seed);
    const auto any = [&] { return static_cast<std::int16_t>(random()); };
    KnownGround<kBin> known;
    using Layout = typename KnownGround<kBin>::Layout;
    for (auto& height : known.ground) height = any();
    for (auto& depth : known.sinkage) depth = any();
    MapPaper<kBin> estimator;
    const MapPaperPrior prior{static_cast<std::uint16_t>(random()),
                              static_cast<std::uint16_t>(random())};
    estimator.reset(known.ground, known.sinkage, prior);
    const auto longest_q4_mm = static_cast<unsigned>((Layout::kLimit + 0.5) * Layout::kBinQ4Mm);
    for (int i = 0; i < 300; ++i) {
        const auto shift = static_cast<int>(random() % 16);
        const auto height = [&] { return static_cast<std::int16_t>(any() >> shift); };
        ASSERT_LE(estimator.step({height(), height(), height(), height()}), longest_q4_mm)
            << "bin " << int{kBin} << " seed " << seed << " cycle " << i;
        ASSERT_LE(estimator.search_last(), Layout::kLimit) << "seed " << seed;
    }
}

TEST(MapPaper, AnySequenceOfInputsLeavesADefinedStateAndABoundedAdvance) {
    for (std::uint64_t seed = 1; seed <= 40; ++seed) {
        check_any_sequence<1>(seed);
        check_any_sequence<3>(seed);
        check_any_sequence<10>(seed);
        check_any_sequence<13>(seed);
        check_any_sequence<26>(seed);
        check_any_sequence<30>(seed);
        check_any_sequence<32>(seed);
    }
}

}  // namespace
