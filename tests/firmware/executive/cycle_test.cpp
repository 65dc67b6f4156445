// cycle_test.cpp - when cycles come, of which motion, and what each does to the position.
#include "firmware/executive/cycle.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "rover_bench.hpp"

namespace {

using rover::SlipMode;
using test::RoverBench;

TEST(Cycle, ComesEverySixtyMillimetresOnAverageUpToFifteenCentimetresASecond) {
    for (const double speed_mm : {0.31, 1.0, 7.3, 14.9}) {
        RoverBench bench;
        bench.roll(0);
        const auto steps = static_cast<int>(30000 / speed_mm);
        const int cycles = bench.drive(steps, speed_mm);
        EXPECT_NEAR(cycles, steps * speed_mm / 60, 1.0) << speed_mm;
        EXPECT_EQ(bench.estimates().cycle_count, cycles);
        EXPECT_FALSE(bench.has(rover::kEventOverspeed));
    }
}

// A cycle takes four steps. What is driven meanwhile belongs to the next one, and nothing is lost.
TEST(Cycle, ComesEveryFourStepsWhenDrivenFaster) {
    for (const double speed_mm : {15.1, 25.0, 41.7, 59.0}) {
        RoverBench bench;
        bench.roll(0);
        const int steps = 600;
        const int cycles = bench.drive(steps, speed_mm);
        EXPECT_NEAR(cycles, speed_mm < 16 ? steps * speed_mm / 60 : steps / 4.0, 2.0) << speed_mm;
        EXPECT_TRUE(bench.has(rover::kEventOverspeed));
        EXPECT_NEAR(bench.odometer_mm(), steps * speed_mm, 0.5) << speed_mm;
    }
}

// Position, way since the cycle and what is reported agree in every step of a cycle.
TEST(Cycle, ThePositionRunsOnSmoothlyThroughTheStepsOfACycle) {
    RoverBench bench;
    bench.roll(0);
    double before_mm = 0;
    for (int i = 0; i < 300; ++i) {
        bench.roll(2.0);
        EXPECT_NEAR(bench.position_mm() - before_mm, 2.0, 1.5) << i;
        before_mm = bench.position_mm();
    }
}

TEST(Cycle, OneThatComesDueWhileAnotherRunsBeginsBehindIt) {
    RoverBench bench;
    bench.roll(0);
    bench.roll(61);
    bench.roll(61);  // due again at once
    int steps = 2;
    while (bench.estimates().cycle_count < 2 && steps < 20) {
        bench.roll(0);
        ++steps;
    }
    EXPECT_EQ(steps, 2 * rover::kCycleSteps);
    EXPECT_NEAR(bench.position_mm(), 122, 1.5);
}

TEST(Cycle, TheOdometerThatTheEstimatorSeesHasNoDrift) {
    RoverBench bench;
    rover::Controller& controller = bench.controller;
    std::int64_t sum_q6 = 0;
    for (int i = 1; i <= 100000; ++i) {
        const auto travel_q4_mm = static_cast<std::int16_t>(950 + i % 23);
        controller.odometer.travel_q4_mm += travel_q4_mm;
        controller.in_cycle_q4_mm = travel_q4_mm;
        sum_q6 += rover::executive::cycle_odometer_q6_bin(controller);
        ASSERT_EQ(sum_q6, std::int64_t{controller.odometer.travel_q4_mm} * 4 / 25) << i;
    }
}

TEST(Cycle, TheOdometerOfTheEstimatorLosesNothingEitherWay) {
    RoverBench bench;
    rover::Controller& controller = bench.controller;
    std::int64_t travel_q4_mm = 0;
    std::int64_t sum_q6 = 0;
    for (int way = -16000; way <= 16000; way += 7) {
        for (const int sign : {-1, 1}) {
            travel_q4_mm += sign * way;
            controller.in_cycle_q4_mm = static_cast<std::int16_t>(sign * way);
            sum_q6 += rover::executive::cycle_odometer_q6_bin(controller);
            ASSERT_EQ(sum_q6, static_cast<std::int64_t>(
                                  std::floor(static_cast<double>(travel_q4_mm) * 4 / 25)));
        }
    }
    controller.odometer_rest_q6 = 0;
    controller.in_cycle_q4_mm = 32767;
    EXPECT_EQ(rover::executive::cycle_odometer_q6_bin(controller), 2560) << "a metre at most";
}

TEST(Cycle, AStepOfMoreThanACycleIsOverspeedAndRunsOneCycle) {
    RoverBench bench;
    bench.roll(0);
    bench.roll(61);
    EXPECT_TRUE(bench.has(rover::kEventOverspeed));
    bench.finish_cycle();
    EXPECT_EQ(bench.estimates().cycle_count, 1);
    bench.roll(380);
    EXPECT_TRUE(bench.has(rover::kEventOverspeed));
    bench.finish_cycle();
    EXPECT_EQ(bench.estimates().cycle_count, 2);
    bench.roll(-380);
    EXPECT_TRUE(bench.has(rover::kEventOverspeed));
    bench.finish_cycle();
    EXPECT_EQ(bench.estimates().cycle_count, 3);
    bench.roll(14.9);
    EXPECT_FALSE(bench.has(rover::kEventOverspeed));
    EXPECT_NEAR(bench.odometer_mm(), 61 + 380 - 380 + 14.9, 0.3);
    EXPECT_NEAR(bench.position_mm(), bench.odometer_mm(), 1.5);
}

TEST(Cycle, BackwardsIsReversingByFullOdometry) {
    RoverBench bench;
    bench.roll(0);
    bench.drive(600);
    const double turn_point_mm = bench.position_mm();
    const auto before = bench.estimates().cycle_count;
    bench.drive(180, -1.0);
    bench.finish_cycle();
    EXPECT_NEAR(bench.estimates().cycle_count - before, 3, 1);
    EXPECT_EQ(bench.estimates().mode, SlipMode::reversing);
    EXPECT_NEAR(bench.position_mm(), turn_point_mm - 180, 1.0);
    bench.drive(130);
    EXPECT_NE(bench.estimates().mode, SlipMode::reversing);
}

TEST(Cycle, ReversingFromTheStartNeedsSixtyMillimetres) {
    RoverBench bench;
    bench.roll(0);
    EXPECT_EQ(bench.drive(59, -1.0), 0);
    bench.finish_cycle();
    EXPECT_EQ(bench.estimates().cycle_count, 0);
    bench.drive(2, -1.0);
    bench.finish_cycle();
    EXPECT_EQ(bench.estimates().cycle_count, 1);
    EXPECT_EQ(bench.estimates().mode, SlipMode::reversing);
}

TEST(Cycle, TurningOnTheSpotClaimsNoAdvance) {
    for (const double sign : {-1.0, 1.0}) {
        RoverBench bench;
        bench.roll(0);
        bench.drive(700);
        const double before_mm = bench.position_mm();
        const auto cycles = bench.estimates().cycle_count;
        for (int i = 0; i < 300; ++i) {
            bench.dither();
            bench.roll(-sign, sign);
        }
        EXPECT_NEAR(bench.estimates().cycle_count - cycles, 5, 1);
        EXPECT_EQ(bench.estimates().mode, SlipMode::turning);
        EXPECT_NEAR(bench.position_mm(), before_mm, 1.0);
        EXPECT_FALSE(bench.has(rover::kAvailableSlip));
    }
}

// A tight arc: the sides are cut short by turning cycles, yet the middle of the vehicle goes on.
TEST(Cycle, ATightArcLosesNoneOfItsWay) {
    RoverBench bench;
    bench.roll(0);
    for (int i = 0; i < 2000; ++i) {
        bench.dither();
        bench.roll(-0.1, 1.9);  // 0.9 mm forward, 1 mm of turn
    }
    EXPECT_EQ(bench.estimates().mode, SlipMode::turning);
    EXPECT_NEAR(bench.odometer_mm(), 1800, 1.0);
    EXPECT_NEAR(bench.position_mm(), 1800, 18.0);  // 1/64 bin is lost in each of 33 cycles
}

TEST(Cycle, MovedAtRestIsSeenFromTwelveMillimetresOfEitherHeight) {
    const auto moved_by = [](hal::AngleChannel channel, double degrees) {
        RoverBench bench;
        bench.roll(0);
        bench.drive(90);  // the first cycle decides for a side
        bench.roll(0);
        const auto before = bench.estimates().cycle_count;
        bench.adc(channel) = static_cast<std::uint16_t>(32760 + degrees * 65536 / 90);
        bench.roll(0);
        bench.finish_cycle();
        const bool moved = bench.estimates().mode == SlipMode::moved;
        EXPECT_EQ(bench.estimates().cycle_count - before, moved ? 1 : 0);
        EXPECT_EQ(bench.has(rover::kEventCycle), moved);
        return moved;
    };
    // Differential: z(2) changes by 500 sin; bogie: z(1), z(2) by 125 sin.
    const double degree = 180 / 3.14159265;
    EXPECT_FALSE(moved_by(hal::AngleChannel::differential, 11.5 / 500 * degree));
    EXPECT_TRUE(moved_by(hal::AngleChannel::differential, 12.6 / 500 * degree));
    EXPECT_TRUE(moved_by(hal::AngleChannel::differential, -12.6 / 500 * degree));
    EXPECT_FALSE(moved_by(hal::AngleChannel::bogie_left, 11.5 / 125 * degree));
    EXPECT_TRUE(moved_by(hal::AngleChannel::bogie_left, 12.6 / 125 * degree));
}

TEST(Cycle, ChangingHeightsWhileWheelsSpinAreNotMoved) {
    RoverBench bench;
    bench.roll(0);
    bench.drive(90);
    for (int i = 0; i < 50; ++i) {
        bench.adc(hal::AngleChannel::differential) =
            static_cast<std::uint16_t>(i % 2 == 0 ? 36000 : 30000);
        bench.roll(1);
        ASSERT_NE(bench.estimates().mode, SlipMode::moved);
    }
}

// The wheels have rolled 45 mm since the last cycle when the vehicle is picked up: that way counts.
TEST(Cycle, MovingByHandDoesNotTakeBackWhatWasDriven) {
    RoverBench bench;
    bench.roll(0);
    bench.drive(105);
    bench.roll(0);
    const double before_mm = bench.position_mm();
    EXPECT_NEAR(before_mm, 105, 1.0);
    const auto sigma = bench.estimates().position_sigma_q4_mm;
    bench.adc(hal::AngleChannel::differential) = 36000;
    bench.roll(0);
    bench.finish_cycle();
    ASSERT_EQ(bench.estimates().mode, SlipMode::moved);
    EXPECT_NEAR(bench.position_mm(), before_mm, 0.8);
    // 25 mm for the move, and a quarter of the 45 mm that only the wheels measured.
    EXPECT_NEAR((bench.estimates().position_sigma_q4_mm - sigma) / 16.0, 25 + 45 / 4.0, 1.5);
}

TEST(Cycle, TheRightBogieTakesOverAndTheMapIsDropped) {
    RoverBench bench;
    bench.roll(0);
    bench.drive(900);
    ASSERT_TRUE(bench.has(rover::kAvailableSlip));
    ASSERT_TRUE(bench.has(rover::kAvailableLookAhead));
    bench.adc(hal::AngleChannel::bogie_left) = 0;  // at its rail
    bench.drive(70);
    EXPECT_TRUE(bench.has(rover::kFaultBogieLeft));
    EXPECT_TRUE(bench.has(rover::kAvailableLinkage));
    EXPECT_FALSE(bench.has(rover::kAvailableSlip));
    EXPECT_EQ(bench.controller.side, rover::Side::right);
    // The samples lie ahead of the left wheels.
    EXPECT_FALSE(bench.has(rover::kAvailableLookAhead));
    bench.drive(900);
    EXPECT_TRUE(bench.has(rover::kAvailableSlip));
    EXPECT_FALSE(bench.has(rover::kAvailableSinkage));
}

TEST(Cycle, LookAheadHeightsAreWithoutTheCalibratedOffsetAndKeptWhileASampleIsUnseen) {
    hal::Calibration calibration;
    calibration.range_offset_q1_mm = 100;
    RoverBench bench(calibration);
    bench.inputs.range_q1_mm[0] = 100;
    bench.inputs.range_q1_mm[1] = 140;
    bench.roll(0);
    bench.drive(70);
    EXPECT_NEAR(bench.estimates().height_ahead_q4_mm[0] / 16.0, 0, 0.6);
    EXPECT_NEAR(bench.estimates().height_ahead_q4_mm[1] / 16.0, 20, 0.6);
    bench.inputs.range_present = 1;
    bench.inputs.range_q1_mm[0] = 80;
    bench.inputs.range_q1_mm[1] = 0;
    bench.drive(60);
    EXPECT_NEAR(bench.estimates().height_ahead_q4_mm[0] / 16.0, -10, 0.6);
    EXPECT_NEAR(bench.estimates().height_ahead_q4_mm[1] / 16.0, 20, 0.6);
}

TEST(WatchScan, FreshForThreeStepsAndWrapsItsCounter) {
    rover::ScanWatch scan;
    hal::RawInputs inputs;
    EXPECT_FALSE(rover::executive::watch_scan(scan, inputs));
    inputs.range_present = 0b11111100;  // none that this vehicle uses
    EXPECT_FALSE(rover::executive::watch_scan(scan, inputs));
    EXPECT_EQ(scan.age_steps, rover::kNoScanYet);
    inputs.range_present = 0b01;
    inputs.range_scan_count = 255;
    EXPECT_TRUE(rover::executive::watch_scan(scan, inputs));
    inputs.range_scan_count = 0;
    EXPECT_TRUE(rover::executive::watch_scan(scan, inputs));
    EXPECT_EQ(scan.age_steps, 0);
    for (int age = 1; age <= 12; ++age) {
        EXPECT_EQ(rover::executive::watch_scan(scan, inputs), age <= 3) << age;
        EXPECT_EQ(scan.age_steps, age < 10 ? age : 10);
    }
}

}  // namespace
