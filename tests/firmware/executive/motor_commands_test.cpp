// motor_commands_test.cpp - percent to duty and direction.
#include "firmware/executive/motor_commands.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

namespace {

TEST(DriveDuty, IsTheNearestForEveryPercent) {
    for (int percent = -128; percent <= 127; ++percent) {
        const double exact = std::min(std::abs(percent), 100) * 255.0 / 100.0;
        EXPECT_EQ(rover::drive_duty(static_cast<std::int8_t>(percent)),
                  static_cast<int>(std::floor(exact + 0.5)))
            << percent;
    }
}

/// The latches of a test, one kind for each: what they remember is their own.
template <int kTest>
struct Latches {
    static inline std::string seen{};
    static void direct_drive(std::uint8_t backward) { seen += "sign " + std::to_string(backward); }
    static void put_drive(std::uint8_t duty) { seen += ", all " + std::to_string(duty); }
    template <std::uint8_t kMotor>
    static void put_drive(std::uint8_t duty) {
        seen += ", " + std::to_string(kMotor) + ": " + std::to_string(duty);
    }
};

TEST(DriveMotors, EveryWheelHasItsOwnDutyAndDirection) {
    const std::int8_t percents[6] = {100, -100, 0, 0, -1, 50};
    rover::drive_motors<Latches<1>>(percents);
    EXPECT_EQ(Latches<1>::seen, "sign 18, 0: 255, 1: 255, 2: 0, 3: 0, 4: 3, 5: 128");
}

TEST(DriveMotors, OneWheelApartIsSeen) {
    for (std::size_t apart = 0; apart < 6; ++apart) {
        std::int8_t percents[6] = {-40, -40, -40, -40, -40, -40};
        percents[apart] = 40;
        EXPECT_FALSE(rover::is_straight(percents));
        EXPECT_EQ(rover::backward_wheels(percents), 63U & ~(1U << apart));
    }
}

TEST(DriveMotors, AllAlikeIsOneDuty) {
    const std::int8_t back[6] = {-77, -77, -77, -77, -77, -77};
    rover::drive_motors<Latches<2>>(back);
    EXPECT_EQ(Latches<2>::seen, "sign 63, all 196");
    const std::int8_t rest[6] = {};
    rover::drive_motors<Latches<3>>(rest);
    EXPECT_EQ(Latches<3>::seen, "sign 0, all 0");
}

}  // namespace
