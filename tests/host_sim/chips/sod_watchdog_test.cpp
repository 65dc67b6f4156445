// sod_watchdog_test.cpp - the watchdog against docs/chips/sod-watchdog.md. At 3.072 MHz
//   0.5 s = 1,536,000 T; pulse 20 ms = 61,440 T.
#include "host_sim/chips/sod_watchdog.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <vector>

namespace {

using host_sim::chips::SodWatchdog;

constexpr uint64_t kClockHz = 3'072'000;
constexpr uint64_t kPeriodT = 1'536'000;
constexpr uint64_t kPulseT = 61'440;

TEST(SodWatchdog, FirstPeriodBeginsWithPower) {
    SodWatchdog watchdog(kClockHz);
    EXPECT_EQ(watchdog.next_event_t(), kPeriodT);
    watchdog.advance(kPeriodT - 1);
    EXPECT_FALSE(watchdog.pulse());
    watchdog.advance(kPeriodT);
    EXPECT_TRUE(watchdog.pulse());
    EXPECT_EQ(watchdog.fired_count, 1u);
}

TEST(SodWatchdog, OtherClocksKeepTheTime) {
    EXPECT_EQ(SodWatchdog(2'000'000).next_event_t(), 1'000'000u);
}

TEST(SodWatchdog, EitherEdgeBeginsANewPeriod) {
    SodWatchdog watchdog(kClockHz);
    watchdog.sod(true, 1000);
    EXPECT_EQ(watchdog.next_event_t(), 1000 + kPeriodT);
    watchdog.sod(false, 5000);
    EXPECT_EQ(watchdog.next_event_t(), 5000 + kPeriodT);
}

TEST(SodWatchdog, LevelWithoutAnEdgeIsQuiet) {
    SodWatchdog watchdog(kClockHz);
    watchdog.sod(true, 1000);
    for (uint64_t t = 2000; t < 1'500'000; t += 100'000) watchdog.sod(true, t);
    EXPECT_EQ(watchdog.next_event_t(), 1000 + kPeriodT);
}

TEST(SodWatchdog, EdgeInTheLastTStateIsInTimeAndTheNextOneIsNot) {
    SodWatchdog watchdog(kClockHz);
    watchdog.sod(true, kPeriodT - 1);
    EXPECT_FALSE(watchdog.pulse());
    EXPECT_EQ(watchdog.longest_quiet_t, kPeriodT - 1);

    SodWatchdog late(kClockHz);
    late.sod(true, kPeriodT);
    EXPECT_TRUE(late.pulse());
}

TEST(SodWatchdog, PulseLastsTenMillisecondsAndIsNotCutByEdges) {
    SodWatchdog watchdog(kClockHz);
    watchdog.advance(kPeriodT);
    EXPECT_EQ(watchdog.next_event_t(), kPeriodT + kPulseT);
    watchdog.sod(true, kPeriodT + 100);
    watchdog.sod(false, kPeriodT + 200);
    EXPECT_TRUE(watchdog.pulse());
    EXPECT_EQ(watchdog.next_event_t(), kPeriodT + kPulseT);
    watchdog.advance(kPeriodT + kPulseT - 1);
    EXPECT_TRUE(watchdog.pulse());
    watchdog.advance(kPeriodT + kPulseT);
    EXPECT_FALSE(watchdog.pulse());
    EXPECT_EQ(watchdog.next_event_t(), kPeriodT + kPulseT + kPeriodT) << "a whole new period";
}

TEST(SodWatchdog, SoftwareThatNeverTogglesIsResetAgainAndAgain) {
    SodWatchdog watchdog(kClockHz);
    watchdog.advance(10 * (kPeriodT + kPulseT) - 1);
    EXPECT_EQ(watchdog.fired_count, 10u);
}

TEST(SodWatchdog, RestartBeginsANewPeriod) {
    SodWatchdog watchdog(kClockHz);
    watchdog.restart(700'000);
    EXPECT_EQ(watchdog.next_event_t(), 700'000 + kPeriodT);
    watchdog.advance(700'000 + kPeriodT);
    watchdog.restart(700'000 + kPeriodT + 5);
    EXPECT_FALSE(watchdog.pulse());
}

TEST(SodWatchdog, LongestQuietTimeShowsTheMarginOfTheSoftware) {
    SodWatchdog watchdog(kClockHz);
    watchdog.sod(true, 100);
    watchdog.sod(false, 400'100);
    watchdog.sod(true, 400'200);
    EXPECT_EQ(watchdog.longest_quiet_t, 400'000u);
    EXPECT_EQ(watchdog.properties().back().value, "400000 of 1536000 T");
}

RC_GTEST_PROP(SodWatchdog, NeverFiresWhenToggledInTimeAndAlwaysWhenNot, ()) {
    SodWatchdog watchdog(kClockHz);
    const auto gaps =
        *rc::gen::container<std::vector<uint64_t>>(rc::gen::inRange<uint64_t>(1, kPeriodT));
    uint64_t t = 0;
    bool level = false;
    for (const uint64_t gap : gaps) watchdog.sod(level = !level, t += gap);
    RC_ASSERT(watchdog.fired_count == 0u);
    watchdog.advance(t + kPeriodT);
    RC_ASSERT(watchdog.fired_count == 1u);
}

RC_GTEST_PROP(SodWatchdog, StridesOfTimeLeaveTheSameState, ()) {
    SodWatchdog one(kClockHz);
    SodWatchdog many(kClockHz);
    const auto gaps =
        *rc::gen::container<std::vector<uint64_t>>(rc::gen::inRange<uint64_t>(0, 2 * kPeriodT));
    uint64_t t = 0;
    for (const uint64_t gap : gaps) {
        const bool level = *rc::gen::arbitrary<bool>();
        while (many.next_event_t() <= t + gap) many.advance(many.next_event_t());
        for (int part = 1; part <= 9; ++part) {
            many.advance(std::max(t, t + gap * static_cast<uint64_t>(part) / 10));
        }
        t += gap;
        one.sod(level, t);
        many.sod(level, t);
    }
    RC_ASSERT(one == many);
}

}  // namespace
