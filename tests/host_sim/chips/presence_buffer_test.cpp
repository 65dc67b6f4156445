// presence_buffer_test.cpp - the presence buffer against docs/chips/presence-buffer.md.
#include "host_sim/chips/presence_buffer.hpp"

#include <gtest/gtest.h>

namespace {

using host_sim::chips::kNever;
using host_sim::chips::PresenceBuffer;

TEST(PresenceBuffer, StartsWithAllPluggedIn) {
    PresenceBuffer buffer;
    EXPECT_EQ(buffer.read(0, 5), 0xFF);
    EXPECT_EQ(buffer.next_event_t(), kNever);
}

TEST(PresenceBuffer, EachWheelHasItsBitAndTheUpperTwoStayHigh) {
    for (unsigned wheel = 0; wheel < 6; ++wheel) {
        PresenceBuffer buffer;
        buffer.set_connected(wheel, false);
        EXPECT_EQ(buffer.read(0, 0), 0xFF ^ 1 << wheel);
        buffer.reset();
        EXPECT_EQ(buffer.read(0, 0), 0xFF ^ 1 << wheel) << "no RESET pin";
        buffer.set_connected(wheel, true);
        EXPECT_EQ(buffer.read(0, 0), 0xFF);
    }
    PresenceBuffer none;
    for (unsigned wheel = 0; wheel < 6; ++wheel) none.set_connected(wheel, false);
    EXPECT_EQ(none.read(0, 0), 0xC0);
    EXPECT_EQ(none.properties().at(0).value, "000000b");
}

}  // namespace
