// calibration_frame_test.cpp - the record as bytes: places by hand.
#include "firmware/link/calibration_frame.hpp"

#include <gtest/gtest.h>

namespace {

TEST(CalibrationFrame, BytesAreInTheOrderOfThePage) {
    hal::Calibration calibration;
    calibration.version = 0x0102;
    for (std::uint8_t i = 0; i < 5; ++i) {
        calibration.angle[i] = {static_cast<std::uint16_t>(0x1000 + i),
                                static_cast<std::uint16_t>(0x2000 + i), i % 2 == 1};
    }
    calibration.wheel_radius_q4_mm = 0x3132;
    calibration.tach_counts_per_turn = 0x4142;
    calibration.tach_q16_mm_per_count = 0x5152;
    calibration.range_offset_q1_mm = -2;
    std::uint8_t bytes[rover::kCalibrationBytes];
    rover::write_calibration(calibration, bytes);
    const std::uint8_t expected[35] = {
        0x02, 0x01,                    // version
        0x00, 0x10, 0x00, 0x20, 0x00,  // left bogie: zero, gain, inverted
        0x01, 0x10, 0x01, 0x20, 0x01,  // right bogie
        0x02, 0x10, 0x02, 0x20, 0x00,  // differential
        0x03, 0x10, 0x03, 0x20, 0x01,  // pitch
        0x04, 0x10, 0x04, 0x20, 0x00,  // roll
        0x32, 0x31, 0x42, 0x41, 0x52, 0x51, 0xFE, 0xFF};
    for (std::size_t i = 0; i < 35; ++i) EXPECT_EQ(bytes[i], expected[i]) << "byte " << i;
}

}  // namespace
