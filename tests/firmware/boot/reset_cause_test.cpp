// reset_cause_test.cpp - what is told about the last reset, and how the timer is asked.
#include "firmware/boot/reset_cause.hpp"

#include <gtest/gtest.h>

#include "host_sim/chips/i82c54.hpp"

namespace {

using rover::ResetCause;

TEST(ResetCause, FromWhatOutlivedTheReset) {
    for (int quiet = 0; quiet < 256; ++quiet) {
        const auto ticks = static_cast<std::uint8_t>(quiet);
        EXPECT_EQ(rover::reset_cause(false, 0x57, ticks), ResetCause::power_up);
        EXPECT_EQ(rover::reset_cause(true, 0x57, ticks), ResetCause::restart);
        EXPECT_EQ(rover::reset_cause(true, 0x43, ticks), ResetCause::restart);
        EXPECT_EQ(rover::reset_cause(true, 0x52, ticks),
                  quiet >= 40 ? ResetCause::watchdog : ResetCause::other);
    }
}

/// Timer A of the board.
struct Bus {
    static inline host_sim::chips::I82c54 timer{};
    static inline std::uint64_t t = 0;

    template <std::uint8_t kPort>
    static std::uint8_t in() {
        return timer.read(kPort - 0x10, t += 10);
    }
    template <std::uint8_t kPort>
    static void out(std::uint8_t value) {
        timer.write(kPort - 0x10, value, t += 10);
    }
};

TEST(ResetCause, TheTimerKeepsItsModeUntilPowerIsLost) {
    Bus::timer = {};
    Bus::timer.set_periodic_clock(0, 1);
    EXPECT_FALSE(rover::timer_kept_its_mode<Bus>());
    Bus::out<0x13>(0x34);  // counter 0, two bytes, mode 2
    Bus::out<0x10>(0x00);
    Bus::out<0x10>(0x78);
    EXPECT_TRUE(rover::timer_kept_its_mode<Bus>());
    Bus::out<0x13>(0x36);  // mode 3
    EXPECT_FALSE(rover::timer_kept_its_mode<Bus>());
}

}  // namespace
