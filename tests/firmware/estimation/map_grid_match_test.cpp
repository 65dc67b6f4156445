// map_grid_match_test.cpp - cost, minimum, parabola and learned mean against double computation.
#include "firmware/estimation/map_grid_match.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <iterator>
#include <random>

namespace {

using namespace rover;
using namespace rover::slip;

constexpr double kPi = 3.14159265358979;

double hills_mm(double bin) {
    return 30 * std::sin(bin * kPi / 7) + 11 * std::sin(bin * 1.7 + 1);
}
double linear_mm(double bin) {
    const double node = std::floor(bin);
    return hills_mm(node) + (hills_mm(node + 1) - hills_mm(node)) * (bin - node);
}

/// On known hills; the rear wheel really stands `advance` bins further on than the estimator knows.
struct Scene {
    MapGrid map;
    MapGridInput input;
    Scene(double start, double advance) {
        for (int node = 0; node < kNodeCount; ++node) {
            map.surface_q4_mm[node] = static_cast<S16>(std::lround(16 * hills_mm(node)));
        }
        map.has_map = map.measured = true;
        map.front_place_q6_bin = 31 * 64;
        map.place_q6_bin = static_cast<U16>(std::lround(start * 64));
        map.mode = SlipMode::tracking;
        input.linkage = true;
        input.odometer_q6_bin = 154;
        const double rear = start + advance;
        input.middle_height_q4_mm =
            static_cast<S16>(std::lround(16 * (linear_mm(rear + 10) - linear_mm(rear))));
    }
};

TEST(SquareTable, IsTheSquareOfTheMiddleOfAStepWithinHalfOf1SixteenthUpTo5p6Sigma) {
    for (int i = 0; i < 256; ++i) {
        const double sigmas = (i - 127.5) / 8;
        EXPECT_NEAR(square_q3(static_cast<U8>(i)) / 8.0, std::min(255 / 8.0, sigmas * sigmas),
                    0.5 / 8);
    }
}

// 16 mm halved 0 to 7 times; 1.04 sigma is what squares of a rounded exponent have on average. The
// cost is known in quarters and the limit in 1/31 at worst: 3 % + 12 % at cost 1.5.
TEST(ResidualSigma, SigmaIsAQuarterOfTheRoughnessWidenedWithin61Percent) {
    MapGrid map;
    double worst = 0;
    for (uint16_t rough = 103; rough < 16000; rough = static_cast<uint16_t>(rough + 37)) {
        map.rough_q8_mm = rough;
        for (const double cost : {0.0, 1.0, 1.6, 2.1, 3.1, 4.0}) {
            map.match_cost_q10 = static_cast<U16>(cost * 1024);
            const double widen = std::min(3.0, std::max(1.0, 0.7 * cost));
            const double wanted_mm = std::max(1.04 * rough / 256.0 / 4 * widen, 0.125);
            if (wanted_mm > 16) continue;
            const double sigma_mm = residual_sigma_q3_mm(map) / 8.0;
            worst = std::max(worst, std::abs(std::log2(sigma_mm / wanted_mm)));
        }
    }
    EXPECT_LE(worst, 0.5 + std::log2(1.15));
}

TEST(ResidualSigma, IsAnOctaveForEveryRoughnessAndCost) {
    MapGrid map;
    for (int rough = 0; rough <= kRoughMaxQ8Mm; ++rough) {
        map.rough_q8_mm = static_cast<U16>(rough);
        for (int cost = 0; cost <= kReacquireCostQ10; cost += 256) {
            map.match_cost_q10 = static_cast<U16>(cost);
            ASSERT_TRUE(std::has_single_bit(native(residual_sigma_q3_mm(map))));
        }
    }
    map.rough_q8_mm = kRoughMaxQ8Mm;
    EXPECT_EQ(residual_sigma_q3_mm(map), 128);
}

/// The middle wheel's misfit in mm with the rear wheel on a node of the hills.
double misfit_mm(const Scene& scene, int node, double distance_bin = 10) {
    return scene.input.middle_height_q4_mm / 16.0 -
           (linear_mm(node + distance_bin) - hills_mm(node));
}

// Heights are rounded to 1/16 mm (three of them, and half of one for the fraction); indices are
// rounded down, so those of the middle of a step are half a step off at most, and so are means.
TEST(FindMisfits, AreThoseOfTheHillsInEighthsOfSigmaAndMeansInBetween) {
    for (const int distance_q6 : {640, 624, 611, 592}) {
        Scene scene(0.25, 2);
        scene.map.rough_q8_mm = 20 * 256;  // sigma 4 mm
        scene.input.middle_distance_q6_bin = static_cast<U16>(distance_q6);
        const double distance_bin = std::floor(distance_q6 / 4.0 + 0.5) / 16;  // 1/16 bin
        const double step_mm = residual_sigma_q3_mm(scene.map) / 64.0;
        EXPECT_EQ(step_mm, 0.5);
        Match match;
        find_misfits(scene.map, scene.input, U8{2}, match);
        for (int i = 0; i < kHalfBinCandidates; ++i) {
            const double here = misfit_mm(scene, 2 + i / 2, distance_bin);
            const double next = misfit_mm(scene, 3 + i / 2, distance_bin);
            const double wanted = (i % 2 == 0 ? here : (here + next) / 2) / step_mm;
            ASSERT_LT(std::abs(wanted), 127) << "the scene is meant to stay below saturation";
            const double tolerance = 0.5 + (i % 2 == 0 ? 0 : 0.75) + 3.5 / 32 / step_mm;
            EXPECT_NEAR(match.steps[i + 1] - 127.5, wanted, tolerance) << distance_q6 << " " << i;
        }
    }
}

TEST(FindMisfits, SaturateWithTheirSign) {
    for (const int height_mm : {-120, 120}) {
        Scene scene(0, 2);
        scene.map.rough_q8_mm = 256;  // sigma 0.25 mm
        scene.input.middle_height_q4_mm = static_cast<S16>(height_mm * 16);
        Match match;
        find_misfits(scene.map, scene.input, U8{2}, match);
        for (int i = 0; i < kHalfBinCandidates; ++i) {
            EXPECT_EQ(match.steps[i + 1], height_mm > 0 ? 255 : 0) << i;
        }
    }
}

/// Costs in squared sigmas that find_minimum must see: misfit as given, prior from the offset.
double cost_of(U8 steps, int candidate, int off_q6_bin) {
    const double fit = (steps - 127.5) / 8;
    const double prior = candidate - 4 + off_q6_bin / 32.0;
    return std::min(32.0, std::min(32.0, fit * fit) + prior * prior);
}

// The prior: half of 1/8 from its offset in half units times four half bins, 1/8 from the vertex;
// the entry half of 1/8.
TEST(FindMinimum, CostsAreMisfitAndPriorInSquaredSigmasWithinAHalf) {
    std::mt19937 random(20260106);
    for (int trial = 0; trial < 20000; ++trial) {
        Match match;
        U8 steps[kHalfBinCandidates + 1];
        for (U8& step : steps) step = static_cast<U8>(random() % 120 + 68);
        std::copy(std::begin(steps), std::end(steps), std::begin(match.steps));
        const int off = static_cast<int>(random() % 64) - 31;
        const auto first = static_cast<uint8_t>(random() % 3 * 2);
        find_minimum(first, static_cast<S8>(off), match);
        ASSERT_GE(match.best, first);
        for (int i = first; i < kHalfBinCandidates; ++i) {
            ASSERT_NEAR(match.steps[i + 1] / 8.0, cost_of(steps[i + 1], i, off), 0.5)
                << i << " off " << off;
            ASSERT_GE(match.steps[i + 1], match.least_q3 + (i < match.best ? 1 : 0));
        }
        ASSERT_EQ(match.steps[match.best + 1], match.least_q3);
        if (match.least_q3 < 255) {
            ASSERT_EQ(match.fit_q3, square_q3(steps[match.best + 1]));
        }
    }
}

TEST(FindMinimum, WhereNothingFitsIsTheFirstCandidateThatDoesNotFit) {
    Match match;
    for (U8& step : match.steps) step = 255;
    find_minimum(2, 5, match);
    EXPECT_EQ(match.best, 2);
    EXPECT_EQ(match.fit_q3, 255);
    EXPECT_EQ(match.least_q3, 255);
}

// Around a least cost, 16 (before - after) / (before - 2 least + after) in 1/64 bin, rounded; the
// variance is 2^14 / bend: 1024 is the prior's, whose bend is 2 squared sigmas or 16. It is looked
// up by sixteenths of the bend.
TEST(FitParabola, IsTheMinimumOfTheParabolaRoundedHalfAway) {
    for (int least = 0; least <= 100; least += 25) {
        for (int before = least; before < 256; ++before) {
            for (int after = least; after < 256; ++after) {
                const double bend = before + after - 2 * least;
                if (bend == 0) continue;
                Parabola found;
                fit_parabola(static_cast<U8>(before), static_cast<U8>(least),
                             static_cast<U8>(after), found);
                ASSERT_EQ(found.offset_q6_bin, std::lround(16.0 * (before - after) / bend));
                const double variance = 16384 / bend;
                if (bend < 19) {  // 0.85 of the prior's variance or more
                    ASSERT_EQ(found.variance_q12, kPriorVarianceQ12);
                } else {
                    ASSERT_NEAR(found.variance_q12, variance, variance / 3) << bend;
                }
            }
        }
    }
}

TEST(FitParabola, ThreeEqualCostsSayNothing) {
    Parabola found;
    fit_parabola(U8{70}, U8{70}, U8{70}, found);
    EXPECT_EQ(found.offset_q6_bin, 0);
    EXPECT_EQ(found.variance_q12, kPriorVarianceQ12);
}

// Two steps a cycle cannot follow at the start: 32 sqrt(n) against 16 n, 16 too little at most.
TEST(AddVariance, TheSpreadIsTheRootLessOneStepAfterFourCycles) {
    MapGrid map;
    const uint16_t steps[] = {1024, 1, 0, 997, 512, 1023};
    uint64_t sum = 0;
    for (int i = 0; i < 20000; ++i) {
        const uint16_t step = steps[i % 6];
        add_variance(map, step);
        sum += step;
        ASSERT_EQ(map.variance_q12, sum);
        const double root = std::sqrt(static_cast<double>(sum));
        if (map.spread_q6_bin == kSpreadMaxQ6Bin) break;
        ASSERT_LE(map.spread_q6_bin, root);
        ASSERT_GT(map.spread_q6_bin, root - (i < 4 ? 16.5 : 8)) << i;
    }
}

TEST(AddVariance, TheSpreadEndsAt1p6Metres) {
    MapGrid map;
    for (int i = 0; i < 20000; ++i) add_variance(map, 1024);
    EXPECT_EQ(map.spread_q6_bin, kSpreadMaxQ6Bin);
    EXPECT_EQ(map.variance_q12, 20000u * 1024u);
}

TEST(MatchAdvance, FindsTheTrueAdvanceWithinAQuarterBinInThreeCasesOfFour) {
    int near = 0;
    int count = 0;
    for (double start = 0; start < 4; start += 0.13) {
        for (double advance = 0.8; advance <= 3.2; advance += 0.3) {
            Scene scene(start, advance);
            scene.map.mean_q12_bin = 8192;  // expects 2 bins
            const double found = match_advance(scene.map, scene.input) / 64.0;
            ++count;
            if (std::abs(found - advance) < 0.25) ++near;
        }
    }
    // In the rest the hills are level or look alike within the search, and the prior decides.
    EXPECT_GE(near, count * 3 / 4) << "of " << count;
}

TEST(MatchAdvance, IsNeverNegativeNorBeyondTheSearch) {
    for (int height = -32768; height <= 32767; height += 499) {
        for (double start = 0; start < 2; start += 0.19) {
            Scene scene(start, 2);
            scene.input.middle_height_q4_mm = static_cast<S16>(height);
            const S16 advance = match_advance(scene.map, scene.input);
            ASSERT_GE(advance, 0);
            ASSERT_LE(advance, kReachQ6Bin + kBeyondQ6Bin);
        }
    }
}

TEST(MatchAdvance, AnEdgeThatDoesNotFitIsNotBelieved) {
    Scene scene(0, 2);
    for (int node = 0; node < kNodeCount; ++node) {  // a bowl: the best fit is the far edge
        scene.map.surface_q4_mm[node] = static_cast<S16>(node * node * 4);
    }
    scene.map.rough_q8_mm = 256;
    scene.map.mean_q12_bin = 8192;
    scene.input.middle_height_q4_mm = 32000;
    const double expected_q6 = 2 * 64 + (154 - 153.6);  // the learned mean, and the odd odometer
    EXPECT_NEAR(match_advance(scene.map, scene.input), expected_q6, 1);
}

TEST(MatchAdvance, LevelGroundGivesTheLearnedMean) {
    S16 flat[kKnownNodes] = {};
    for (double mean_cm = 1; mean_cm <= 6; mean_cm += 0.25) {
        MapGrid map;
        start_on_known_ground(map, flat);
        map.front_place_q6_bin = 31 * 64;
        map.mean_q12_bin = static_cast<S16>(std::lround(mean_cm / 2.5 * 4096));
        MapGridInput input;
        input.linkage = true;
        input.odometer_q6_bin = 154;
        const double expected = mean_cm / 2.5 * 64 + 0.4;
        EXPECT_NEAR(match_advance(map, input), expected, 1.5) << mean_cm;
        EXPECT_EQ(map.added_variance_q12, kPriorVarianceQ12);  // the ground said nothing
        EXPECT_GT(map.drift_q12_bin, 0u);
    }
}

TEST(LearnAdvance, FollowsTheDoubleScheduleWithin0p05Millimetre) {
    MapGrid map;
    double mean_cm = 6;
    int learned = 0;
    for (int i = 0; i < 300; ++i) {
        const S16 advance = static_cast<S16>(120 + 60 * std::sin(i * 0.37));
        learn_advance(map, advance);
        const double gain = std::max(1.0 / 32, 1.0 / (learned + 8));
        if (learned < 24) ++learned;
        mean_cm += (advance * 2.5 / 64 - mean_cm) * gain;
        mean_cm = std::min(6.0, std::max(1.0, mean_cm));
        // Gains are multiples of 1/256: up to 6 % off between, the mean of a sine of 2.3 cm.
        ASSERT_NEAR(map.mean_q12_bin * 2.5 / 4096, mean_cm, 0.05) << i;
    }
}

TEST(LearnAdvance, StaysBetweenOneAndSixCentimetres) {
    MapGrid map;
    for (int i = 0; i < 500; ++i) learn_advance(map, 0);
    EXPECT_EQ(map.mean_q12_bin, kMeanMinQ12Bin);
    for (int i = 0; i < 500; ++i) learn_advance(map, 287);
    EXPECT_EQ(map.mean_q12_bin, kMeanNoSlipQ12Bin);
}

TEST(JudgeMatch, DeclaresLossOnceAndLockAfterTheCostHasFallen) {
    MapGrid map;
    map.mode = SlipMode::tracking;
    map.mean_q12_bin = 4096;
    int losses = 0;
    for (int i = 0; i < 10; ++i) {
        map.lost_lock = false;
        judge_match(map, 255);
        losses += map.lost_lock ? 1 : 0;
    }
    EXPECT_EQ(losses, 1);
    EXPECT_EQ(map.mode, SlipMode::reacquiring);
    EXPECT_EQ(map.mean_q12_bin, kMeanReacquireQ12Bin);
    EXPECT_EQ(map.drift_q12_bin, kDriftPerLossQ12Bin);
    for (int i = 0; i < 30; ++i) judge_match(map, 0);
    EXPECT_EQ(map.mode, SlipMode::tracking);
}

TEST(JudgeMatch, OneCycleCountsForSixteenAtMost) {
    MapGrid map;
    map.match_cost_q10 = 1024;
    judge_match(map, 255);
    // 1 + (16 - 1)/8; the gain is 32/256 exactly.
    EXPECT_EQ(map.match_cost_q10, 1024 + 15 * 128);
}

}  // namespace
