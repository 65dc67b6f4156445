// linkage_test.cpp - against planes, steps and the definition of the pose.
#include "host_sim/world/linkage.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "host_sim/world/random.hpp"
#include "host_sim/world/terrain.hpp"

namespace host_sim {
namespace {

constexpr LinkageGeometry kRocky32{37.5, 12.5};
constexpr double kDegree = std::numbers::pi / 180.0;

// Largest vertical distance of a wheel from the surface, from the angles alone.
template <typename Surface>
double residual_cm(const LinkagePose& pose, const Surface& surface, double x) {
    const double pivot_x = x + 37.5 * std::cos(pose.rocker_rad);
    const double pivot_y = surface(x) + 37.5 * std::sin(pose.rocker_rad);
    const double reach = 12.5 * std::cos(pose.bogie_rad);
    const double rise = 12.5 * std::sin(pose.bogie_rad);
    return std::max(std::abs(surface(pivot_x - reach) - (pivot_y - rise)),
                    std::abs(surface(pivot_x + reach) - (pivot_y + rise)));
}

TEST(SolveLinkage, LevelGroundGivesLevelLinks) {
    const LinkagePose pose = solve_linkage(kRocky32, [](double) { return 123.0; }, 7.0);
    EXPECT_NEAR(pose.rocker_rad, 0, 1e-9);
    EXPECT_NEAR(pose.bogie_rad, 0, 1e-9);
    EXPECT_NEAR(pose.x_middle_cm, 32, 1e-9);
    EXPECT_NEAR(pose.x_front_cm, 57, 1e-9);
    EXPECT_NEAR(pose.z_middle_cm, 0, 1e-7);
    EXPECT_NEAR(pose.z_front_cm, 0, 1e-7);
}

TEST(SolveLinkage, ConstantSlopeTiltsBothLinksBySlopeAngle) {
    for (const double degrees : {-60.0, -30.0, -5.0, 0.1, 20.0, 44.0, 60.0}) {
        const double angle = degrees * kDegree;
        const auto slope = [angle](double x) { return std::tan(angle) * x; };
        const LinkagePose pose = solve_linkage(kRocky32, slope, -3.0);
        EXPECT_NEAR(pose.rocker_rad, angle, 1e-7) << degrees;
        EXPECT_NEAR(pose.bogie_rad, angle, 1e-7) << degrees;
        EXPECT_NEAR(pose.z_front_cm, 50 * std::sin(angle), 1e-5) << degrees;
        EXPECT_NEAR(pose.x_middle_cm, -3 + 25 * std::cos(angle), 1e-5) << degrees;
        EXPECT_LT(residual_cm(pose, slope, -3.0), 1e-6) << degrees;
    }
}

// Front wheel on a plateau of height h, the others below: 25 sin(beta) = h and 75 sin(rho) = h.
TEST(SolveLinkage, FrontWheelOnAStepTurnsTheBogieThreeTimesTheRocker) {
    for (const double h : {0.5, 4.0, -6.0, 12.0}) {
        const auto step = [h](double x) { return x < 40 ? 0.0 : h; };
        const LinkagePose pose = solve_linkage(kRocky32, step, 0.0);
        EXPECT_NEAR(std::sin(pose.bogie_rad), h / 25.0, 1e-7);
        EXPECT_NEAR(std::sin(pose.rocker_rad), h / 75.0, 1e-7);
        EXPECT_NEAR(pose.z_middle_cm, 0, 1e-6);
        EXPECT_NEAR(pose.z_front_cm, h, 1e-6);
    }
}

// The paper's roughest terrain is 0.08; on it and below, the wheels stand on the ground exactly.
TEST(SolveLinkage, PutsAllWheelsOnThePapersTerrain) {
    for (const double roughness : {0.0025, 0.02, 0.08}) {
        for (std::uint64_t seed = 1; seed <= 5; ++seed) {
            const Terrain terrain = make_terrain(TerrainKind::fractal, seed).scaled(roughness);
            const auto surface = [&terrain](double x) { return terrain.height_cm(x); };
            LinkagePose pose;
            for (double x = 0; x < 6100; x += 0.83) {
                pose = solve_linkage(kRocky32, surface, x, pose);
                ASSERT_LT(residual_cm(pose, surface, x), 1e-6)
                    << "roughness " << roughness << " seed " << seed << " x " << x;
                ASSERT_NE(pose.method, LinkageMethod::nearest);
                ASSERT_NEAR(pose.z_middle_cm, surface(pose.x_middle_cm) - surface(x), 1e-6);
                ASSERT_NEAR(pose.z_front_cm, surface(pose.x_front_cm) - surface(x), 1e-6);
            }
        }
    }
}

TEST(SolveLinkage, PoseDoesNotDependOnTheGuessOnOrdinaryGround) {
    const Terrain terrain = make_terrain(TerrainKind::fractal, 9).scaled(0.02);
    const auto surface = [&terrain](double x) { return terrain.height_cm(x); };
    LinkagePose wild;
    wild.rocker_rad = 1.2;
    wild.bogie_rad = -1.2;
    for (double x = 0; x < 6000; x += 7.7) {
        const LinkagePose cold = solve_linkage(kRocky32, surface, x);
        const LinkagePose warm = solve_linkage(kRocky32, surface, x, wild);
        ASSERT_NEAR(cold.rocker_rad, warm.rocker_rad, 1e-7) << x;
        ASSERT_NEAR(cold.bogie_rad, warm.bogie_rad, 1e-7) << x;
    }
}

// Cliffs and spikes on which no exact pose may exist: still a finite pose that tells its residual.
TEST(SolveLinkage, AlwaysReturnsAPoseAndItsTrueResidual) {
    Random random = stream(1, "cliffs");
    int nearest = 0;
    for (int run = 0; run < 300; ++run) {
        std::vector<double> heights(400);
        for (double& height : heights) height = random.uniform(-40, 40);
        const Terrain terrain(0, random.uniform(0.25, 20), heights);
        const auto surface = [&terrain](double x) { return terrain.height_cm(x); };
        const LinkagePose pose = solve_linkage(kRocky32, surface, random.uniform(0, 300));
        ASSERT_LE(std::abs(pose.rocker_rad), 81 * kDegree);
        ASSERT_LE(std::abs(pose.bogie_rad), 90 * kDegree);
        ASSERT_TRUE(std::isfinite(pose.residual_cm));
        const double x =
            pose.x_middle_cm + 12.5 * std::cos(pose.bogie_rad) - 37.5 * std::cos(pose.rocker_rad);
        ASSERT_NEAR(residual_cm(pose, surface, x), pose.residual_cm, 1e-6 + 1e-4 * pose.residual_cm)
            << "run " << run;
        if (pose.method != LinkageMethod::nearest) {
            ASSERT_LT(pose.residual_cm, 1e-6) << run;
        }
        nearest += pose.method == LinkageMethod::nearest ? 1 : 0;
    }
    EXPECT_GT(nearest, 0) << "the ground was too easy for this test";
}

TEST(LookAhead, LevelRoverOnLevelGroundReadsZero) {
    const RangeSight sight =
        look_ahead({10, 5, 0, 0, 18.75, 6.5}, 41.25, [](double) { return 5.0; });
    EXPECT_TRUE(sight.seen);
    EXPECT_NEAR(sight.height_cm, 0, 1e-7);
    EXPECT_NEAR(sight.x_cm, 70, 1e-7);
}

// On a plane of angle a the axles lie r above the wheels' points, so r cos(a) from the plane; the
// body is parallel to the plane, so every sample reads H = r (1 - cos a).
TEST(LookAhead, OnAPlaneEverySampleReadsTheLiftOfTheAxle) {
    for (const double degrees : {-35.0, -10.0, 5.0, 30.0}) {
        const double angle = degrees * kDegree;
        const auto plane = [angle](double x) { return std::tan(angle) * x; };
        for (const double ahead : {41.25, 61.25}) {
            const RangeSight sight = look_ahead({0, 0, angle, angle, 18.75, 6.5}, ahead, plane);
            ASSERT_TRUE(sight.seen);
            EXPECT_NEAR(sight.height_cm, 6.5 * (1 - std::cos(angle)), 1e-6);
        }
    }
}

// A step of height h under the sample of a level rover reads h.
TEST(LookAhead, LevelRoverReadsTheHeightOfAStep) {
    const auto step = [](double x) { return x < 55 ? 2.0 : 9.5; };
    const RangeSight sight = look_ahead({0, 2, 0, 0, 18.75, 6.5}, 41.25, step);
    EXPECT_NEAR(sight.height_cm, 7.5, 1e-6);
}

TEST(LookAhead, ThePointSeenLiesOnTheGroundOfThePapersTerrain) {
    Random random = stream(4, "views");
    const Terrain terrain = make_terrain(TerrainKind::fractal, 4).scaled(0.08);
    const auto ground = [&terrain](double x) { return terrain.height_cm(x); };
    for (int i = 0; i < 20000; ++i) {
        const RangeView view{random.uniform(0, 6000),
                             random.uniform(-20, 20),
                             random.uniform(-0.6, 0.6),
                             random.uniform(-0.6, 0.6),
                             18.75,
                             6.5};
        const double ahead = random.uniform(30, 80);
        const RangeSight sight = look_ahead(view, ahead, ground);
        ASSERT_TRUE(sight.seen) << i;
        const double below = sight.height_cm - 6.5;
        const double x = view.rear_x_cm + 18.75 * std::cos(view.rocker_rad) +
                         ahead * std::cos(view.pitch_rad) - below * std::sin(view.pitch_rad);
        const double up = 18.75 * std::sin(view.rocker_rad) + ahead * std::sin(view.pitch_rad) +
                          below * std::cos(view.pitch_rad);
        ASSERT_NEAR(x, sight.x_cm, 1e-9);
        ASSERT_NEAR(view.rear_height_cm + 6.5 + up, ground(x), 1e-6) << i;
    }
}

TEST(LookAhead, SaysWhenThereIsNoGroundInReach) {
    const RangeView view{0, 0, 0, 0, 18.75, 6.5};
    EXPECT_FALSE(look_ahead(view, 40, [](double) { return -1e9; }).seen);
    EXPECT_FALSE(look_ahead(view, 40, [](double) { return 1e9; }).seen);
}

}  // namespace
}  // namespace host_sim
