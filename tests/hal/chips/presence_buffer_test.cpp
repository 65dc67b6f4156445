// presence_buffer_test.cpp - the driver of the presence buffer: docs/chips/presence-buffer.md.
#include "hal/chips/presence_buffer.hpp"

#include <gtest/gtest.h>

#include "tests/hal/chips/parts.hpp"

namespace {

TEST(PresenceBufferDriver, IsOneAccessWithoutTheUpperBits) {
    hal_test::Script bus;
    bus.in(0x2C, {0xFF, 0xED});
    EXPECT_EQ(hal_test::Recorded::Presence::wheels(), 0x3F);
    EXPECT_EQ(hal_test::Recorded::Presence::wheels(), 0x2D);
    EXPECT_EQ(bus.accesses(), "<2C <2C");
}

TEST(PresenceBufferDriver, SeesEachPlug) {
    for (uint8_t wheel = 0; wheel < 6; ++wheel) {
        hal_test::SimBoard board;
        board.apply(hal_test::Stimulus::Kind::tach_connected, wheel, 0);
        EXPECT_EQ(hal_test::Simulated::Presence::wheels(), 0x3F ^ 1 << wheel);
        EXPECT_EQ(board.state.violation_count, 0U);
    }
}

}  // namespace
