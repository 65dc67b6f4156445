// sine_test.cpp - every angle against the sine in double.
#include "firmware/core/sine.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace {

double real_sine_q14(int32_t angle_brad) {
    return 16384.0 * std::sin(angle_brad * std::numbers::pi / 32768.0);
}

TEST(Sine, ErrorIsAtMostOneLsbAndATenthAtEveryAngle) {
    for (int32_t angle = -32768; angle <= 32767; ++angle) {
        const double error = rover::sine_q14(static_cast<int16_t>(angle)) - real_sine_q14(angle);
        ASSERT_LE(std::abs(error), 1.1) << angle;
    }
}

TEST(Cosine, ErrorIsAtMostOneLsbAndATenthAtEveryAngle) {
    for (int32_t angle = -32768; angle <= 32767; ++angle) {
        const double real = 16384.0 * std::cos(angle * std::numbers::pi / 32768.0);
        const double error = rover::cosine_q14(static_cast<int16_t>(angle)) - real;
        ASSERT_LE(std::abs(error), 1.1) << angle;
    }
}

TEST(Sine, IsOddAndSymmetricAboutAQuarterTurn) {
    for (int32_t angle = -32767; angle <= 32767; ++angle) {
        const int16_t sine = rover::sine_q14(static_cast<int16_t>(angle));
        ASSERT_EQ(rover::sine_q14(static_cast<int16_t>(-angle)), -sine) << angle;
        ASSERT_EQ(rover::sine_q14(static_cast<int16_t>(32768 - angle)), sine) << angle;
    }
}

TEST(Sine, SaturatesAtAQuarterTurnAndIsZeroAtHalfATurn) {
    EXPECT_EQ(rover::sine_q14(int16_t{0}), 0);
    EXPECT_EQ(rover::sine_q14(int16_t{0x4000}), 16383);
    EXPECT_EQ(rover::sine_q14(int16_t{-0x4000}), -16383);
    EXPECT_EQ(rover::sine_q14(int16_t{-0x8000}), 0);
}

TEST(Sine, OfUnitsIsTheSame) {
    EXPECT_EQ(rover::sine(rover::Brad16{1234}),
              rover::Q15{static_cast<int16_t>(2 * rover::sine_q14(int16_t{1234}))});
    EXPECT_EQ(rover::cosine(rover::Brad16{1234}),
              rover::Q15{static_cast<int16_t>(2 * rover::cosine_q14(int16_t{1234}))});
}

}  // namespace
