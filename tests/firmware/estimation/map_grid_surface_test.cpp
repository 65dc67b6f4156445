// map_grid_surface_test.cpp - the ring of surface heights against hand and double computation.
#include "firmware/estimation/map_grid_surface.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace {

using namespace rover;
using namespace rover::slip;

MapGrid with_heights(double (*height_q4)(int node), int first, int count) {
    MapGrid map;
    for (int node = first; node < first + count; ++node) {
        node_height(map, static_cast<U16>(node)) = static_cast<S16>(std::lround(height_q4(node)));
    }
    return map;
}

TEST(RatioQ8, Is256TimesTheRatioRoundedHalfUp) {
    std::mt19937 random(20261122);
    for (int trial = 0; trial < 200000; ++trial) {
        const auto b = static_cast<unsigned>(1 + random() % 32767);
        const auto a = static_cast<unsigned>(random() % (b + 1));
        const unsigned wanted = std::min((512 * a + b) / (2 * b), 255U);
        ASSERT_EQ(ratio_q8(static_cast<U16>(a), static_cast<U16>(b)), wanted) << a << " " << b;
    }
    EXPECT_EQ(ratio_q8(U16{0}, U16{0}), 255) << "defined, and in nobody's way";
}

TEST(SurfaceAt, IsTheLineBetweenTwoNodesRoundedHalfUp) {
    const auto bumpy = [](int node) { return std::round(300 * std::sin(node * 0.9)); };
    const MapGrid map = with_heights(bumpy, 0, 32);
    for (int place = 0; place < 31 * 64; ++place) {
        const double share = (place % 64) / 64.0;
        const double line = bumpy(place / 64) * (1 - share) + bumpy(place / 64 + 1) * share;
        ASSERT_EQ(surface_at(map, static_cast<U16>(place)), std::floor(line + 0.5)) << place;
    }
}

TEST(SurfaceAt, CrossesTheEndOfTheRingAndOfThePlaces) {
    MapGrid map;
    node_height(map, U16{1023}) = 100;  // the last node before places wrap
    node_height(map, U16{0}) = 200;
    EXPECT_EQ(surface_at(map, 65535), 100 + std::lround(100 * 63 / 64.0));
    EXPECT_EQ(surface_at(map, 0), 200);
}

TEST(SurfaceAt, HillsBeyondTheRangeOfHeightsAreOnlyDifferences) {
    MapGrid map;
    node_height(map, U16{4}) = 32760;
    node_height(map, U16{5}) = narrow_wrap_s16(S32{32760 + 16});  // 1 mm higher, past the end
    EXPECT_EQ(surface_at(map, 4 * 64 + 32), narrow_wrap_s16(S32{32768}));
}

// Every start and length of the front wheel's step that the estimator can take.
TEST(FillTo, LeavesNodesOnTheStraightLineWithin0p2PercentOfTheRisePerNodeAndOneLsb) {
    for (int from = 1000; from < 1064; from += 7) {
        for (int length = 0; length <= kGapMaxQ6Bin; length += 13) {
            MapGrid map;
            map.front_place_q6_bin = static_cast<U16>(from);
            map.front_height_q4_mm = -500;
            fill_to(map, static_cast<U16>(from + length), 700);
            int nodes = 0;
            for (int node = from / 64 + 1; node * 64 <= from + length; ++node) {
                ++nodes;
                const double line = -500 + 1200.0 * (node * 64 - from) / length;
                // Shares of the rise in 1/256, rounded, at most 255/256; every height is rounded.
                const double tolerance = nodes * (1200 * (0.5 / 256) + 0.5) + 1200 * (0.5 / 256);
                ASSERT_NEAR(node_height(map, static_cast<U16>(node)), line, tolerance)
                    << from << " " << length;
            }
            // The surface has the new height from the first node beyond the end on.
            const int beyond = (from + length) / 64 + 1;
            ASSERT_EQ(node_height(map, static_cast<U16>(beyond)), 700) << from << " " << length;
        }
    }
}

TEST(FillTo, OldestNodeMovesOnWithTheRing) {
    MapGrid map;
    map.lowest_q6_bin = 0;
    map.front_place_q6_bin = 20 * 64;
    fill_to(map, 30 * 64, 0);  // writes up to node 31: all 32 fit
    EXPECT_EQ(map.lowest_q6_bin, 0);
    fill_to(map, 33 * 64, 0);  // up to node 34: nodes 0 to 2 are overwritten
    EXPECT_EQ(map.lowest_q6_bin, 3 * 64);
}

TEST(BeginMap, OnASlopeIsThatSlope) {
    // 20 % grade, contacts at 0, 25 and 50 cm: 50 mm and 100 mm; 5 mm a bin.
    for (const uint16_t start : {uint16_t{0}, uint16_t{30}, uint16_t{65500}}) {
        MapGrid map;
        map.place_q6_bin = start;
        MapGridInput input;
        input.middle_height_q4_mm = 50 * 16;
        input.front_height_q4_mm = 100 * 16;
        begin_map(map, input, static_cast<uint16_t>(start + 1280));
        for (int ahead = 64; ahead <= 1216; ahead += 11) {
            // 0.2 % of the 50 mm between two contacts a node, as for FillTo: 2 % in all.
            const double slope_q4_mm = ahead / 64.0 * 5 * 16;
            ASSERT_NEAR(surface_at(map, static_cast<U16>(start + ahead)), slope_q4_mm, 20) << ahead;
        }
        EXPECT_TRUE(map.has_map);
        EXPECT_FALSE(map.measured);
        EXPECT_EQ(map.measured_from_q6_bin, static_cast<uint16_t>(start + 1280));
    }
}

TEST(StartOnKnownGround, HoldsTheGivenHeightsAndCountsAsMeasured) {
    S16 surface[kKnownNodes];
    for (int node = 0; node < kKnownNodes; ++node) surface[node] = static_cast<S16>(node * node);
    MapGrid map;
    map.place_q6_bin = 777;
    map.ahead.fraction_q8[5] = 77;
    map.has_behind = true;
    start_on_known_ground(map, surface);
    for (int node = 0; node < kKnownNodes; ++node) {
        EXPECT_EQ(surface_at(map, static_cast<U16>(node * 64)), node * node);
    }
    EXPECT_EQ(map.place_q6_bin, 0);
    EXPECT_EQ(map.front_place_q6_bin, 1280);
    EXPECT_EQ(map.front_height_q4_mm, 400);
    EXPECT_EQ(map.ahead.fraction_q8[5], 0);
    EXPECT_FALSE(map.has_behind);
    EXPECT_EQ(map.passed_bin, 20);
    EXPECT_TRUE(map.has_map && map.measured);
}

TEST(LerpAt, IsAStepTowardsTheTargetRoundedHalfUp) {
    for (int value = -30000; value <= 30000; value += 1013) {
        for (int target = -30000; target <= 30000; target += 997) {
            if (std::abs(target - value) > 32767) continue;
            const double step = std::floor((target - value) * 9 / 256.0 + 0.5);
            ASSERT_EQ(lerp_at(static_cast<S16>(value), static_cast<S16>(target), U8{9}),
                      value + step);
        }
    }
}

// Heights 0, 10, 0, 10, ... mm have second differences of 20 mm: that is what the mean reaches.
TEST(LearnRoughness, ReachesTheMeanSecondDifference) {
    MapGrid map;
    for (int i = 0; i < 400; ++i) {
        const S16 height = i % 2 == 0 ? S16{160} : S16{0};
        learn_roughness(map, height);
        map.front_height_before_q4_mm = map.front_height_q4_mm;
        map.front_height_q4_mm = height;
    }
    EXPECT_NEAR(map.rough_q8_mm / 256.0, 20, 0.1);
}

TEST(LearnRoughness, SaturatesAt128Millimetres) {
    MapGrid map;
    for (int i = 0; i < 1000; ++i) {
        const S16 height = i % 2 == 0 ? S16{8000} : S16{-8000};
        learn_roughness(map, height);
        map.front_height_before_q4_mm = map.front_height_q4_mm;
        map.front_height_q4_mm = height;
        ASSERT_LE(map.rough_q8_mm, kRoughMaxQ8Mm);
    }
    EXPECT_GT(map.rough_q8_mm, 32000);
}

// Rear and middle wheel disagree by 8 mm: the rear contact gets half, the map at the middle the
// rest, spread evenly over its two nodes.
TEST(ExtendMap, SplitsTheMisfitBetweenRearAndMiddleWheel) {
    S16 flat[kKnownNodes] = {};
    MapGrid map;
    start_on_known_ground(map, flat);
    map.place_q6_bin = 32;
    MapGridInput input;
    input.middle_height_q4_mm = 8 * 16;
    input.front_height_q4_mm = 0;
    EXPECT_EQ(extend_map(map, input, 32 + 1280), -4 * 16);
    EXPECT_EQ(node_height(map, U16{10}), 2 * 16);
    EXPECT_EQ(node_height(map, U16{11}), 2 * 16);
    EXPECT_EQ(node_height(map, U16{9}), 0);
    EXPECT_EQ(map.front_height_q4_mm, -4 * 16);
    EXPECT_EQ(map.front_place_q6_bin, 32 + 1280);
}

TEST(ExtendMap, ARetreatingFrontWheelChangesNothingAhead) {
    S16 flat[kKnownNodes] = {};
    MapGrid map;
    start_on_known_ground(map, flat);
    map.front_place_q6_bin = 1400;
    MapGridInput input;
    input.front_height_q4_mm = 999;
    extend_map(map, input, 1280);
    EXPECT_EQ(map.front_place_q6_bin, 1400);
    EXPECT_EQ(map.front_height_q4_mm, 0);
}

}  // namespace
