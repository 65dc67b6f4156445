// pose_record_test.cpp - a warm start goes on where the record was taken.
#include "firmware/executive/pose_record.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "rover_bench.hpp"

namespace {

using test::RoverBench;

/// A rover that starts where `before` is, as after a reset: counters and ticks at 0.
RoverBench restarted(const RoverBench& before) {
    RoverBench after;
    rover::controller_resume(after.controller, rover::pose_record(before.controller));
    return after;
}

/// Bumps that the linkage can follow.
void bump(RoverBench& bench, std::mt19937& random) {
    std::uniform_int_distribution<int> noise(-400, 400);
    for (std::size_t i = 0; i < 3; ++i) {
        bench.adc(i) = static_cast<std::uint16_t>(32760 + noise(random));
    }
}

TEST(PoseRecord, ANewControllerHasAnEmptyOne) {
    const rover::PoseRecord record = rover::pose_record(rover::Controller{});
    EXPECT_EQ(record.travelled_q6_bin, 0);
    EXPECT_EQ(record.odometer_q4_mm, 0);
    EXPECT_EQ(record.since_cycle_q4_mm, 0);
    EXPECT_EQ(record.variance_q12, 0u);
    EXPECT_EQ(record.drift_q12_bin, 0u);
    EXPECT_EQ(record.mean_q12_bin, 9830);  // 6.0 cm of 2.5 cm in Q12: no slip
    EXPECT_EQ(record.learned, 0);
    EXPECT_EQ(record.format, 1);
}

TEST(PoseRecord, PositionAndOdometerGoOnExactlyAfterAnyStep) {
    for (unsigned seed = 1; seed <= 20; ++seed) {
        std::mt19937 random(seed);
        std::uniform_real_distribution<double> step_mm(-2.0, 9.0);
        RoverBench before;
        for (int i = 0; i < 400; ++i) {
            bump(before, random);
            before.roll(step_mm(random), step_mm(random));
            RoverBench after = restarted(before);
            after.step();
            ASSERT_EQ(after.estimates().position_q4_mm, before.estimates().position_q4_mm)
                << "seed " << seed << " step " << i;
            ASSERT_EQ(after.estimates().odometer_q4_mm, before.estimates().odometer_q4_mm)
                << "seed " << seed << " step " << i;
            ASSERT_EQ(after.estimates().slip_percent, before.estimates().slip_percent);
            ASSERT_FALSE(after.has(rover::kEventCycle)) << "seed " << seed << " step " << i;
            ASSERT_EQ(after.estimates().step_count, 0);
        }
    }
}

TEST(PoseRecord, WhatIsDrivenAfterwardsIsAddedToIt) {
    RoverBench before;
    before.drive(500);
    RoverBench after = restarted(before);
    after.step();
    after.drive(500);
    EXPECT_NEAR(after.odometer_mm(), 1000.0, 2.0);  // a pulse is 0.2 mm
    EXPECT_NEAR(after.position_mm(), before.position_mm() + 500.0, 10.0);
}

TEST(PoseRecord, TheCycleThatWasBegunEndsWhereItWouldHave) {
    RoverBench before;
    before.drive(40);
    RoverBench after = restarted(before);
    after.step();
    // Due behind 20 mm; complete three steps later.
    EXPECT_EQ(after.drive(21), 0);
    EXPECT_EQ(after.drive(4), 1);
}

TEST(PoseRecord, ATurnThatWasBegunEndsWhereItWouldHave) {
    RoverBench before;
    before.step();
    for (int i = 0; i < 40; ++i) before.roll(-1.0, 1.0);
    RoverBench after = restarted(before);
    after.step();
    int steps = 0;
    while (!after.has(rover::kEventCycle) && steps < 100) {
        after.roll(-1.0, 1.0);
        ++steps;
    }
    EXPECT_NEAR(steps, 20 + rover::kCycleSteps - 1, 1);
    EXPECT_EQ(after.estimates().mode, rover::SlipMode::turning);
}

TEST(PoseRecord, TheMapStartsAnew) {
    std::mt19937 random(5);
    RoverBench before;
    for (int i = 0; i < 800; ++i) {
        bump(before, random);
        before.roll(3.0);
    }
    ASSERT_TRUE(before.controller.map.has_map);
    const RoverBench after = restarted(before);
    EXPECT_FALSE(after.controller.map.has_map);
    EXPECT_FALSE(after.controller.map.measured);
    EXPECT_FALSE(after.controller.map.has_behind);
    EXPECT_FALSE(after.controller.started);
}

TEST(PoseRecord, DoubtGrowsByTwoAndAHalfCentimetresAtARestart) {
    RoverBench before;
    before.drive(200);
    RoverBench after = restarted(before);
    after.step();
    const int grown =
        after.estimates().position_sigma_q4_mm - before.estimates().position_sigma_q4_mm;
    EXPECT_NEAR(grown, 25 * 16, 8);
    RoverBench doubtful = before;
    doubtful.controller.map.drift_q12_bin = 0xFFFF'FFFF;
    EXPECT_EQ(restarted(doubtful).controller.map.drift_q12_bin, 0xFFFF'FFFFu);
}

TEST(PoseRecord, AnyRecordLeavesAControllerThatGoesOn) {
    const unsigned seed = 8;
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    for (int round = 0; round < 500; ++round) {
        const auto word = [&] { return static_cast<std::uint32_t>(random()); };
        rover::PoseRecord record;
        record.travelled_q6_bin = static_cast<std::int32_t>(word());
        record.odometer_q4_mm = static_cast<std::int32_t>(word());
        record.variance_q12 = word();
        record.drift_q12_bin = word();
        record.since_cycle_q4_mm = static_cast<std::int16_t>(word());
        record.turn_q4_mm = static_cast<std::int16_t>(word());
        record.mean_q12_bin = static_cast<std::int16_t>(word());
        record.learned = static_cast<std::uint8_t>(word());
        RoverBench bench;
        rover::controller_resume(bench.controller, record);
        ASSERT_LE(bench.controller.map.learned, 24);         // slip tuning: gains for 0 to 24
        ASSERT_GE(bench.controller.map.mean_q12_bin, 1638);  // 1.0 cm
        ASSERT_LE(bench.controller.map.mean_q12_bin, 9830);  // 6.0 cm
        bench.drive(100, 5.0);
    }
}

}  // namespace
