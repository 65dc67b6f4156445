// controller_test.cpp - the whole control step: degradation, faults, wraps, any input whatever.
#include "firmware/executive/controller.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <random>

#include "rover_bench.hpp"

namespace {

using hal::AngleChannel;
using rover::SlipMode;
using test::RoverBench;

TEST(Controller, FirstStepIsNumberZeroAndNothingHasMoved) {
    RoverBench bench;
    bench.inputs.tick_count = 40000;
    for (std::uint16_t& count : bench.inputs.tach_count) count = 54321;
    bench.step();
    EXPECT_EQ(bench.estimates().step_count, 0);
    EXPECT_EQ(bench.estimates().tick_count, 40000);
    EXPECT_EQ(bench.estimates().odometer_q4_mm, 0);
    EXPECT_EQ(bench.estimates().position_q4_mm, 0);
    EXPECT_EQ(bench.estimates().events, 0);
    EXPECT_EQ(bench.estimates().available, rover::kAvailableOdometry | rover::kAvailableAttitude |
                                               rover::kAvailableLinkage |
                                               rover::kAvailableLookAhead);
    bench.step();
    EXPECT_EQ(bench.estimates().step_count, 1);
}

TEST(Controller, MissingTicksAreAnEventAlsoAcrossTheWrapOfTheCounter) {
    RoverBench bench;
    bench.inputs.tick_count = 65530;
    bench.step();
    bench.step();  // tick 4: exactly ten later
    EXPECT_EQ(bench.estimates().tick_count, 4);
    EXPECT_FALSE(bench.has(rover::kEventTickGap));
    bench.inputs.tick_count = 15;  // eleven later
    bench.step();
    EXPECT_TRUE(bench.has(rover::kEventTickGap));
    bench.step();
    EXPECT_FALSE(bench.has(rover::kEventTickGap));
}

TEST(Controller, EachMissingSensorTakesExactlyTheEstimatesThatNeedIt) {
    using namespace rover;
    const unsigned all = 0x3F;
    const unsigned heights =
        kAvailableLinkage | kAvailableSlip | kAvailableLookAhead | kAvailableSinkage;
    const auto lost = [&](auto remove) {
        RoverBench bench;
        bench.roll(0);
        bench.drive(1200);
        EXPECT_EQ(bench.estimates().available, all);
        remove(bench);
        bench.roll(1);
        EXPECT_EQ(bench.estimates().faults, 0);  // absence is not a fault
        return all & ~unsigned{bench.estimates().available};
    };
    const auto absent = [](AngleChannel channel) {
        return [channel](RoverBench& bench) { bench.adc(channel) = hal::kAdcAbsent; };
    };
    EXPECT_EQ(lost(absent(AngleChannel::pitch)), heights | kAvailableAttitude);
    EXPECT_EQ(lost(absent(AngleChannel::differential)), heights);
    EXPECT_EQ(lost(absent(AngleChannel::roll)), kAvailableAttitude);
    EXPECT_EQ(lost(absent(AngleChannel::bogie_right)), 0u);
    EXPECT_EQ(lost([](RoverBench& bench) {
                  bench.adc(AngleChannel::bogie_left) = hal::kAdcAbsent;
                  bench.adc(AngleChannel::bogie_right) = hal::kAdcAbsent;
              }),
              heights);
    EXPECT_EQ(lost([](RoverBench& bench) { bench.inputs.tach_present = 0; }), kAvailableOdometry);
    EXPECT_EQ(lost([](RoverBench& bench) { bench.inputs.range_present = 0; }), kAvailableLookAhead);
}

TEST(Controller, WithWheelsAndNothingElseThePositionIsTheOdometer) {
    RoverBench bench;
    for (std::uint16_t& count : bench.inputs.adc_q4_count) count = hal::kAdcAbsent;
    bench.inputs.range_present = 0;
    bench.roll(0);
    for (int i = 0; i < 5000; ++i) {
        bench.roll(1);
        ASSERT_NEAR(bench.position_mm(), bench.odometer_mm(), 0.5);
        ASSERT_EQ(bench.estimates().mode, SlipMode::odometry_only);
        ASSERT_EQ(bench.estimates().available, rover::kAvailableOdometry);
        ASSERT_EQ(bench.estimates().slip_percent, 0);
    }
    EXPECT_EQ(bench.estimates().faults, 0);
    EXPECT_GT(bench.estimates().position_sigma_q4_mm, 16 * 100);
}

// Without noise no advance fits level ground better than another: the learned one is followed, as
// between cycles.
TEST(Controller, PositionHasNoJumpsAtCycleBoundaries) {
    for (const bool linkage : {true, false}) {
        for (const int mean : {9830, 8192, 4915}) {
            RoverBench bench;
            if (!linkage) bench.adc(AngleChannel::pitch) = hal::kAdcAbsent;
            bench.controller.map.mean_q12_bin = static_cast<std::int16_t>(mean);
            bench.roll(0);
            double before_mm = 0;
            for (int i = 0; i < 1200; ++i) {
                bench.roll(1);
                ASSERT_NEAR(bench.position_mm() - before_mm, mean / 9830.0, 1.5) << i;
                before_mm = bench.position_mm();
            }
            EXPECT_NEAR(before_mm, 1200 * mean / 9830.0, 12) << mean;
        }
    }
}

TEST(Controller, AStuckPotentiometerIsAFaultAndHealsWhenItChanges) {
    RoverBench bench;
    bench.roll(0);
    bench.adc(AngleChannel::differential) = 33000;  // does not dither
    bench.drive(8 * 60 + 30);
    EXPECT_FALSE(bench.has(rover::kFaultDifferential));
    bench.drive(60);
    EXPECT_TRUE(bench.has(rover::kFaultDifferential));
    EXPECT_TRUE(bench.has(rover::kEventSensorFault));
    EXPECT_FALSE(bench.has(rover::kAvailableLinkage));
    bench.adc(AngleChannel::differential) = 32760;
    bench.roll(1);
    EXPECT_FALSE(bench.has(rover::kFaultDifferential));
    EXPECT_FALSE(bench.has(rover::kEventSensorFault));
    EXPECT_TRUE(bench.has(rover::kAvailableLinkage));
}

TEST(Controller, ADeadTachometerIsAFaultWithinACycle) {
    RoverBench bench;
    bench.roll(0);
    bench.drive(70);
    EXPECT_FALSE(bench.has(rover::kFaultTachometer));
    for (int i = 0; i < 130; ++i) {
        bench.dither();
        bench.travel_mm[2] -= 1;  // middle left stands still
        bench.roll(1);
    }
    EXPECT_TRUE(bench.has(rover::kFaultTachometer));
    EXPECT_NEAR(bench.odometer_mm(), 200, 2.0);
    bench.drive(130);
    EXPECT_FALSE(bench.has(rover::kFaultTachometer));
}

TEST(Controller, AStaleScanIsAFaultAfterASecond) {
    RoverBench bench;
    bench.step();
    for (int age = 1; age <= 12; ++age) {
        --bench.inputs.range_scan_count;  // step() counts it up
        bench.step();
        EXPECT_EQ(bench.has(rover::kAvailableLookAhead), age <= 3) << age;
        EXPECT_EQ(bench.has(rover::kFaultRangeStale), age >= 10) << age;
    }
    bench.step();
    EXPECT_FALSE(bench.has(rover::kFaultRangeStale));
    EXPECT_TRUE(bench.has(rover::kAvailableLookAhead));
}

TEST(Controller, AVehicleWithoutRangeModuleHasNoStaleScan) {
    RoverBench bench;
    bench.inputs.range_present = 0;
    for (int i = 0; i < 100; ++i) bench.step();
    EXPECT_EQ(bench.estimates().faults, 0);
}

TEST(Controller, AnInvalidCalibrationIsAFaultInEveryStepAndNominalValuesAreUsed) {
    hal::Calibration calibration;
    calibration.version = 9;
    calibration.tach_q16_mm_per_count = 65535;
    RoverBench bench(calibration);
    bench.roll(0);
    EXPECT_TRUE(bench.has(rover::kFaultCalibration));
    bench.drive(100);
    EXPECT_TRUE(bench.has(rover::kFaultCalibration));
    EXPECT_TRUE(bench.has(rover::kEventSensorFault));
    EXPECT_NEAR(bench.odometer_mm(), 100, 0.3);
}

TEST(Controller, AnAlarmDoesNotOutliveTheSensorsItNeeds) {
    RoverBench bench;
    bench.roll(0);
    bench.controller.map.mean_q12_bin = 4000;  // 59 % slip
    bench.drive(130);
    ASSERT_TRUE(bench.has(rover::kEventSlipAlarm));
    EXPECT_EQ(bench.commands.drive_percent[0], 50);
    bench.adc(AngleChannel::pitch) = hal::kAdcAbsent;
    bench.roll(1);
    EXPECT_FALSE(bench.has(rover::kEventSlipAlarm));
    EXPECT_EQ(bench.commands.drive_percent[0], 100);
}

TEST(Controller, SurvivesTheWrapOfItsStepCounterAndTheTachometers) {
    RoverBench bench;
    bench.roll(0);
    for (int i = 0; i < 70000; ++i) bench.roll(1);
    EXPECT_EQ(bench.estimates().step_count, 70000 - 65536);
    EXPECT_NEAR(bench.odometer_mm(), 70000, 1);  // 5 wraps of each counter
    EXPECT_NEAR(bench.estimates().cycle_count, 70000 / 60, 1);
}

/// Any structs whatever, in three temperaments: noise, small changes, and mostly sane.
TEST(Controller, AnyInputsGiveAReadableFrameAndLegalCommands) {
    const std::uint32_t seed = std::random_device{}();
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937 random(seed);
    for (int run = 0; run < 20; ++run) {
        hal::Calibration calibration;
        if (run % 2 == 1) {
            for (auto& angle : calibration.angle) {
                angle.zero_q4_count = static_cast<std::uint16_t>(random());
                angle.gain_q16 = static_cast<std::uint16_t>(random());
            }
            calibration.wheel_radius_q4_mm = static_cast<std::uint16_t>(random());
            calibration.tach_q16_mm_per_count = static_cast<std::uint16_t>(random());
            calibration.range_offset_q1_mm = static_cast<std::int16_t>(random() & 0xFFFFu);
        }
        RoverBench bench(calibration);
        for (int step = 0; step < 5000; ++step) {
            unsigned char bytes[sizeof(hal::RawInputs)];
            std::memcpy(bytes, &bench.inputs, sizeof bytes);
            const auto touched = run % 3 == 0 ? sizeof bytes : run % 3 == 1 ? 3u : 1u;
            for (std::size_t i = 0; i < touched; ++i) {
                const std::size_t at = touched == sizeof bytes ? i : random() % sizeof bytes;
                bytes[at] = static_cast<unsigned char>(random() & 0xFFu);
            }
            std::memcpy(&bench.inputs, bytes, sizeof bytes);
            if (run % 3 == 2 && step % 50 == 0) bench.inputs.tach_present = 63;
            bench.step();
            for (const std::int8_t drive : bench.commands.drive_percent) {
                ASSERT_TRUE(drive >= -100 && drive <= 100);
            }
            rover::Estimates read;
            ASSERT_TRUE(rover::read_telemetry(bench.commands.telemetry,
                                              bench.commands.telemetry_size, read))
                << "run " << run << " step " << step;
            ASSERT_LE(read.available, 0x3F);
            ASSERT_LE(read.events, 0x7F);
            ASSERT_LE(read.faults, 0xFF);
            ASSERT_GE(read.sinkage_q4_mm, 0);
            ASSERT_GE(read.slip_percent, 0);
            ASSERT_LE(read.slip_percent, 84);
            ASSERT_LE(read.match_cost_q4, 64);
            ASSERT_LE(std::abs(read.height_front_q4_mm), 8000);
            ASSERT_LE(std::abs(read.height_middle_q4_mm), 8000);
            ASSERT_EQ(read.faults != 0, (read.events & rover::kEventSensorFault) != 0);
        }
    }
}

}  // namespace
