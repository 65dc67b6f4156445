// planar_ground_test.cpp - the paper's resampled ground.
#include "host_sim/campaign/planar_ground.hpp"

#include <gtest/gtest.h>

namespace {

using namespace host_sim;

TEST(PlanarGround, ResamplingKeepsTheSamplesAndDrawsLinesBetweenThem) {
    const PlanarGround finest = make_planar_ground(TerrainKind::wilcox1994, 1, 1000);
    const PlanarGround coarse = finest.resampled(2.0);
    for (int i = 0; i < 500; ++i) {
        const double x_cm = 2.0 * i;
        EXPECT_NEAR(coarse.ground_cm(x_cm), finest.ground_cm(x_cm), 1e-9);
        EXPECT_NEAR(coarse.sinkage_cm(x_cm), finest.sinkage_cm(x_cm), 1e-9);
        EXPECT_NEAR(coarse.ground_cm(x_cm + 1),
                    0.5 * (finest.ground_cm(x_cm) + finest.ground_cm(x_cm + 2)), 1e-9);
    }
}

TEST(PlanarGround, ScalingMultipliesGroundAndSinkage) {
    const PlanarGround unit = make_planar_ground(TerrainKind::fractal, 4, 500);
    const PlanarGround rough = unit.scaled(0.04);
    for (double x_cm = 0; x_cm < 580; x_cm += 3.7) {
        EXPECT_NEAR(rough.ground_cm(x_cm), 0.04 * unit.ground_cm(x_cm), 1e-12);
        EXPECT_NEAR(rough.sinkage_cm(x_cm), 0.04 * unit.sinkage_cm(x_cm), 1e-12);
        EXPECT_GE(rough.sinkage_cm(x_cm), 0);
    }
}

TEST(PlanarGround, WheelsTouchTheGroundLessTheSinkage) {
    const PlanarGround ground = make_planar_ground(TerrainKind::fractal, 4, 500).scaled(0.08);
    for (double x_cm = 0; x_cm < 580; x_cm += 3.7) {
        EXPECT_EQ(ground.surface_cm(x_cm), ground.ground_cm(x_cm) - ground.sinkage_cm(x_cm));
    }
}

}  // namespace
