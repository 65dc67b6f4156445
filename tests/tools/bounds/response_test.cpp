// response_test.cpp - response times against examples by hand.
#include "tools/bounds/response.hpp"

#include <gtest/gtest.h>

namespace {

using rover_bounds::deadlines;
using rover_bounds::response_time;
using rover_bounds::Timing;
using rover_bounds::Workload;

TEST(Response, NothingCutsIn) {
    EXPECT_EQ(response_time(40, {}, 100), 40U);
}

// 10 own; 3 every 20: 10 + 3 = 13. 20 own: 20 + 3 = 23, which reaches the next: 26.
TEST(Response, WhatCutsInMayComeAgainMeanwhile) {
    EXPECT_EQ(response_time(10, {{3, 20}}, 1000), 13U);
    EXPECT_EQ(response_time(20, {{3, 20}}, 1000), 26U);
}

// At 17 + 3 = 20 the next one comes just then: it counts.
TEST(Response, ARequestAtTheVeryEndCounts) {
    EXPECT_EQ(response_time(17, {{3, 20}}, 1000), 23U);
}

TEST(Response, MoreThanAllTheTimeHasNoEnd) {
    EXPECT_FALSE(response_time(1, {{10, 20}, {10, 20}}, 1'000'000));
    EXPECT_FALSE(response_time(101, {}, 100));
}

// TRAP 100, tick 1000 (50 of it disabled), receive 200, transmit 150, main line disabled for 90,
// step 10,000. An instruction that has just begun: 18.
const Workload kLoad = {100, 1000, 200, 150, 50, 90, 10'000, 300};
const Timing kTiming = {30'000, 1600, 300'000};

TEST(Response, EachTaskByHand) {
    const auto found = deadlines(kLoad, kTiming);
    ASSERT_EQ(found.size(), 4U);
    // transmit just begun 18 + 150, own 200, TRAP 100, tick's beginning 50
    EXPECT_EQ(found[0].response_t, 18U + 150 + 200 + 100 + 50);
    // main line disabled 18 + 90, own 150, TRAP 100, tick's beginning 50, one character 200
    EXPECT_EQ(found[1].response_t, 18U + 90 + 150 + 100 + 50 + 200);
    // receive just begun 18 + 200, own 1000, TRAP 100, one character each way: 1668, so two: 2018
    EXPECT_EQ(found[2].response_t, 18U + 200 + 1000 + 100 + 2 * (200 + 150));
    // 10,300 + 100 + 1000 + 350 n, n = R / 1600 + 1: 9 characters each way last until 14,550, and
    // there are 10 of them by then: 14,900
    EXPECT_EQ(found[3].response_t, 10'300U + 100 + 1000 + 10 * 350);
    for (const auto& deadline : found) EXPECT_TRUE(deadline.holds()) << deadline.what;
}

TEST(Response, ADeadlineThatDoesNotHoldSaysSo) {
    Workload load = kLoad;
    load.main_disabled = 1500;
    const auto found = deadlines(load, kTiming);
    EXPECT_FALSE(found[0].holds());
    EXPECT_FALSE(found[0].response_t);
    EXPECT_TRUE(found[3].holds());
}

}  // namespace
