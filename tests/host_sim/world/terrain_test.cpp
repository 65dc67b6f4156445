// terrain_test.cpp - against the paper's table of terrain statistics and std::sin.
#include "host_sim/world/terrain.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

#include "host_sim/world/random.hpp"

namespace host_sim {
namespace {

// Wilcox 1994, bottom of Table 1: RMS bin-to-bin change and RMS projection error in cm at unit
// roughness, bins 0.25, 0.50, ... 7.75 cm.
constexpr double kPaper[31][2] = {
    {2.40, 1.29},   {4.62, 4.07},   {6.58, 6.38},   {8.30, 7.47},   {9.90, 7.85},   {11.50, 8.12},
    {13.14, 8.74},  {14.81, 9.40},  {16.50, 10.14}, {18.18, 10.82}, {19.86, 11.50}, {21.52, 12.51},
    {23.16, 13.81}, {24.77, 14.78}, {26.40, 15.74}, {27.87, 16.84}, {29.73, 18.87}, {31.38, 20.58},
    {33.06, 22.26}, {34.70, 24.27}, {36.33, 26.42}, {38.02, 28.56}, {39.60, 30.45}, {41.24, 32.49},
    {42.69, 33.57}, {44.22, 35.31}, {45.69, 37.22}, {47.24, 39.24}, {48.90, 41.42}, {50.43, 43.60},
    {51.91, 45.52}};

TEST(Wilcox1994Terrain, ReproducesThePapersTableOfTerrainStatistics) {
    constexpr int kSeeds = 40;
    double step_cm[31] = {};
    double projection_cm[31] = {};
    for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
        const Terrain terrain = make_terrain(TerrainKind::wilcox1994, seed);
        for (int i = 0; i < 31; ++i) {
            const TerrainStatistics found =
                terrain_statistics(terrain, 0.25 * (i + 1), 0, kCourseLengthCm);
            step_cm[i] += found.rms_step_cm / kSeeds;
            projection_cm[i] += found.rms_projection_cm / kSeeds;
        }
    }
    for (int i = 0; i < 31; ++i) {
        EXPECT_NEAR(step_cm[i] / kPaper[i][0], 1.0, 0.015) << "bin " << 0.25 * (i + 1);
        EXPECT_NEAR(projection_cm[i] / kPaper[i][1], 1.0, 0.015) << "bin " << 0.25 * (i + 1);
    }
}

TEST(Wilcox1994Terrain, HasThePapersAmplitudeOfOnePointOneOneMetres) {
    double mean_cm = 0;
    for (std::uint64_t seed = 1; seed <= 40; ++seed) {
        mean_cm +=
            rms_height_cm(make_terrain(TerrainKind::wilcox1994, seed), 0, kCourseLengthCm) / 40;
    }
    EXPECT_NEAR(mean_cm, 111.0, 1.7);
}

// Each sine of random amplitude a * wavelength, a uniform in [0, 1], has the variance
// wavelength^2 / 6; the 20 of them together (93.3 cm)^2.
TEST(FractalTerrain, HasTheVarianceOfUniformAmplitudes) {
    double expected = 0;
    for (int i = 0; i < kSineCount; ++i) expected += std::pow(1.3, 2 * i) / 6.0;
    constexpr int kSeeds = 400;
    double mean = 0;
    TerrainSpan span;
    span.length_cm = 1500;
    for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
        const double rms = rms_height_cm(make_terrain(TerrainKind::fractal, seed, span), 0, 1500);
        mean += rms * rms / kSeeds;
    }
    // The variance of a^2 is 4/45, so that of the mean over the seeds is known; 5 sigma.
    double spread = 0;
    for (int i = 0; i < kSineCount; ++i) spread += std::pow(1.3, 4 * i) / 4.0 * 4.0 / 45.0;
    EXPECT_NEAR(mean, expected, 5 * std::sqrt(spread / kSeeds));
}

// The recurrence against std::sin, with amplitudes and phases drawn anew in the documented order.
TEST(MakeTerrain, EqualsTheSumOfSines) {
    for (const TerrainKind kind : {TerrainKind::fractal, TerrainKind::wilcox1994}) {
        TerrainSpan span;
        span.behind_cm = 100;
        const Terrain terrain = make_terrain(kind, 11, span);
        for (std::size_t i = 0; i < terrain.sample_count(); i += 37) {
            Random random = stream(11, "terrain");
            double expected = 0;
            for (std::size_t k = 0; k < kSineCount; ++k) {
                const double wavelength = std::pow(1.3, static_cast<double>(k));
                const double share = random.uniform();
                const double phase = 2 * std::numbers::pi * random.uniform();
                const double amplitude =
                    kind == TerrainKind::fractal ? share : kWilcox1994AmplitudePerWavelength[k];
                expected +=
                    amplitude * wavelength *
                    std::sin(2 * std::numbers::pi * terrain.sample_x_cm(i) / wavelength + phase);
            }
            ASSERT_NEAR(terrain.sample_cm(i), expected, 1e-7);
        }
    }
}

TEST(MakeTerrain, MarginsDoNotChangeTheCourse) {
    TerrainSpan wide;
    wide.behind_cm = 100;
    wide.ahead_cm = 500;
    const Terrain plain = make_terrain(TerrainKind::fractal, 3);
    const Terrain wider = make_terrain(TerrainKind::fractal, 3, wide);
    EXPECT_EQ(plain.begin_cm(), 0.0);
    EXPECT_EQ(wider.begin_cm(), -100.0);
    EXPECT_EQ(plain.end_cm(), 6450.0);
    EXPECT_EQ(wider.end_cm(), 6750.0);
    for (double x = 0; x < 6250; x += 3.1) {
        ASSERT_NEAR(plain.height_cm(x), wider.height_cm(x), 1e-9);
    }
}

TEST(MakeTerrain, RefusesImpossibleSpans) {
    EXPECT_THROW(make_terrain(TerrainKind::fractal, 1, {0, 0, 0}), std::invalid_argument);
    EXPECT_THROW(make_terrain(TerrainKind::fractal, 1, {-1, 10, 0}), std::invalid_argument);
    EXPECT_THROW(make_terrain(TerrainKind::fractal, 1, {0, 1e9, 0}), std::invalid_argument);
    EXPECT_THROW(make_terrain(TerrainKind::fractal, 1, {0, std::nan(""), 0}),
                 std::invalid_argument);
}

TEST(Terrain, IsLinearBetweenSamplesAndHoldsItsEnds) {
    const Terrain terrain(10, 2, {1, 3, -1});
    EXPECT_DOUBLE_EQ(terrain.height_cm(10), 1);
    EXPECT_DOUBLE_EQ(terrain.height_cm(11), 2);
    EXPECT_DOUBLE_EQ(terrain.height_cm(12.5), 2);
    EXPECT_DOUBLE_EQ(terrain.height_cm(14), -1);
    EXPECT_DOUBLE_EQ(terrain.height_cm(1e300), -1);
    EXPECT_DOUBLE_EQ(terrain.height_cm(-1e300), 1);
    EXPECT_DOUBLE_EQ(terrain.height_cm(std::numeric_limits<double>::infinity()), -1);
    EXPECT_DOUBLE_EQ(terrain.height_cm(std::nan("")), 1);
    EXPECT_DOUBLE_EQ(terrain.scaled(0.5).height_cm(11), 1);
    EXPECT_DOUBLE_EQ(terrain.scaled(0.5).scaled(4).height_cm(11), 4);
    EXPECT_DOUBLE_EQ(Terrain().height_cm(123), 0);
}

TEST(Terrain, RefusesSamplesItCannotInterpolate) {
    EXPECT_THROW(Terrain(0, 1, {1}), std::invalid_argument);
    EXPECT_THROW(Terrain(0, 0, {1, 2}), std::invalid_argument);
    EXPECT_THROW(Terrain(0, std::nan(""), {1, 2}), std::invalid_argument);
    EXPECT_THROW(Terrain(0, 1, {1, std::nan("")}), std::invalid_argument);
    EXPECT_THROW(Terrain().scaled(std::nan("")), std::invalid_argument);
}

TEST(SinkageField, IsClippedAtZeroAndATwentyPercentFieldOfItsOwn) {
    constexpr int kSeeds = 100;
    double squares = 0;
    double product = 0;
    for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
        const SinkageField sinkage = make_sinkage(TerrainKind::wilcox1994, seed);
        const Terrain ground = make_terrain(TerrainKind::wilcox1994, seed);
        const double weight = 1.0 / static_cast<double>(ground.sample_count());
        double zeros = 0;
        for (std::size_t i = 0; i < ground.sample_count(); ++i) {
            const double depth = sinkage.curve().sample_cm(i);
            ASSERT_GE(depth, 0);
            zeros += depth == 0 ? weight : 0;
            squares += depth * depth * weight / kSeeds;
            product += depth * ground.sample_cm(i) * weight / kSeeds;
        }
        EXPECT_NEAR(zeros, 0.5, 0.1) << seed;
    }
    // Half of a symmetric field of RMS 0.2 * 1.11 m is kept.
    EXPECT_NEAR(std::sqrt(squares), 0.2 * 111.0 / std::sqrt(2.0), 0.05 * 15.7);
    // Sines of equal wavelength correlate in one seed, not over many.
    EXPECT_LT(std::abs(product), 0.2 * 15.7 * 111);
    EXPECT_THROW(make_sinkage(TerrainKind::fractal, 1).scaled(-1), std::invalid_argument);
    EXPECT_EQ(SinkageField().depth_cm(5), 0);
}

TEST(LoadBearing, IsGroundMinusSinkage) {
    const Terrain ground = make_terrain(TerrainKind::fractal, 5).scaled(0.02);
    const SinkageField sinkage = make_sinkage(TerrainKind::fractal, 5).scaled(0.02);
    const Terrain surface = load_bearing(ground, sinkage);
    for (double x = -10; x < 6500; x += 1.7) {
        ASSERT_NEAR(surface.height_cm(x), ground.height_cm(x) - sinkage.depth_cm(x), 1e-9);
    }
}

TEST(TerrainStatistics, KnowsALineAndAParabola) {
    std::vector<double> line;
    std::vector<double> parabola;
    for (int i = 0; i <= 400; ++i) {
        line.push_back(0.3 * 0.25 * i);
        parabola.push_back(0.5 * 0.0625 * i * i);
    }
    const TerrainStatistics of_line = terrain_statistics(Terrain(0, 0.25, line), 2.5);
    EXPECT_NEAR(of_line.rms_step_cm, 0.75, 1e-12);
    EXPECT_NEAR(of_line.rms_projection_cm, 0, 1e-12);
    // The second difference of x^2/2 is the square of the bin.
    EXPECT_NEAR(terrain_statistics(Terrain(0, 0.25, parabola), 2.5).rms_projection_cm, 6.25, 1e-9);
    EXPECT_TRUE(std::isnan(terrain_statistics(Terrain(0, 0.25, line), 51).rms_step_cm));
    EXPECT_TRUE(std::isnan(terrain_statistics(Terrain(0, 0.25, line), 0).rms_step_cm));
}

}  // namespace
}  // namespace host_sim
