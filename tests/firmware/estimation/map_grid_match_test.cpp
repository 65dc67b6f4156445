// map_grid_match_test.cpp - cost, minimum, parabola and learned mean against double computation.
#include "firmware/estimation/map_grid_match.hpp"

#include <gtest/gtest.h>

#include <cmath>

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

TEST(SquareTable, IsAQuarterOfTheSquareRoundedHalfUp) {
    for (int i = 0; i < 256; ++i) {
        EXPECT_EQ(kSquareQ6[i], static_cast<int>(std::floor(i * i / 4.0 + 0.5)));
        EXPECT_EQ(square_q6(static_cast<S16>(i)), square_q6(static_cast<S16>(-i)));
    }
}

TEST(SquareTable, SaturatesBeyondSixteenSigma) {
    EXPECT_EQ(square_q6(256), kSquareQ6[255]);
    EXPECT_EQ(square_q6(-32768), kSquareQ6[255]);
    EXPECT_EQ(square_q6(16), 64);  // one sigma is 1 = 64/64
}

TEST(ResidualSigma, IsAQuarterOfTheRoughnessWithinOneHundredthOfAMillimetre) {
    MapGrid map;
    for (uint16_t rough = 0; rough < 32000; rough = static_cast<uint16_t>(rough + 37)) {
        map.rough_q8_mm = rough;
        for (const double cost : {0.0, 1.0, 1.5, 2.0, 3.0, 4.0, 6.0}) {
            map.match_cost_q10 = static_cast<U16>(cost * 1024);
            const double widen = std::min(3.0, std::max(1.0, 0.7 * cost));
            const double sigma_mm = std::max(rough / 256.0 / 4, 0.1) * widen;
            // 0.7 is 179/256: 0.1 % off.
            ASSERT_NEAR(residual_sigma_q8_mm(map) / 256.0, sigma_mm, 0.015 + 0.003 * sigma_mm)
                << rough << " " << cost;
        }
    }
}

TEST(MatchCosts, AreResidualAndPriorInSquaredSigmasWithinTheTableStep) {
    Scene scene(0.25, 2);
    scene.map.rough_q8_mm = 20 * 256;  // sigma 5 mm: far from saturation at most places
    Match match;
    match_costs(scene.map, scene.input, 1, expected_advance_q12_bin(scene.map, scene.input), match);
    for (int i = 0; i < kHalfBinCandidates; ++i) {
        const int half_bin = 1 + i;
        const auto residual_mm = [&](int node) {
            return scene.input.middle_height_q4_mm / 16.0 - (hills_mm(node + 10) - hills_mm(node));
        };
        const int node = half_bin / 2;
        const double misfit_mm =
            half_bin % 2 == 1 ? (residual_mm(node) + residual_mm(node + 1)) / 2 : residual_mm(node);
        const double off_bin = half_bin / 2.0 - 0.25 - (2.4 + (154 - 153.6) / 64);
        // An index is off by up to one step of 1/16 sigma in each of the two squares (the residual
        // by half a step and the rounding of three heights); the entry by half of 1/64.
        const double fit = std::abs(misfit_mm / 5);
        const double prior = std::abs(off_bin / 0.5);
        const double tolerance = (2 * fit + 2 * prior) / 16 + 2.0 / 256 + 1.0 / 64;
        EXPECT_NEAR(match.cost(static_cast<uint8_t>(i)) / 64.0, fit * fit + prior * prior,
                    tolerance)
            << half_bin;
    }
}

TEST(MatchCosts, TheBestCandidateIsTheFirstWithTheLeastCost) {
    for (int advance = 4; advance < 36; ++advance) {
        Scene scene(0.25, advance / 10.0);
        for (const U16 first : {U16{1}, U16{2}}) {
            Match match;
            match_costs(scene.map, scene.input, first, S16{8192}, match);
            for (uint8_t i = 0; i < kHalfBinCandidates; ++i) {
                ASSERT_GE(match.cost(i), match.least_q6 + (i < match.best ? 1 : 0));
            }
            ASSERT_EQ(match.cost(match.best), match.least_q6);
        }
    }
}

// Around a least cost, 16 (before - after) / (before - 2 least + after) in 1/64 bin, half up.
TEST(FitParabola, IsTheMinimumOfTheParabolaRoundedHalfUp) {
    for (int least = 0; least <= 2000; least += 250) {
        for (int before = 0; before < 30000; before = before * 5 / 4 + 7) {
            for (int after = 0; after < 30000; after = after * 5 / 4 + 3) {
                if (before + after == 0) continue;
                Parabola found;
                fit_parabola(static_cast<U16>(least + before), static_cast<U16>(least),
                             static_cast<U16>(least + after), found);
                const double exact = 16.0 * (before - after) / (before + after);
                const double bend = before + after;
                // A bend of more than 32767 loses its lowest bit.
                const double slack = bend > 32767 ? 1e-3 : 0;
                ASSERT_GE(found.offset_q6_bin, std::floor(exact + 0.5 - slack));
                ASSERT_LE(found.offset_q6_bin, std::floor(exact + 0.5 + slack));
                const double variance = std::min(1024.0, 131072.0 / bend);
                ASSERT_NEAR(found.variance_q12, variance, 1 + variance / std::max(bend - 1, 1.0))
                    << bend;
            }
        }
    }
}

TEST(FitParabola, ThreeEqualCostsSayNothing) {
    Parabola found;
    fit_parabola(U16{700}, U16{700}, U16{700}, found);
    EXPECT_EQ(found.offset_q6_bin, 0);
    EXPECT_EQ(found.variance_q12, kPriorVarianceQ12);
}

TEST(AddVariance, TheSpreadIsTheExactRootRoundedDown) {
    MapGrid map;
    const uint16_t steps[] = {1024, 1, 0, 997, 512, 1023};
    uint64_t sum = 0;
    for (int i = 0; i < 20000; ++i) {
        const uint16_t step = steps[i % 6];
        add_variance(map, step);
        sum += step;
        ASSERT_EQ(map.variance_q12, sum);
        ASSERT_EQ(map.spread_q6_bin, static_cast<uint16_t>(std::sqrt(static_cast<double>(sum))));
    }
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
            ASSERT_LE(advance, kReachQ6Bin + 31);
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
        EXPECT_EQ(map.variance_q12, kPriorVarianceQ12);  // the ground said nothing
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
        judge_match(map, 64 * 100);
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
    judge_match(map, 65535);
    // 1 + (16 - 1)/8; the gain is 32/256 exactly.
    EXPECT_EQ(map.match_cost_q10, 1024 + 15 * 128);
}

}  // namespace
