// slip_estimators_test.cpp - the factory knows its estimators and says why it refuses.
#include "host_sim/bind/slip_estimators.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>
#include <vector>

namespace {

using namespace host_sim;

PlanarGround level_ground() {
    return {Terrain(0, 2.5, std::vector<double>(100, 0.0)), SinkageField()};
}

TEST(HeightQ4Mm, RoundsToTheNearestSixteenthAndClamps) {
    EXPECT_EQ(height_q4_mm(0), 0);
    EXPECT_EQ(height_q4_mm(1.0), 160);
    EXPECT_EQ(height_q4_mm(-1.0), -160);
    EXPECT_EQ(height_q4_mm(0.49 / 160), 0);
    EXPECT_EQ(height_q4_mm(0.51 / 160), 1);
    EXPECT_EQ(height_q4_mm(1e9), 32767);
    EXPECT_EQ(height_q4_mm(-1e9), -32768);
    EXPECT_EQ(height_q4_mm(std::numeric_limits<double>::infinity()), 32767);
    EXPECT_EQ(height_q4_mm(std::nan("")), 0);
}

TEST(MakeSlipEstimator, EveryBinOfThePapersTableRunsInBothArithmetics) {
    const PlanarGround ground = level_ground();
    for (int quarter = 1; quarter <= 32; ++quarter) {
        for (const Arithmetic arithmetic : {Arithmetic::fixed, Arithmetic::floating}) {
            const auto estimator = make_slip_estimator({.kind = EstimatorKind::map_paper,
                                                        .arithmetic = arithmetic,
                                                        .bin_cm = 0.25 * quarter});
            estimator->reset(ground);
            // Level ground: the prior mean, or no advance where bin 0 is nearer than bin 1.
            EXPECT_NEAR(estimator->step({}), 6.0, 0.04) << quarter << " " << name_of(arithmetic);
        }
    }
}

TEST(MakeSlipEstimator, StartsFromTheKnownGround) {
    // A step under the middle wheel's next place that the estimator can only know from the start.
    std::vector<double> heights_cm(100, 0.0);
    for (std::size_t i = 12; i < heights_cm.size(); ++i) heights_cm[i] = 1.0;
    const PlanarGround ground(Terrain(0, 2.5, heights_cm), SinkageField());
    for (const Arithmetic arithmetic : {Arithmetic::fixed, Arithmetic::floating}) {
        const auto estimator = make_slip_estimator(
            {.kind = EstimatorKind::map_paper, .arithmetic = arithmetic, .prior_sigma_cm = 2});
        estimator->reset(ground);
        // Not on the step yet: less than two bins. The prior alone would say 6 cm.
        EXPECT_LT(estimator->step({.middle_cm = 0, .front_cm = 1, .near_cm = 1, .far_cm = 1}), 4.0);
    }
}

TEST(MakeSlipEstimator, RefusesOptionsThatTheIntegersCannotHold) {
    const auto refused = [](const SlipEstimatorOptions& options) {
        EXPECT_THROW((void)make_map_paper_fixed(options), std::invalid_argument);
    };
    refused({.bin_cm = 0});
    refused({.bin_cm = 2.6});
    refused({.bin_cm = 8.25});
    refused({.bin_cm = std::nan("")});
    refused({.prior_mean_cm = 51});
    refused({.prior_mean_cm = -0.1});
    refused({.prior_sigma_cm = 0.001});
    refused({.prior_sigma_cm = 21});
}

}  // namespace
