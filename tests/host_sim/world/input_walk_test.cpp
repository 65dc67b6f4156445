// input_walk_test.cpp - random inputs follow from their seed and come in segments.
#include "host_sim/world/input_walk.hpp"

#include <gtest/gtest.h>

#include <cstring>

namespace {

using host_sim::InputWalk;

bool same(const hal::RawInputs& a, const hal::RawInputs& b) {
    return a.tick_count == b.tick_count &&
           std::memcmp(a.adc_q4_count, b.adc_q4_count, sizeof a.adc_q4_count) == 0 &&
           std::memcmp(a.tach_count, b.tach_count, sizeof a.tach_count) == 0 &&
           a.range_scan_count == b.range_scan_count && a.tach_present == b.tach_present;
}

TEST(InputWalk, FollowsFromItsSeed) {
    InputWalk one(7), again(7), other(8);
    bool differs = false;
    for (int i = 0; i < 500; ++i) {
        const InputWalk::Next a = one.next({}), b = again.next({}), c = other.next({});
        ASSERT_TRUE(same(a.inputs, b.inputs)) << i;
        ASSERT_EQ(a.reset, b.reset);
        differs = differs || !same(a.inputs, c.inputs);
    }
    EXPECT_TRUE(differs);
}

TEST(InputWalk, SegmentsOf40To300StepsBeginWithAReset) {
    InputWalk walk(1);
    ASSERT_TRUE(walk.next({}).reset);
    int length = 1, segments = 0;
    while (segments < 10) {
        if (!walk.next({}).reset) {
            ++length;
            continue;
        }
        EXPECT_GE(length, 40);
        EXPECT_LT(length, 300);
        length = 1;
        ++segments;
    }
}

}  // namespace
