// motor_commands_test.cpp - percent to duty and direction.
#include "firmware/executive/motor_commands.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace {

TEST(DriveDuty, IsTheNearestForEveryPercent) {
    for (int percent = -128; percent <= 127; ++percent) {
        const double exact = std::min(std::abs(percent), 100) * 255.0 / 100.0;
        EXPECT_EQ(rover::drive_duty(static_cast<std::int8_t>(percent)),
                  static_cast<int>(std::floor(exact + 0.5)))
            << percent;
    }
}

TEST(DriveLatches, EveryWheelHasItsOwnDutyAndDirection) {
    hal::Commands commands;
    const std::int8_t percents[6] = {100, -100, 0, 0, -1, 50};
    for (std::size_t i = 0; i < 6; ++i) commands.drive_percent[i] = percents[i];
    rover::DriveLatches latches;
    rover::drive_latches(commands, latches);
    const std::uint8_t duties[6] = {255, 255, 0, 0, 3, 128};
    for (std::size_t i = 0; i < 6; ++i) EXPECT_EQ(latches.duty[i], duties[i]) << i;
    EXPECT_EQ(latches.backward, 0b010010);
}

TEST(DriveLatches, NothingIsRememberedFromTheLastStep) {
    hal::Commands commands;
    rover::DriveLatches latches;
    for (std::int8_t& percent : commands.drive_percent) percent = -77;
    rover::drive_latches(commands, latches);
    commands = {};
    rover::drive_latches(commands, latches);
    for (const std::uint8_t duty : latches.duty) EXPECT_EQ(duty, 0);
    EXPECT_EQ(latches.backward, 0);
}

}  // namespace
