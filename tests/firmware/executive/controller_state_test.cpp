// controller_state_test.cpp - reset and the check of the calibration record.
#include "firmware/executive/controller_state.hpp"

#include <gtest/gtest.h>

namespace {

TEST(ControllerReset, TakesAValidRecordAndForgetsEverything) {
    rover::Controller controller;
    controller.started = true;
    controller.odometer.travel_q4_mm = 55;
    hal::Calibration calibration;
    calibration.angle[1] = {30000, 16000, true};
    calibration.wheel_radius_q4_mm = 999;
    rover::controller_reset(controller, calibration);
    EXPECT_FALSE(controller.started);
    EXPECT_EQ(controller.odometer.travel_q4_mm, 0);
    EXPECT_EQ(controller.calibration_fault, 0);
    EXPECT_EQ(controller.calibration.angle[1].zero_q4_count, 30000);
    EXPECT_EQ(controller.calibration.wheel_radius_q4_mm, 999);
}

TEST(ControllerReset, ReplacesAnInvalidRecordByTheNominalOne) {
    const auto refused = [](auto change) {
        hal::Calibration calibration;
        calibration.angle[0].gain_q16 = 1;
        change(calibration);
        rover::Controller controller;
        rover::controller_reset(controller, calibration);
        return !rover::is_valid(calibration) &&
               controller.calibration_fault == rover::kFaultCalibration &&
               controller.calibration.angle[0].gain_q16 == hal::kPotentiometerGainQ16 &&
               controller.calibration.version == hal::kCalibrationVersion;
    };
    EXPECT_TRUE(refused([](hal::Calibration& c) { c.version = 0; }));
    EXPECT_TRUE(refused([](hal::Calibration& c) { c.version = 2; }));
    EXPECT_TRUE(refused([](hal::Calibration& c) { c.tach_q16_mm_per_count = 0; }));
    EXPECT_TRUE(refused([](hal::Calibration& c) { c.tach_counts_per_turn = 0; }));
    EXPECT_TRUE(refused([](hal::Calibration& c) { c.wheel_radius_q4_mm = 0; }));
    EXPECT_FALSE(refused([](hal::Calibration&) {}));
}

}  // namespace
