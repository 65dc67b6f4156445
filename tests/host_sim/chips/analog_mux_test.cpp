// analog_mux_test.cpp - channels and settling. 2640 ns * 3.072 MHz = 8.1 -> 9 T.
#include "host_sim/chips/analog_mux.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>

#include "host_sim/chips/settling.hpp"

namespace {

using host_sim::chips::AnalogMux;
using host_sim::chips::settle_uv;

constexpr uint64_t kClockHz = 3'072'000;

TEST(Settling, HalvesThirteenTimes) {
    // With 13 T every T-state is one half of the way that is left: 8192 = 2^13.
    EXPECT_EQ(settle_uv(8192, 0, 0, 13), 8192);
    EXPECT_EQ(settle_uv(8192, 0, 1, 13), 4096);
    EXPECT_EQ(settle_uv(8192, 0, 2, 13), 2048);
    EXPECT_EQ(settle_uv(8192, 0, 12, 13), 2);
    EXPECT_EQ(settle_uv(8192, 0, 13, 13), 0);
    EXPECT_EQ(settle_uv(0, 8192, 1, 13), 4096);
    EXPECT_EQ(settle_uv(-100, 100, 1, 13), 0);
    EXPECT_EQ(settle_uv(7, 100, 0, 0), 100) << "no settling time: at once";
    EXPECT_EQ(settle_uv(INT32_MIN, INT32_MAX, 0, 13), INT32_MIN);
}

RC_GTEST_PROP(Settling, GoesOneWayAndStaysBetweenTheEnds, (int32_t from, int32_t to)) {
    const auto total = *rc::gen::inRange<uint64_t>(1, 200);
    int32_t last = from;
    for (uint64_t t = 0; t <= total; ++t) {
        const int32_t now = settle_uv(from, to, t, total);
        RC_ASSERT(now >= std::min(last, to));
        RC_ASSERT(now <= std::max(last, to));
        last = now;
    }
    RC_ASSERT(last == to);
}

TEST(AnalogMux, EverySelectedInputReachesTheOutput) {
    AnalogMux mux(kClockHz);
    for (unsigned i = 0; i < 16; ++i) mux.set_input(i, static_cast<int32_t>(i) * 1000 + 7);
    uint64_t t = 1000;
    for (unsigned i = 0; i < 32; ++i) {
        mux.select(i, t += 20);
        EXPECT_EQ(mux.output_uv(t + 9), static_cast<int32_t>(i % 16) * 1000 + 7);
    }
}

TEST(AnalogMux, OutputMovesFromTheOldChannelToTheNewInNineTStates) {
    AnalogMux mux(kClockHz);
    EXPECT_EQ(mux.settling_t, 9u);
    mux.set_input(0, 4'000'000);
    mux.set_input(1, 0);
    mux.select(1, 1000);
    EXPECT_EQ(mux.output_uv(1000), 4'000'000);
    EXPECT_EQ(mux.output_uv(1001), 2'000'000) << "13 * 1 / 9 = 1 half-life";
    EXPECT_EQ(mux.output_uv(1002), 1'000'000) << "13 * 2 / 9 = 2";
    EXPECT_EQ(mux.output_uv(1008), 1953) << "13 * 8 / 9 = 11: 4,000,000 / 2048";
    EXPECT_FALSE(mux.settled(1008));
    EXPECT_TRUE(mux.settled(1009));
    EXPECT_EQ(mux.output_uv(1009), 0);
}

TEST(AnalogMux, ChangeInTheMiddleStartsFromWhereTheOutputIs) {
    AnalogMux mux(kClockHz);
    mux.set_input(0, 4'000'000);
    mux.set_input(2, -1'000'000);
    mux.select(1, 1000);
    mux.select(2, 1001);
    EXPECT_EQ(mux.output_uv(1001), 2'000'000);
    EXPECT_EQ(mux.output_uv(1010), -1'000'000);
}

TEST(AnalogMux, SelectingTheSameChannelDisturbsNothing) {
    AnalogMux mux(kClockHz);
    mux.set_input(3, 5);
    mux.select(3, 1000);
    const AnalogMux before = mux;
    mux.select(3, 1004);
    mux.select(19, 1005);  // four address lines
    EXPECT_EQ(mux, before);
}

TEST(AnalogMux, SensorOfTheSettledChannelIsFollowed) {
    AnalogMux mux(kClockHz);
    mux.set_input(0, 123);
    EXPECT_EQ(mux.output_uv(5000), 123);
    EXPECT_EQ(mux.properties(5000)[1].value, "123 uV");
}

}  // namespace
