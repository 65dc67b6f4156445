// atan2_test.cpp - directions against the arctangent in double.
#include "firmware/core/atan2.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace {

int16_t angle_of(int32_t y, int32_t x) {
    return rover::atan2_brad(static_cast<int16_t>(y), static_cast<int16_t>(x));
}

double error_brad(int32_t y, int32_t x) {
    const double real = std::atan2(y, x) * 32768.0 / std::numbers::pi;
    return std::abs(std::remainder(angle_of(y, x) - real, 65536.0));
}

TEST(Atan2, ErrorIsAtMostOneBrad) {
    for (int32_t y = -32768; y <= 32767; ++y) {
        double worst = 0.0;
        // The stride starts anew for each y, so that x takes every value.
        for (int32_t x = -32768 + (y & 0xFF); x <= 32767; x += 257) {
            worst = std::max(worst, error_brad(y, x));
        }
        ASSERT_LE(worst, 1.0) << "y = " << y;
    }
}

TEST(Atan2, ErrorIsAtMostOneBradForEverySmallVector) {
    for (int32_t y = -300; y <= 300; ++y) {
        for (int32_t x = -300; x <= 300; ++x) {
            if (x == 0 && y == 0) continue;
            ASSERT_LE(error_brad(y, x), 1.0) << y << ", " << x;
        }
    }
}

TEST(Atan2, IsZeroAtTheOrigin) {
    EXPECT_EQ(angle_of(0, 0), 0);
}

TEST(Atan2, IsExactOnTheAxesAndDiagonals) {
    for (int32_t length = 1; length <= 32767; ++length) {
        ASSERT_EQ(angle_of(0, length), 0);
        ASSERT_EQ(angle_of(length, length), 0x2000);
        ASSERT_EQ(angle_of(length, 0), 0x4000);
        ASSERT_EQ(angle_of(length, -length), 0x6000);
        ASSERT_EQ(angle_of(0, -length), -0x8000);
        ASSERT_EQ(angle_of(-length, -length), -0x6000);
        ASSERT_EQ(angle_of(-length, 0), -0x4000);
        ASSERT_EQ(angle_of(-length, length), -0x2000);
    }
}

TEST(Atan2, MirroredVectorsHaveMirroredAngles) {
    for (int32_t y = 1; y <= 32767; y += 31) {
        for (int32_t x = 1; x <= 32767; x += 37) {
            const int32_t angle = angle_of(y, x);
            ASSERT_EQ(angle_of(-y, x), -angle);
            ASSERT_EQ(angle_of(y, -x), static_cast<int16_t>(0x8000 - angle));
            ASSERT_EQ(angle_of(x, y), 0x4000 - angle);
        }
    }
}

TEST(Atan2, OfLengthsIsTheSame) {
    EXPECT_EQ(rover::atan2(rover::Q4Mm{3000}, rover::Q4Mm{-400}),
              rover::Brad16{angle_of(3000, -400)});
    EXPECT_EQ(rover::atan2(int16_t{3000}, int16_t{-400}), rover::Brad16{angle_of(3000, -400)});
}

TEST(Arctangent, BeyondOneReadsAsOne) {
    EXPECT_EQ(rover::arctangent_brad(uint16_t{32768}), 8192);
    EXPECT_EQ(rover::arctangent_brad(uint16_t{65535}), 8192);
}

}  // namespace
