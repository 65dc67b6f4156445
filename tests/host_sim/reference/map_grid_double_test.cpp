// map_grid_double_test.cpp - the double model on ground whose answer is known in closed form.
#include "host_sim/reference/map_grid_double.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace {

using host_sim::CycleMotion;
using host_sim::MapGridDouble;
using host_sim::MapGridInput;
using host_sim::MapGridMode;

double hills_cm(double x_cm) {
    return 1.5 * std::sin(x_cm / 9) + 0.8 * std::sin(x_cm / 23 + 1);
}

MapGridInput at(double x_cm, double sinkage_cm = 0) {
    MapGridInput input;
    input.z1_cm = hills_cm(x_cm + 25) - hills_cm(x_cm);
    input.z2_cm = hills_cm(x_cm + 50) - hills_cm(x_cm);
    input.ahead_count = 2;
    input.ahead_distance_cm = {60, 80};
    input.ahead_height_cm = {hills_cm(x_cm + 60) + sinkage_cm - hills_cm(x_cm),
                             hills_cm(x_cm + 80) + sinkage_cm - hills_cm(x_cm)};
    return input;
}

TEST(MapGridDouble, FollowsASteadyAdvanceOverHillsWithin1Percent) {
    for (const double advance_cm : {4.0, 4.5, 5.0, 5.5}) {
        MapGridDouble estimator;
        estimator.start_on_known_ground(hills_cm);
        double x_cm = 0;
        for (int i = 0; i < 400; ++i) estimator.step(at(x_cm += advance_cm));
        EXPECT_NEAR(estimator.position_cm() / x_cm, 1, 0.01) << advance_cm;
        EXPECT_NEAR(estimator.prior_mean_cm(), advance_cm, 0.2);
        EXPECT_EQ(estimator.mode(), MapGridMode::tracking);
        EXPECT_EQ(estimator.lost_lock_count(), 0u);
        // 4 cm of 6 are 33 % slip, above the alarm's 30 %; 4.5 cm are 25 %.
        EXPECT_EQ(estimator.slip_alarm(), advance_cm < 4.2) << advance_cm;
    }
}

TEST(MapGridDouble, ReportsAUniformSinkageWithin5Percent) {
    MapGridDouble estimator;
    estimator.start_on_known_ground(hills_cm);
    double x_cm = 0;
    for (int i = 0; i < 200; ++i) estimator.step(at(x_cm += 5, 4.0));
    EXPECT_TRUE(estimator.sinkage_valid());
    EXPECT_NEAR(estimator.sinkage_cm(), 4.0, 0.2);
    EXPECT_TRUE(estimator.sinkage_alarm());
}

TEST(MapGridDouble, ReversingTurningAndLiftingAreWhatTheDesignSays) {
    MapGridDouble estimator;
    estimator.start_on_known_ground(hills_cm);
    MapGridInput input;
    input.motion = CycleMotion::reverse;
    input.odometer_cm = -6;
    estimator.step(input);
    EXPECT_DOUBLE_EQ(estimator.position_cm(), -6);
    EXPECT_DOUBLE_EQ(estimator.drift_cm(), 1.5);
    EXPECT_EQ(estimator.mode(), MapGridMode::reversing);
    input.motion = CycleMotion::turn;
    estimator.step(input);
    EXPECT_DOUBLE_EQ(estimator.position_cm(), -6);
    EXPECT_DOUBLE_EQ(estimator.drift_cm(), 2.0);
    EXPECT_EQ(estimator.mode(), MapGridMode::turning);
    input.motion = CycleMotion::moved;
    estimator.step(input);
    EXPECT_DOUBLE_EQ(estimator.drift_cm(), 4.5);
    EXPECT_EQ(estimator.mode(), MapGridMode::moved);
}

}  // namespace
