// wheel_counts_test.cpp - pulses with direction, and readings of one moment.
#include "firmware/executive/wheel_counts.hpp"

#include <gtest/gtest.h>

namespace {

/// Counters as they read: garbage until the first pulse, then the complement of the number of
/// pulses (docs/chips/i82c54.md).
struct Counters {
    std::uint32_t pulses[6] = {};
    std::uint16_t garbage = 0x3C3C;

    [[nodiscard]] std::uint16_t read(std::size_t wheel) const {
        return pulses[wheel] == 0 ? garbage : static_cast<std::uint16_t>(~pulses[wheel]);
    }
};

TEST(CountWheels, ForwardCountsUpBackwardDownAcrossEveryWrap) {
    for (const unsigned garbage : {0U, 1U, 0x3C3CU, 0xFFFFU}) {
        Counters counters;
        counters.garbage = static_cast<std::uint16_t>(garbage);
        rover::WheelCount wheels[6];
        for (auto& wheel : wheels) wheel.now = wheel.last = counters.garbage;
        std::int64_t expected[6] = {};
        for (unsigned reading = 0; reading < 4000; ++reading) {
            std::uint8_t forward = 0;
            for (std::size_t w = 0; w < 6; ++w) {
                const auto more =
                    static_cast<std::uint32_t>((reading * 7 + w * 31) % (40 + 6000 * w));
                const bool ahead = (reading / 100 + w) % 3 != 1;
                counters.pulses[w] += more;
                expected[w] += ahead ? more : -static_cast<std::int64_t>(more);
                if (ahead) forward = static_cast<std::uint8_t>(forward | (1U << w));
                wheels[w].now = counters.read(w);
            }
            rover::count_wheels(wheels, forward);
            for (std::size_t w = 0; w < 6; ++w) {
                ASSERT_EQ(wheels[w].count, static_cast<std::uint16_t>(expected[w]))
                    << "garbage " << garbage << " wheel " << w << " reading " << reading;
            }
        }
    }
}

// The first pulse loads FFFEh; a counter that held FFFEh shows it with the second.
TEST(CountWheels, NoPulseIsLostWhenTheCounterHeldWhatItIsLoadedWith) {
    rover::WheelCount wheels[6];
    wheels[2].now = wheels[2].last = 0xFFFE;
    rover::count_wheels(wheels, 0x3F);
    EXPECT_EQ(wheels[2].count, 0);
    wheels[2].now = 0xFFFD;
    rover::count_wheels(wheels, 0x3F);
    EXPECT_EQ(wheels[2].count, 2);
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
