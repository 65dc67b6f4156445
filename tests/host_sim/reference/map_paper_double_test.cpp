// map_paper_double_test.cpp - the double-precision model against closed forms.
#include "host_sim/reference/map_paper_double.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>
#include <vector>

namespace {

using host_sim::MapPaperDouble;
using host_sim::MapPaperHeightsCm;
using host_sim::MapPaperOptions;

void reset_on(MapPaperDouble& estimator, double bin_cm, double curvature_per_cm) {
    std::vector<double> ground_cm;
    for (int bin = 0; bin <= estimator.ground_last(); ++bin) {
        ground_cm.push_back(curvature_per_cm * bin * bin_cm * bin * bin_cm);
    }
    const auto sinkage_size = static_cast<std::size_t>(estimator.sinkage_last()) + 1;
    estimator.reset(ground_cm, std::vector<double>(sinkage_size, 0.0));
}

TEST(MapPaperDouble, LevelGroundGivesThePriorMean) {
    for (const double bin_cm : {0.25, 1.0, 2.5, 4.0}) {
        MapPaperDouble estimator({.bin_cm = bin_cm, .prior_mean_cm = 5.3});
        reset_on(estimator, bin_cm, 0);
        for (int i = 0; i < 20; ++i) EXPECT_NEAR(estimator.step({}), 5.3, 1e-9) << bin_cm;
    }
}

// On ground a x^2 every residual is linear in the advance, so that the sum of squares is a parabola
// whose minimum has a closed form: the weighted mean of what each term alone would say.
TEST(MapPaperDouble, FirstAdvanceOnQuadraticGroundIsTheClosedFormMapEstimate) {
    constexpr double kCurvature = 1e-3;
    constexpr double kAdvanceCm = 4.7;
    constexpr double kPriorCm = 6, kPriorSigmaCm = 0.3;
    for (const bool look_ahead : {false, true}) {
        for (const double bin_cm : {0.5, 1.0, 2.0, 2.5, 3.0, 3.25, 4.0}) {
            MapPaperDouble estimator({.bin_cm = bin_cm,
                                      .prior_mean_cm = kPriorCm,
                                      .prior_sigma_cm = kPriorSigmaCm,
                                      .look_ahead_term = look_ahead});
            reset_on(estimator, bin_cm, kCurvature);
            const auto seen = [&](double distance_cm) {
                return kCurvature * distance_cm * (2 * kAdvanceCm + distance_cm);
            };
            double weights = 1 / (kPriorSigmaCm * kPriorSigmaCm);
            double weighted_cm = weights * kPriorCm;
            const auto add_term = [&](double distance_cm, double sigma_cm) {
                const double arm_cm = std::floor(distance_cm / bin_cm) * bin_cm;
                const double slope = 2 * kCurvature * arm_cm;
                const double alone_cm = (seen(distance_cm) - kCurvature * arm_cm * arm_cm) / slope;
                const double weight = slope * slope / (sigma_cm * sigma_cm);
                weights += weight;
                weighted_cm += weight * alone_cm;
            };
            add_term(25, 0.004);
            if (look_ahead) add_term(60, 0.2);
            const double advance_cm = estimator.step({.middle = seen(25), .near_ahead = seen(60)});
            EXPECT_NEAR(advance_cm, weighted_cm / weights, 1e-9) << "bin " << bin_cm;
        }
    }
}

TEST(MapPaperDouble, SinkageIsTheGroundAtTheFrontWheelMinusItsHeight) {
    MapPaperDouble estimator({});
    reset_on(estimator, 2.5, 0);
    estimator.step({.front = -1.25});
    EXPECT_DOUBLE_EQ(estimator.sinkage_cm(), 1.25);
}

TEST(MapPaperDouble, MiddleWheelSetsTheSurfaceAndItsNeighboursGoHalfway) {
    MapPaperDouble estimator({.prior_mean_cm = 5, .prior_sigma_cm = 0.001});
    reset_on(estimator, 2.5, 0);
    EXPECT_NEAR(estimator.step({.middle = 0.02}), 5.0, 1e-6);
    EXPECT_NEAR(estimator.surface_cm(10), 0.02, 1e-12);
    EXPECT_NEAR(estimator.surface_cm(9), 0.01, 1e-12);
    EXPECT_NEAR(estimator.surface_cm(11), 0.01, 1e-12);
    EXPECT_NEAR(estimator.surface_cm(8), 0, 1e-12);
}

TEST(MapPaperDouble, SearchReachesFourSigmaAndFourBinsPastTheMeanOrTheEndOfTheMap) {
    EXPECT_EQ(MapPaperDouble({.bin_cm = 1}).search_last(), 14);   // (6 + 4) / 1 + 4
    EXPECT_EQ(MapPaperDouble({.bin_cm = 2.5}).search_last(), 8);  // (6 + 4) / 2.5 + 4
    EXPECT_EQ(MapPaperDouble({.bin_cm = 4}).search_last(), 5);    // 80 cm / bin - 60 cm / bin
    EXPECT_EQ(MapPaperDouble({.bin_cm = 8}).search_last(), 3);
}

TEST(MapPaperDouble, MinimumAtBinZeroIsExactlyNoAdvance) {
    MapPaperDouble estimator({.bin_cm = 8, .prior_mean_cm = 3.9});
    reset_on(estimator, 8, 0);
    EXPECT_EQ(estimator.step({}), 0);
}

TEST(MapPaperDouble, AnyInputsLeaveTheSearchAndTheAdvanceInRange) {
    constexpr std::uint64_t kSeed = 99;
    std::mt19937_64 random(kSeed);
    std::normal_distribution<double> normal;
    for (const double bin_cm : {0.25, 2.5, 6.5, 8.0}) {
        MapPaperDouble estimator({.bin_cm = bin_cm});
        reset_on(estimator, bin_cm, 0.01);
        for (int i = 0; i < 2000; ++i) {
            const double scale = std::pow(10.0, static_cast<double>(random() % 12) - 6);
            MapPaperHeightsCm heights{scale * normal(random), scale * normal(random),
                                      scale * normal(random), scale * normal(random)};
            if (i == 1500) heights.middle = std::numeric_limits<double>::infinity();
            if (i == 1600) heights.front = std::numeric_limits<double>::quiet_NaN();
            const double advance_cm = estimator.step(heights);
            ASSERT_GE(advance_cm, 0) << "cycle " << i << " seed " << kSeed;
            ASSERT_LE(advance_cm, 24) << "cycle " << i << " seed " << kSeed;
            ASSERT_LE(estimator.search_last() * bin_cm, 20 + bin_cm);
        }
    }
}

TEST(MapPaperDouble, RefusesOptionsAndSizesOutOfRange) {
    const auto refused = [](const MapPaperOptions& options) {
        EXPECT_THROW(MapPaperDouble{options}, std::invalid_argument);
    };
    refused({.bin_cm = 0});
    refused({.bin_cm = 8.5});
    refused({.bin_cm = std::nan("")});
    refused({.prior_mean_cm = -1});
    refused({.prior_sigma_cm = 0});
    refused({.vehicle_sigma_cm = -1});
    MapPaperDouble estimator({});
    EXPECT_THROW(estimator.reset(std::vector<double>(32), std::vector<double>(21)),
                 std::invalid_argument);
    EXPECT_THROW(estimator.reset(std::vector<double>(33), std::vector<double>(22)),
                 std::invalid_argument);
}

}  // namespace
