// map_grid_sinkage_test.cpp - list of look-ahead samples, smoothing and shrinkage against double.
#include "firmware/estimation/map_grid_sinkage.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace {

using namespace rover;
using namespace rover::slip;

TEST(InsertSample, KeepsTheListInOrderOfPlace) {
    constexpr unsigned kSeed = 20260105;
    std::mt19937 random(kSeed);
    for (int trial = 0; trial < 2000; ++trial) {
        MapGrid map;
        const auto base = static_cast<uint16_t>(random());
        for (int i = 0; i < 60; ++i) {
            insert_sample(map, static_cast<U16>(base + random() % 3000), 5);
            ASSERT_LE(map.sample_count, kSampleCount);
            for (uint8_t k = 1; k < map.sample_count; ++k) {
                ASSERT_GE(ahead_of(sample_at(map, static_cast<uint8_t>(k - 1)).place_q6_bin,
                                   sample_at(map, k).place_q6_bin),
                          0)
                    << "seed " << kSeed << " trial " << trial;
            }
        }
    }
}

TEST(InsertSample, NearSamplesAreAveraged) {
    MapGrid map;
    insert_sample(map, 1000, 100);
    insert_sample(map, 1000 + kMergeQ6Bin - 1, 200);  // nearer than 2 cm
    ASSERT_EQ(map.sample_count, 1);
    EXPECT_EQ(sample_at(map, 0).place_q6_bin, 1025);
    EXPECT_EQ(sample_at(map, 0).height_q4_mm, 150);
    insert_sample(map, 1025 + kMergeQ6Bin, 300);  // 2 cm: kept apart
    EXPECT_EQ(map.sample_count, 2);
}

TEST(InsertSample, AFullListKeepsWhatItHas) {
    MapGrid map;
    for (int i = 0; i < kSampleCount; ++i) insert_sample(map, static_cast<U16>(i * 100), S16{7});
    insert_sample(map, 60000, 9);
    EXPECT_EQ(map.sample_count, kSampleCount);
    for (uint8_t i = 0; i < kSampleCount; ++i) EXPECT_EQ(sample_at(map, i).height_q4_mm, 7);
}

// The root of the sum of squares is replaced by larger + 3/8 smaller (within 7 %), which squared
// and times a doubt of at most 1 makes 15 %; the ratio's steps of 1/256 add the rest.
TEST(BelievedShare, IsOneMinusNoiseToSignalSquaredWithin0p16) {
    MapGrid map;
    double worst = 0;
    for (int rough = 0; rough < 32768; rough += 211) {
        for (int size = 1; size < 32768; size += 97) {
            map.rough_q8_mm = static_cast<U16>(rough);
            map.sinkage_size_q8_mm = static_cast<U16>(size);
            const double noise_mm = 0.378 * std::hypot(0.82 * 2, 0.3 * rough / 256.0);
            const double ratio = noise_mm / (size / 256.0);
            const double share = std::max(0.0, 1 - 0.64 * ratio * ratio);
            worst = std::max(worst, std::abs(believed_share_q8(map) / 256.0 - share));
        }
    }
    EXPECT_LE(worst, 0.16);
}

TEST(BelievedShare, OfNothingIsNothing) {
    MapGrid map;
    map.sinkage_size_q8_mm = 0;
    EXPECT_EQ(believed_share_q8(map), 0);
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

TEST(LookAhead, SinkageIsGroundMinusSurfaceUnderTheFrontWheel) {
    S16 flat[kKnownNodes] = {};
    MapGrid map;
    start_on_known_ground(map, flat);
    map.rough_q8_mm = 128;
    MapGridInput input;
    input.linkage = true;
    input.ahead_count = 2;  // both sides of the front wheel, 40 mm above the surface
    input.ahead_distance_q6_bin[0] = 1200;
    input.ahead_distance_q6_bin[1] = 1500;
    input.ahead_height_q4_mm[0] = input.ahead_height_q4_mm[1] = 40 * 16;
    look_ahead(map, input, S16{0});
    EXPECT_TRUE(map.sinkage_valid);
    EXPECT_NEAR(map.sinkage_q4_mm / 16.0, 40, 1);
}

TEST(LookAhead, WithoutSamplesAroundTheFrontWheelIsNotValid) {
    S16 flat[kKnownNodes] = {};
    MapGrid map;
    start_on_known_ground(map, flat);
    MapGridInput input;
    look_ahead(map, input, S16{0});
    EXPECT_FALSE(map.sinkage_valid);
    input.ahead_count = 1;
    input.ahead_distance_q6_bin[0] = 1536;
    look_ahead(map, input, S16{0});
    EXPECT_FALSE(map.sinkage_valid);
}

}  // namespace
