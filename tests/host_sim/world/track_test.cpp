// track_test.cpp - what the front wheel leaves, the others find.
#include "host_sim/world/track.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "host_sim/world/random.hpp"

namespace host_sim {
namespace {

Terrain hilly() {
    return make_terrain(TerrainKind::fractal, 2).scaled(0.02);
}

TEST(Track, WithAFieldIsGroundMinusSinkage) {
    const SinkageField sinkage = make_sinkage(TerrainKind::fractal, 2).scaled(0.02);
    const Terrain ground = hilly();
    const Track track(ground, sinkage);
    for (double x = 0; x < 6000; x += 3.3) {
        ASSERT_NEAR(track.bearing_cm(x), ground.height_cm(x) - sinkage.depth_cm(x), 1e-9);
        ASSERT_NEAR(track.sinkage_cm(x), sinkage.depth_cm(x), 1e-9);
    }
}

TEST(Track, WithoutSlipTheRutHasTheStaticDepth) {
    Track track(hilly(), 0.7, {30, 1.7});
    for (double front = 50; front < 500; front += 0.1) {
        track.roll_to(front);
        ASSERT_NEAR(track.sinkage_cm(front), 0.7, 1e-9);
        ASSERT_NEAR(track.sinkage_cm(front - 31.4), 0.7, 1e-9);
        ASSERT_NEAR(track.sinkage_cm(front + 5), 0.7, 1e-9);
    }
}

// static + law(slip), reached over one contact patch: 1 - 1/e of the change after 2 cm.
TEST(Track, SlipDeepensTheRutOverOneContactPatch) {
    Track track(hilly(), 0.5, {20, 1});
    track.roll_to(100);
    track.set_slip(0.5);  // 20 mm * 0.5
    track.roll_to(100 + kContactPatchCm);
    EXPECT_NEAR(track.sinkage_cm(100 + kContactPatchCm), 0.5 + 1.0 * (1 - std::exp(-1.0)), 1e-6);
    track.roll_to(140);
    EXPECT_NEAR(track.sinkage_cm(140), 1.5, 1e-6);
    EXPECT_NEAR(track.sinkage_cm(90), 0.5, 1e-9);
    track.set_slip(-3);
    track.roll_to(180);
    EXPECT_NEAR(track.sinkage_cm(180), 0.5, 1e-6);
    EXPECT_NEAR(track.sinkage_cm(139.9), 1.5, 1e-3);
}

// The paper's key assumption: trailing wheels track what the front wheel left.
TEST(Track, GroundOnceRolledOverNeverChanges) {
    Track track(hilly(), 0.2, {25, 1.4});
    Random random = stream(3, "slips");
    double front = 40;
    track.roll_to(front);
    for (int i = 0; i < 3000; ++i) {
        const double x = random.uniform(0, front);
        const double before = track.bearing_cm(x);
        if (i % 50 == 0) track.set_slip(random.uniform(-0.2, 1));
        front += random.uniform(-0.1, 0.5);
        const double expected_front = track.sinkage_cm(std::max(front, 40.0));
        track.roll_to(front);
        ASSERT_NEAR(track.bearing_cm(x), before, 1e-12);
        ASSERT_NEAR(track.sinkage_cm(std::max(front, 40.0)), expected_front, 1e-12);
        ASSERT_GE(track.sinkage_cm(x), 0.2 - 1e-9);
        ASSERT_LE(track.sinkage_cm(x), 2.7 + 1e-9);
    }
}

TEST(Track, IsDefinedBeyondBothEndsOfTheGround) {
    Track track(Terrain(0, 10, {1, 1, 1}), 0.5, {30, 1});
    track.set_slip(1);
    track.roll_to(1e9);
    for (const double x : {-1e9, -1.0, 0.0, 20.0, 21.0, 1e9}) {
        ASSERT_TRUE(std::isfinite(track.bearing_cm(x))) << x;
        ASSERT_GE(track.sinkage_cm(x), 0.5 - 1e-9) << x;
        ASSERT_LE(track.sinkage_cm(x), 3.5 + 1e-9) << x;
    }
    EXPECT_THROW(Track(Terrain(), -1, {}), InputError);
    EXPECT_EQ(Track().bearing_cm(3), 0);
}

}  // namespace
}  // namespace host_sim
