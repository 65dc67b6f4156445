// map_grid_state_test.cpp - places compare modulo 2^16; a new state is one that can be left.
#include "firmware/estimation/map_grid_state.hpp"

#include <gtest/gtest.h>

namespace {

using namespace rover;

TEST(AheadOf, IsTheShortWayRoundForEveryPlace) {
    for (int32_t a = 0; a < 65536; a += 257) {
        for (int32_t distance = -32768; distance <= 32767; distance += 101) {
            const auto b = static_cast<uint16_t>(a + distance);
            ASSERT_EQ(ahead_of(static_cast<uint16_t>(a), b), distance) << a;
        }
    }
}

TEST(MapGridState, ANewOneKnowsNoGroundAndExpectsNoSlip) {
    const MapGrid map;
    EXPECT_FALSE(map.has_map);
    EXPECT_EQ(map.mode, SlipMode::odometry_only);
    EXPECT_NEAR(map.mean_q12_bin / 4096.0 * 2.5, 6.0, 0.001);
    EXPECT_NEAR(map.rough_q8_mm / 256.0, 3.0, 0.01);
    EXPECT_FALSE(map.slip_alarm || map.sinkage_alarm || map.lost_lock);
}

}  // namespace
