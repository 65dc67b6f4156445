// Counts as the board would show them, against the board's own description: 12 bits over +-75 deg,
// sums of 16 conversions, 16-bit counters.
#include "host_sim/import/board_counts.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

namespace {

using namespace host_sim;

TEST(InclinometerCode, SpansTheRangeAndHoldsAtTheRails) {
    EXPECT_EQ(inclinometer_code(-75), 0);
    EXPECT_EQ(inclinometer_code(-90), 0);
    EXPECT_EQ(inclinometer_code(74.99), 4095);
    EXPECT_EQ(inclinometer_code(90), 4095);
    EXPECT_EQ(inclinometer_code(0), 2048);
    EXPECT_EQ(inclinometer_code(-1e-9), 2047);
}

// The gain and zero of the nominal record must give back the angle: within half a code (0.018 deg)
// for a single code, everywhere in the range.
TEST(InclinometerCode, ReadsBackWithTheNominalRecord) {
    for (double angle_deg = -74.9; angle_deg < 74.9; angle_deg += 0.0137) {
        const double q4_count = 16.0 * inclinometer_code(angle_deg);
        const double read_brad = (q4_count - 32760) * hal::kInclinometerGainQ16 / 65536;
        const double read_deg = read_brad * 360 / 65536;
        ASSERT_NEAR(read_deg, angle_deg, 150.0 / 4096 / 2 + 0.002) << angle_deg;
    }
}

TEST(SumOf16, KeepsTheMeanOfTheStep) {
    const std::vector<std::uint16_t> ten(10, 2048);
    EXPECT_EQ(sum_of_16_q4_count(ten), 16 * 2048);
    const std::vector<std::uint16_t> mixed = {2047, 2048, 2048, 2048, 2048,
                                              2048, 2048, 2048, 2048, 2048};
    EXPECT_EQ(sum_of_16_q4_count(mixed), 32766);  // 20479 * 1.6 = 32766.4
    const std::vector<std::uint16_t> half = {2047, 2047, 2047, 2047, 2047,
                                             2048, 2048, 2048, 2048, 2048};
    EXPECT_EQ(sum_of_16_q4_count(half), 32760);
    const std::vector<std::uint16_t> five_halves = {0, 0, 0, 0, 0, 0, 0, 0, 1, 4};
    EXPECT_EQ(sum_of_16_q4_count(five_halves), 8);
}

TEST(SumOf16, RoundsHalfUpAndStaysInRange) {
    const std::vector<std::uint16_t> tie(32 / 2, 4095);
    EXPECT_EQ(sum_of_16_q4_count(tie), hal::kAdcMaxQ4Count);
    // 1 code over 32/ n: n = 3, sum 3 -> 16; n = 3, sum 1 -> 5.33; sum 2 -> 10.67.
    EXPECT_EQ(sum_of_16_q4_count(std::vector<std::uint16_t>{1, 0, 0}), 5);
    EXPECT_EQ(sum_of_16_q4_count(std::vector<std::uint16_t>{1, 1, 0}), 11);
}

TEST(CounterValue, FloorsAndWraps) {
    EXPECT_EQ(counter_value(0.99), 0);
    EXPECT_EQ(counter_value(65536.5), 0);
    EXPECT_EQ(counter_value(-0.01), 65535);
    EXPECT_EQ(counter_value(-65537), 65535);
}

TEST(WheelCalibration, AgreesWithTheCircumference) {
    for (const double radius_mm : {40.0, 40 / std::cos(std::numbers::pi / 6), 65.0, 165.1}) {
        const hal::Calibration calibration = wheel_calibration(radius_mm);
        const double mm_per_turn = calibration.tach_q16_mm_per_count / 65536.0 * 2000;
        EXPECT_NEAR(mm_per_turn / (2 * std::numbers::pi * radius_mm), 1, 7e-5) << radius_mm;
        EXPECT_NEAR(calibration.wheel_radius_q4_mm / 16.0, radius_mm, 1.0 / 32);
        EXPECT_EQ(calibration.tach_counts_per_turn, 2000);
        EXPECT_EQ(calibration.version, hal::kCalibrationVersion);
        for (int pot = 0; pot < 3; ++pot) EXPECT_EQ(calibration.angle[pot].gain_q16, 0);
        for (int axis = 3; axis < 5; ++axis) {
            EXPECT_EQ(calibration.angle[axis].gain_q16, hal::kInclinometerGainQ16);
            EXPECT_EQ(calibration.angle[axis].zero_q4_count, 32760);
        }
    }
}

TEST(AbsentInputs, HasNoSensorAtAll) {
    hal::RawInputs inputs = absent_inputs();
    for (const std::uint16_t count : inputs.adc_q4_count) EXPECT_EQ(count, hal::kAdcAbsent);
    EXPECT_EQ(inputs.tach_present, 0);
    EXPECT_EQ(inputs.range_present, 0);
    EXPECT_EQ(inputs.command_size, 0);
    set_tach(inputs, hal::Wheel::rear_right, 7);
    EXPECT_EQ(inputs.tach_present, 0x20);
    EXPECT_EQ(inputs.tach_count[5], 7);
}

}  // namespace
