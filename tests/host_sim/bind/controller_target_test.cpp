// controller_target_test.cpp - drives and replays with restarts, on the native target.
#include "host_sim/bind/controller_target.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "host_sim/bind/comparison.hpp"
#include "host_sim/bind/host_target.hpp"
#include "host_sim/world/course.hpp"

namespace {

using host_sim::Log;
using host_sim::Restart;

Log drive(const std::vector<double>& resets_s) {
    host_sim::Vehicle vehicle = host_sim::rocky32();
    vehicle.speed_cm_per_s = 6;
    host_sim::Drive world(
        host_sim::random_course(vehicle, host_sim::TerrainKind::fractal, 0.02, 2.0, 3));
    host_sim::LogHead head;
    head.calibration = host_sim::nominal_calibration(vehicle);
    return host_sim::drive(*host_sim::make_host_target(), world, head, {}, resets_s);
}

TEST(Drive, AResetCountsTicksPulsesAndStepsFromZeroAndKeepsThePose) {
    const Log plain = drive({});
    const Log log = drive({20.0, 25.05});
    ASSERT_GT(log.steps.size(), 300u);
    for (const std::size_t at : {std::size_t{200}, std::size_t{251}}) {
        const host_sim::LogStep& before = log.steps[at - 1];
        const host_sim::LogStep& step = log.steps[at];
        EXPECT_EQ(step.restart, Restart::warm);
        EXPECT_EQ(step.inputs.tick_count, 0);
        EXPECT_EQ(step.inputs.tach_count[0], 0);
        EXPECT_EQ(step.estimates->step_count, 0);
        EXPECT_EQ(step.estimates->odometer_q4_mm, before.estimates->odometer_q4_mm);
        EXPECT_EQ(step.estimates->position_q4_mm, before.estimates->position_q4_mm);
        EXPECT_GE(step.estimates->position_sigma_q4_mm, before.estimates->position_sigma_q4_mm);
        EXPECT_EQ(log.steps[at + 1].inputs.tick_count, 10);
        EXPECT_EQ(log.steps[at + 1].estimates->step_count, 1);
    }
    EXPECT_EQ(log.steps[100].restart, Restart::none);
    // What was driven within the two steps of the resets is lost, and no more: 2 x 6 mm.
    const double lost_mm =
        (plain.steps[300].estimates->odometer_q4_mm - log.steps[300].estimates->odometer_q4_mm) /
        16.0;
    EXPECT_NEAR(lost_mm, 12, 1);
}

TEST(Replay, RestartsOfTheLogAreCarriedOut) {
    const Log driven = drive({10, 12, 20});
    Log again = driven;
    host_sim::replay_on_host(again);
    EXPECT_FALSE(host_sim::compare_outputs(driven, again).divergence.has_value());
    again.steps[100].restart = Restart::none;
    host_sim::replay_on_host(again);
    EXPECT_TRUE(host_sim::compare_outputs(driven, again).divergence.has_value());
}

TEST(Replay, AColdRestartForgetsThePoseAndAWarmOneWithoutCheckpointIsCold) {
    Log log = drive({});
    log.steps[200].restart = Restart::cold;
    host_sim::replay_on_host(log);
    EXPECT_GT(log.steps[199].estimates->odometer_q4_mm, 1000);
    EXPECT_EQ(log.steps[200].estimates->odometer_q4_mm, 0);
    Log first = drive({});
    Log marked = first;
    marked.steps[0].restart = Restart::warm;
    host_sim::replay_on_host(marked);
    EXPECT_FALSE(host_sim::compare_outputs(first, marked).divergence.has_value());
    const auto used = host_sim::make_host_target();  // what it has run before does not count
    host_sim::replay(*used, log);
    host_sim::replay(*used, marked);
    EXPECT_FALSE(host_sim::compare_outputs(first, marked).divergence.has_value());
}

}  // namespace
