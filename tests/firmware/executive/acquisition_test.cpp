// acquisition_test.cpp - inputs from parts that answer, and from parts that do not.
#include "firmware/executive/acquisition.hpp"

#include <gtest/gtest.h>

#include <array>

namespace {

struct Parts {
    static inline std::array<std::uint16_t, 16> sums{};
    static inline hal::RangeStatus range_status = hal::RangeStatus::ok;
    static inline hal::RangeFrame scan{};

    struct AnalogInputs {
        static bool sum_of_16(std::uint8_t channel, std::uint16_t& sum) {
            sum = sums[channel];
            return sum != hal::kAdcAbsent;
        }
    };
    struct Range {
        static hal::RangeStatus read(hal::RangeFrame& frame) {
            frame = scan;
            return range_status;
        }
    };
};

TEST(ReadConverter, SamplesTheFiveAnglesAndLeavesTheRestAbsent) {
    for (std::uint16_t i = 0; i < 16; ++i) Parts::sums[i] = static_cast<std::uint16_t>(1000 * i);
    hal::RawInputs inputs;
    rover::begin_converter(inputs);
    rover::read_converter<Parts>(inputs, [] { FAIL() << "all answer"; });
    for (std::uint16_t i = 0; i < hal::kAdcChannelCount; ++i) {
        EXPECT_EQ(inputs.adc_q4_count[i], i < 5 ? 1000 * i : 0xFFFF) << i;
    }
}

TEST(ReadConverter, AChannelWithoutAnswerIsAbsentAndTold) {
    for (std::uint16_t& sum : Parts::sums) sum = 7;
    Parts::sums[3] = hal::kAdcAbsent;
    hal::RawInputs inputs;
    static int absent;
    absent = 0;
    rover::read_converter<Parts>(inputs, [] { ++absent; });
    EXPECT_EQ(absent, 1);
    EXPECT_EQ(inputs.adc_q4_count[3], hal::kAdcAbsent);
    EXPECT_EQ(inputs.adc_q4_count[4], 7);
}

TEST(ReadRange, TakesAScanAndKeepsTheCountWithoutOne) {
    Parts::scan = {9, 0x83, {1, -2, 3, -4, 5, -6, 7, -8}};
    Parts::range_status = hal::RangeStatus::ok;
    hal::RawInputs inputs;
    rover::read_range<Parts>(inputs);
    EXPECT_EQ(inputs.range_scan_count, 9);
    EXPECT_EQ(inputs.range_present, 0x83);
    EXPECT_EQ(inputs.range_q1_mm[1], -2);
    EXPECT_EQ(inputs.range_q1_mm[7], -8);
    for (const auto status : {hal::RangeStatus::absent, hal::RangeStatus::checksum}) {
        Parts::range_status = status;
        Parts::scan = {200, 0xFF, {}};
        rover::read_range<Parts>(inputs);
        EXPECT_EQ(inputs.range_present, 0);
        EXPECT_EQ(inputs.range_scan_count, 9);
    }
}

}  // namespace
