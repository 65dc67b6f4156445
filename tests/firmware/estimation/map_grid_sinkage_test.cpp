// map_grid_sinkage_test.cpp - list of look-ahead samples, smoothing and shrinkage against double.
#include "firmware/estimation/map_grid_sinkage.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace {

using namespace rover;
using namespace rover::slip;

/// A map whose front wheel stands in a bin.
MapGrid at_front(int bin) {
    MapGrid map;
    map.passed_bin = static_cast<U8>(bin);
    return map;
}

TEST(InsertSample, GoesIntoItsBinWithItsPlaceInIt) {
    for (int place = 0; place < 65536; place += 61) {
        MapGrid map = at_front(place / 64 - 5);
        insert_sample(map, static_cast<U16>(place), 123);
        const auto i = static_cast<std::size_t>(place / 64 % 32);
        EXPECT_EQ(map.ahead.height_q4_mm[i], 123);
        EXPECT_EQ(map.ahead.fraction_q8[i], place % 64 * 4 + 1);
    }
}

TEST(InsertSample, TwoInABinAreAveraged) {
    MapGrid map = at_front(10);
    insert_sample(map, 20 * 64 + 10, 100);
    insert_sample(map, 20 * 64 + 30, -201);
    EXPECT_EQ(map.ahead.height_q4_mm[20], -51);  // -50.5, rounded down
    EXPECT_EQ(map.ahead.fraction_q8[20] & 0xFC, 20 * 4);
    insert_sample(map, 21 * 64, 7);
    EXPECT_EQ(map.ahead.height_q4_mm[21], 7);
}

TEST(InsertSample, TakesNothingBehindTheFrontWheelOrBeyondTheRing) {
    for (int bin = -200; bin < 200; ++bin) {
        MapGrid map = at_front(3);
        insert_sample(map, static_cast<U16>((3 + bin) * 64 + 5), 9);
        int taken = 0;
        for (const U8 fraction : map.ahead.fraction_q8) taken += fraction != 0 ? 1 : 0;
        EXPECT_EQ(taken, bin >= 0 && bin <= kSampleReach ? 1 : 0) << bin;
    }
}

TEST(PassSamples, KeepsTheLastOnePassedAndForgetsTheOthers) {
    for (int front = 0; front < 15 * 64; front += 7) {
        MapGrid map = at_front(0);
        int last = -1;
        for (int place = 20; place < 15 * 64; place += 90) {  // no two in one bin
            insert_sample(map, static_cast<U16>(place), static_cast<S16>(place));
            if (place <= front) last = place;
        }
        pass_samples(map, split_place(static_cast<U16>(front)));
        ASSERT_EQ(map.has_behind, last >= 0) << front;
        if (last >= 0) {
            ASSERT_EQ(map.behind_place_q8_bin, last * 4);
            ASSERT_EQ(map.behind_height_q4_mm, last);
        }
        for (int place = 20; place < 15 * 64; place += 90) {
            ASSERT_EQ(map.ahead.fraction_q8[place / 64] != 0, place > front) << front;
        }
    }
}

// Places of samples are multiples of 1/64 bin; the share is known in 1/64 and from places in 1/16
// bin: 1/64 + 2/16 of the span.
TEST(GroundAtFront, IsTheLineBetweenTheSamplesOnBothSides) {
    for (int span = 66; span < 480; span += 13) {
        for (int front = 30; front < 30 + span; front += 11) {
            MapGrid map = at_front(0);
            insert_sample(map, 30, 1000);
            insert_sample(map, static_cast<U16>(30 + span), -600);
            const U16 split = split_place(static_cast<U16>(front));
            pass_samples(map, split);
            S16 ground{0};
            ASSERT_TRUE(ground_at_front(map, split, ground));
            const double share = static_cast<double>(front - 30) / span;
            const double tolerance = 1600 * (1 / 64.0 + 2 * 4.0 / span) + 1;
            ASSERT_NEAR(ground, 1000 - 1600 * share, tolerance) << span << " " << front;
        }
    }
}

TEST(GroundAtFront, NeedsASampleOnBothSidesWithin40Centimetres) {
    S16 ground{0};
    MapGrid map = at_front(10);
    EXPECT_FALSE(ground_at_front(map, split_place(640), ground));
    insert_sample(map, 12 * 64, 5);
    EXPECT_FALSE(ground_at_front(map, split_place(640), ground));
    insert_sample(map, 10 * 64, 5);
    pass_samples(map, split_place(640));
    EXPECT_TRUE(ground_at_front(map, split_place(640), ground));
    map.behind_place_q8_bin = static_cast<U16>((12 - 16) * 256);
    EXPECT_FALSE(ground_at_front(map, split_place(640), ground));
}

// The root of the sum of squares is replaced by larger + 3/8 smaller (within 7 %), which squared
// and times a doubt of at most 1 makes 15 %; roughness comes in half, sizes in sixteenths of a mm
// (6 % of the least noise and signal), the ratio in 1/32.
TEST(BelievedShare, IsOneMinusNoiseToSignalSquaredWithin0p3AndWithin0p06OnAverage) {
    MapGrid map;
    double worst = 0;
    double sum = 0;
    int count = 0;
    for (int rough = 0; rough < 12000; rough += 211) {
        for (int size = 1; size < 32700; size += 97) {
            map.rough_q8_mm = static_cast<U16>(rough);
            map.sinkage_size_q11_mm = static_cast<S16>(size);
            const double noise_mm = 0.378 * std::hypot(0.82 * 2, 0.3 * rough / 256.0);
            const double ratio = noise_mm / (size / 2048.0);
            const double share = std::max(0.0, 1 - 0.64 * ratio * ratio);
            const double off = std::abs(believed_share_q7(map) / 128.0 - share);
            worst = std::max(worst, off);
            sum += off;
            ++count;
        }
    }
    EXPECT_LE(worst, 0.3);
    EXPECT_LE(sum / count, 0.06);
}

TEST(BelievedShare, OfNothingIsNothing) {
    MapGrid map;
    map.sinkage_size_q11_mm = 0;
    EXPECT_EQ(believed_share_q7(map), 0);
}

TEST(SmoothSinkage, ASteadyDeepOneIsReportedWithin2Percent) {
    MapGrid map;
    map.rough_q8_mm = 256;
    for (int i = 0; i < 60; ++i) smooth_sinkage(map, 50 * 16);
    EXPECT_NEAR(map.sinkage_q4_mm / 16.0, 50, 1);
    EXPECT_TRUE(map.sinkage_alarm);  // above 30 mm
}

TEST(SmoothSinkage, IsNeverNegative) {
    MapGrid map;
    for (int i = 0; i < 60; ++i) smooth_sinkage(map, static_cast<S16>(-50 * 16 - i));
    EXPECT_EQ(map.sinkage_q4_mm, 0);
    EXPECT_FALSE(map.sinkage_alarm);
}

TEST(SmoothSinkage, BelowTheNoiseIsNotBelieved) {
    MapGrid map;
    map.rough_q8_mm = 100 * 256;
    for (int i = 0; i < 60; ++i) smooth_sinkage(map, 3 * 16);
    EXPECT_EQ(map.sinkage_q4_mm, 0);
}

TEST(SenseSinkage, SinkageIsGroundMinusSurfaceUnderTheFrontWheel) {
    S16 flat[kKnownNodes] = {};
    MapGrid map;
    start_on_known_ground(map, flat);
    map.rough_q8_mm = 128;
    map.passed_bin = 18;  // the front wheel came from there
    MapGridInput input;
    input.linkage = true;
    input.ahead_count = 2;  // both sides of the front wheel, 40 mm above the surface
    input.ahead_distance_q6_bin[0] = 1200;
    input.ahead_distance_q6_bin[1] = 1500;
    input.ahead_height_q4_mm[0] = input.ahead_height_q4_mm[1] = 40 * 16;
    insert_samples(map, input, S16{0});
    sense_sinkage(map);
    EXPECT_TRUE(map.sinkage_valid);
    EXPECT_NEAR(map.sinkage_q4_mm / 16.0, 40, 1);
}

TEST(SenseSinkage, WithoutSamplesAroundTheFrontWheelIsNotValid) {
    S16 flat[kKnownNodes] = {};
    MapGrid map;
    start_on_known_ground(map, flat);
    MapGridInput input;
    insert_samples(map, input, S16{0});
    sense_sinkage(map);
    EXPECT_FALSE(map.sinkage_valid);
    input.ahead_count = 1;
    input.ahead_distance_q6_bin[0] = 1536;
    insert_samples(map, input, S16{0});
    sense_sinkage(map);
    EXPECT_FALSE(map.sinkage_valid);
}

}  // namespace
