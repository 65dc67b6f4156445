// odometer_test.cpp - rim travel over long drives, with good and bad tachometers.
#include "firmware/inputs/odometer.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

namespace {

constexpr std::uint8_t kAll = 63;

struct Wheels {
    rover::Odometer odometer;
    hal::Calibration calibration;  // 13383 / 65536 mm a pulse
    hal::RawInputs inputs;
    std::array<double, 6> travel_mm = {};
    std::array<double, 6> phase = {};  // of the encoder, pulses
    double mm_per_pulse = calibration.tach_q16_mm_per_count / 65536.0;

    Wheels() { inputs.tach_present = kAll; }

    rover::OdometerStep start() { return step({}); }
    rover::OdometerStep step(const std::array<double, 6>& advance_mm) {
        for (std::size_t i = 0; i < 6; ++i) {
            travel_mm[i] += advance_mm[i];
            const auto pulses =
                static_cast<std::int64_t>(std::floor(travel_mm[i] / mm_per_pulse + phase[i]));
            inputs.tach_count[i] = static_cast<std::uint16_t>(pulses & 0xFFFF);
        }
        return rover::odometer_step(odometer, inputs, calibration);
    }
    [[nodiscard]] double measured_mm() const { return odometer.travel_q4_mm / 16.0; }
};

std::array<double, 6> all(double mm) {
    return {mm, mm, mm, mm, mm, mm};
}

TEST(Odometer, FirstStepOnlyRemembersTheCounters) {
    Wheels wheels;
    for (std::uint16_t& count : wheels.inputs.tach_count) count = 12345;
    const auto step = rover::odometer_step(wheels.odometer, wheels.inputs, wheels.calibration);
    EXPECT_TRUE(step.valid);
    EXPECT_FALSE(step.moving);
    EXPECT_EQ(step.travel_q4_mm, 0);
    EXPECT_EQ(wheels.odometer.travel_q4_mm, 0);
}

TEST(Odometer, HasNoDriftOverFiftyKilometresAndManyCounterWraps) {
    Wheels wheels;
    wheels.start();
    std::int64_t pulses = 0;
    std::int64_t sum_q4_mm = 0;
    for (int i = 0; i < 250000; ++i) {  // 0.2 m a step, 3,700 counter wraps
        const int now = 900 + i % 171;
        pulses += now;
        for (std::uint16_t& count : wheels.inputs.tach_count) {
            count = static_cast<std::uint16_t>(count + now);
        }
        sum_q4_mm +=
            rover::odometer_step(wheels.odometer, wheels.inputs, wheels.calibration).travel_q4_mm;
    }
    const std::int64_t exact_q4_mm = pulses * 13383 >> 12;  // Q16 to Q4, rounded down
    EXPECT_GT(exact_q4_mm, std::int64_t{50'000'000} * 16);
    EXPECT_EQ(wheels.odometer.travel_q4_mm, exact_q4_mm);
    EXPECT_EQ(sum_q4_mm, exact_q4_mm);
    EXPECT_EQ(wheels.odometer.turn_q4_mm, 0);
}

TEST(Odometer, BackwardsUndoesForwardsToTheLastBit) {
    Wheels wheels;
    wheels.start();
    for (int i = 0; i < 1000; ++i) wheels.step(all(0.731));
    for (int i = 0; i < 1000; ++i) wheels.step(all(-0.731));
    EXPECT_NEAR(wheels.measured_mm(), 0, 0.25);  // one pulse
}

// Wheels never count in the same step. The median of their pulses, taken anew in every step, would
// be wrong by 1.5 % at 4.9 pulses a step and by far more when crawling.
TEST(Odometer, IsExactWhenTheWheelsCountInTurnAtAnySpeed) {
    for (const double speed_mm : {0.03, 0.1, 0.37, 0.5, 1.0, 1.3, 7.7}) {
        for (const int present : {63, 0b001111, 0b111010, 0b010101, 0b000010}) {
            Wheels wheels;
            wheels.inputs.tach_present = static_cast<std::uint8_t>(present);
            for (std::size_t i = 0; i < 6; ++i) wheels.phase[i] = 0.37 * static_cast<double>(i);
            wheels.start();
            for (int i = 0; i < 20000; ++i) wheels.step(all(speed_mm));
            EXPECT_NEAR(wheels.measured_mm(), 20000 * speed_mm, 1.0)
                << "speed " << speed_mm << " mm a step, present " << present;
        }
    }
}

TEST(Odometer, FollowsTheMiddleWheelOfASideWhenSpeedsDiffer) {
    Wheels wheels;
    wheels.start();
    for (int i = 0; i < 20000; ++i) wheels.step({1.01, 1.02, 1.0, 1.0, 0.97, 0.99});
    EXPECT_NEAR(wheels.measured_mm(), 20000, 1.0);
    for (int i = 0; i < 20000; ++i) wheels.step({1.01, 1.02, 1.03, 1.0, 0.97, 0.99});
    EXPECT_NEAR(wheels.measured_mm(), 20000 + 20000 * 1.005, 3.0);
}

TEST(Odometer, TwoWheelsOfASideGiveTheirMeanEvenWhenOneIsFaster) {
    Wheels wheels;
    wheels.inputs.tach_present = 0b101111;  // rear left is missing
    wheels.start();
    for (int i = 0; i < 20000; ++i) wheels.step({1.02, 1.0, 1.0, 1.0, 0, 1.0});
    EXPECT_NEAR(wheels.measured_mm(), 20000 * 1.005, 1.0);
}

TEST(Odometer, ADeadOrRacingWheelOfThreeCostsTwoMillimetresAtMost) {
    for (const double bad : {0.0, 50.0, -3.0}) {
        for (std::size_t wheel = 0; wheel < 6; ++wheel) {
            Wheels wheels;
            wheels.start();
            auto advance = all(1.0);
            for (int i = 0; i < 3000; ++i) {
                advance[wheel] = i >= 1000 && i < 2000 ? bad : 1.0;
                wheels.step(advance);
            }
            EXPECT_NEAR(wheels.measured_mm(), 3000, 2.0) << "wheel " << wheel << " at " << bad;
        }
    }
}

TEST(Odometer, AnUpsetCounterIsNotDriven) {
    Wheels wheels;
    wheels.start();
    for (int i = 0; i < 100; ++i) wheels.step(all(1.0));
    for (const std::uint16_t jump : {std::uint16_t{0x8000}, std::uint16_t{1901}}) {
        const double before_mm = wheels.measured_mm();
        for (std::uint16_t& count : wheels.inputs.tach_count) {
            count = static_cast<std::uint16_t>(count + jump);
        }
        const auto step = rover::odometer_step(wheels.odometer, wheels.inputs, wheels.calibration);
        EXPECT_FALSE(step.moving);
        EXPECT_EQ(wheels.measured_mm(), before_mm);
    }
}

TEST(Odometer, TurningOnTheSpotIsHalfTheDifferenceOfTheSides) {
    Wheels wheels;
    wheels.start();
    for (int i = 0; i < 1000; ++i) wheels.step({-1, 1, -1, 1, -1, 1});
    EXPECT_NEAR(wheels.odometer.turn_q4_mm / 16.0, 1000, 0.3);
    EXPECT_NEAR(wheels.measured_mm(), 0, 0.3);
    for (int i = 0; i < 1000; ++i) wheels.step({0.5, 1.5, 0.5, 1.5, 0.5, 1.5});
    EXPECT_NEAR(wheels.odometer.turn_q4_mm / 16.0, 1500, 0.5);
    EXPECT_NEAR(wheels.measured_mm(), 1000, 0.5);
}

TEST(Odometer, ASideWithoutTachometersFollowsTheOther) {
    for (const int present : {0b010101, 0b101010}) {
        Wheels wheels;
        wheels.inputs.tach_present = static_cast<std::uint8_t>(present);
        wheels.start();
        for (int i = 0; i < 1000; ++i) EXPECT_TRUE(wheels.step({1, 2, 1, 2, 1, 2}).valid);
        EXPECT_NEAR(wheels.measured_mm(), present == 0b010101 ? 1000 : 2000, 0.3);
        EXPECT_EQ(wheels.odometer.turn_q4_mm, 0);
    }
}

TEST(Odometer, WithoutAnyTachometerNothingIsValidAndGarbageDoesNotMove) {
    Wheels wheels;
    wheels.inputs.tach_present = 0;
    wheels.start();
    const auto step = wheels.step(all(5));
    EXPECT_FALSE(step.valid);
    EXPECT_FALSE(step.moving);
    EXPECT_EQ(wheels.measured_mm(), 0);
}

TEST(Odometer, AnAbsentWheelThatCountsDoesNotCountAsMoving) {
    Wheels wheels;
    wheels.inputs.tach_present = 0b111110;
    wheels.start();
    EXPECT_FALSE(wheels.step({1, 0, 0, 0, 0, 0}).moving);
    EXPECT_TRUE(wheels.step({0, 0, 0, 0, 0, 1}).moving);
}

TEST(Odometer, AWheelThatComesBackStandsWhereItsSideStands) {
    Wheels wheels;
    wheels.start();
    for (int i = 0; i < 100; ++i) wheels.step(all(1.0));
    wheels.inputs.tach_present = 0b111011;
    for (int i = 0; i < 100; ++i) wheels.step({1, 1, 7, 1, 1, 1});
    wheels.inputs.tach_present = kAll;
    for (int i = 0; i < 100; ++i) wheels.step(all(1.0));
    EXPECT_NEAR(wheels.measured_mm(), 300, 0.5);
    EXPECT_FALSE(rover::tachometers_disagree(wheels.odometer, wheels.calibration));
}

// A change drops leads, which are below a pulse at equal speeds.
TEST(Odometer, WheelsOfASideMayComeAndGo) {
    Wheels wheels;
    for (std::size_t i = 0; i < 6; ++i) wheels.phase[i] = 0.37 * static_cast<double>(i);
    wheels.start();
    double travel_mm = 0;
    const std::array<int, 8> present = {63,       0b111110, 0b101110, 0b001110,
                                        0b111110, 63,       0b011011, 0b011001};
    for (std::size_t i = 0; i < 8000; ++i) {
        wheels.inputs.tach_present = static_cast<std::uint8_t>(present[i / 100 % present.size()]);
        wheels.step(all(0.731));
        travel_mm += 0.731;
    }
    EXPECT_NEAR(wheels.measured_mm(), travel_mm, 80 * wheels.mm_per_pulse);
}

TEST(TachometersDisagree, MoreThanFifteenMillimetresInACycleAndClearsTheCounts) {
    for (const double off_mm : {-15.5, -14.5, 14.5, 15.5}) {
        for (std::size_t wheel = 0; wheel < 6; ++wheel) {
            Wheels wheels;
            wheels.start();
            auto advance = all(1.0);
            advance[wheel] += off_mm / 60;
            for (int i = 0; i < 60; ++i) wheels.step(advance);
            EXPECT_EQ(rover::tachometers_disagree(wheels.odometer, wheels.calibration),
                      std::abs(off_mm) > 15)
                << off_mm;
            EXPECT_FALSE(rover::tachometers_disagree(wheels.odometer, wheels.calibration));
        }
    }
}

TEST(TachometersDisagree, ADeadWheelOfTwoAndARacingOneThatHasGone) {
    for (const bool gone : {false, true}) {
        Wheels wheels;
        wheels.inputs.tach_present = gone ? kAll : 0b111110;
        wheels.start();
        auto advance = all(1.0);
        advance[2] = gone ? 9 : 0;
        for (int i = 0; i < 60; ++i) {
            if (gone && i == 30) wheels.inputs.tach_present = 0b111011;
            wheels.step(advance);
        }
        EXPECT_TRUE(rover::tachometers_disagree(wheels.odometer, wheels.calibration));
        // The one that has gone is not judged any more.
        for (int i = 0; i < 60; ++i) wheels.step(advance);
        EXPECT_EQ(rover::tachometers_disagree(wheels.odometer, wheels.calibration), !gone);
    }
}

TEST(Median3, IsTheMiddleOneInEveryOrder) {
    std::array<std::int16_t, 3> values = {-5, 3, 2047};
    do {
        EXPECT_EQ(rover::median3(values[0], values[1], values[2]), 3);
    } while (std::next_permutation(values.begin(), values.end()));
    EXPECT_EQ(rover::median3(std::int16_t{4}, std::int16_t{4}, std::int16_t{-9}), 4);
}

}  // namespace
