// wheel_counts_test.cpp - pulses with direction, and readings of one moment.
#include "firmware/executive/wheel_counts.hpp"

#include <gtest/gtest.h>

namespace {

TEST(CountWheel, ForwardCountsUpBackwardDownAcrossEveryWrap) {
    rover::WheelCount wheel;
    std::uint32_t pulses = 65000;
    wheel.pulses = static_cast<std::uint16_t>(pulses);
    std::int64_t expected = 0;
    for (int i = 0; i < 2000; ++i) {
        const std::uint32_t more = static_cast<std::uint32_t>(i * 7 % 90);
        const bool forward = i / 100 % 2 == 1;
        pulses += more;
        expected += forward ? more : -static_cast<std::int64_t>(more);
        rover::count_wheel(wheel, static_cast<std::uint16_t>(pulses), forward);
        ASSERT_EQ(wheel.count, static_cast<std::uint16_t>(expected)) << i;
    }
}

TEST(ReadWheels, CopiesTickAndCounts) {
    volatile std::uint16_t tick = 0x1234;
    rover::WheelCount wheels[6];
    for (std::uint16_t w = 0; w < 6; ++w) wheels[w].count = static_cast<std::uint16_t>(300 * w);
    hal::RawInputs inputs;
    rover::read_wheels(tick, wheels, inputs);
    EXPECT_EQ(inputs.tick_count, 0x1234);
    for (std::uint16_t w = 0; w < 6; ++w) EXPECT_EQ(inputs.tach_count[w], 300 * w);
}

}  // namespace
