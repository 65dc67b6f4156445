// course_test.cpp - the ready-made drives are what their names say and run to their end.
#include "host_sim/world/course.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

namespace host_sim {
namespace {

TEST(TerrainKindNames, AreTheTwoOfTheCommandLine) {
    EXPECT_EQ(terrain_kind("fractal"), TerrainKind::fractal);
    EXPECT_EQ(terrain_kind("wilcox1994"), TerrainKind::wilcox1994);
    EXPECT_EQ(terrain_kind("Fractal"), std::nullopt);
    EXPECT_EQ(terrain_kind(""), std::nullopt);
}

TEST(RandomCourse, IsThePapersGroundAtTheWantedRoughness) {
    const DriveOptions options = random_course(rocky32(), TerrainKind::wilcox1994, 0.02, 10, 7);
    const Terrain ground = make_terrain(TerrainKind::wilcox1994, 7, {0, 1000, 200});
    const SinkageField sinkage = make_sinkage(TerrainKind::wilcox1994, 7, {0, 1000, 200});
    for (double x = 0; x < 1200; x += 1.7) {
        ASSERT_NEAR(options.left.ground_cm(x), 0.02 * ground.height_cm(x), 1e-9);
        ASSERT_NEAR(options.left.sinkage_cm(x), 0.02 * sinkage.depth_cm(x), 1e-9);
    }
    Drive drive(options);
    while (!drive.finished()) drive.step(full_speed_ahead());
    EXPECT_EQ(drive.end(), DriveEnd::reached);
    EXPECT_GE(drive.state().position_cm, 1000 - 1e-9);
}

TEST(RandomCourse, RefusesRoughnessAndLengthOutOfRange) {
    for (const double roughness : {-0.01, 1.5, std::nan("")}) {
        EXPECT_THROW(random_course(rocky32(), TerrainKind::fractal, roughness, 10, 1), InputError);
    }
    for (const double length_m : {0.0, -1.0, 1e6, std::nan("")}) {
        EXPECT_THROW(random_course(rocky32(), TerrainKind::fractal, 0.01, length_m, 1), InputError);
    }
}

/// Drives to x = 0 and expects level attitude, no sinkage and no slip on the way.
void expect_firm_ramp(const DriveOptions& options, double ramp_cm) {
    const std::string where = "ramp of " + std::to_string(ramp_cm) + " cm";
    EXPECT_EQ(options.start_cm, -ramp_cm) << where;
    for (double x = -ramp_cm - 100; x < 0; x += 0.7) {
        ASSERT_NEAR(options.left.ground_cm(x), options.left.ground_cm(0), 1e-9) << x;
        ASSERT_EQ(options.left.sinkage_cm(x), 0) << x;
    }
    Drive drive(options);
    const double length_cm = options.vehicle.rocker_cm + options.vehicle.bogie_arm_cm;
    while (drive.state().position_cm < ramp_cm) {
        drive.step(full_speed_ahead());
        ASSERT_FALSE(drive.finished());
        if (drive.state().position_cm >= ramp_cm) break;
        ASSERT_NEAR(drive.state().position_cm, drive.state().odometer_cm, 1e-9);
        if (drive.state().position_cm + length_cm < ramp_cm - kTerrainSpacingCm) {
            ASSERT_NEAR(drive.state().pitch_rad, 0, 1e-9);
        }
    }
}

TEST(ExitRamp, IsLevelAndFirmAndNothingSlipsOnIt) {
    DriveOptions field = random_course(rocky32(), TerrainKind::fractal, 0.04, 5, 7);
    const DriveOptions bare = field;
    add_exit_ramp(field, 100);
    expect_firm_ramp(field, 100);
    EXPECT_EQ(field.length_cm, bare.length_cm + 100);
    for (double x = 0; x < 500; x += 1.7) {
        ASSERT_NEAR(field.left.ground_cm(x), bare.left.ground_cm(x), 0.05) << x;  // resampled
    }
    Profile profile;
    profile.name = "waves";
    for (int i = 0; i <= 300; ++i) {
        profile.distance_m.push_back(0.01 * i);
        profile.height_m.push_back(0.02 * std::sin(0.1 * i));
    }
    DriveOptions rut = profile_course(rocky32(), profile, SinkageLaw{30, 1.7}, 0.4, 3);
    add_exit_ramp(rut, 60);
    expect_firm_ramp(rut, 60);
}

TEST(ExitRamp, RefusesLengthsOutOfRangeAndZeroChangesNothing) {
    DriveOptions options = random_course(rocky32(), TerrainKind::fractal, 0.04, 5, 7);
    const double length_cm = options.length_cm;
    add_exit_ramp(options, 0);
    EXPECT_EQ(options.start_cm, 0);
    EXPECT_EQ(options.length_cm, length_cm);
    for (const double ramp_cm : {-1.0, 1001.0, std::nan("")}) {
        EXPECT_THROW(add_exit_ramp(options, ramp_cm), InputError);
    }
}

TEST(ProfileCourse, RunsAsFarAsItSeesGround) {
    Profile profile;
    profile.name = "waves";
    for (int i = 0; i <= 300; ++i) {
        profile.distance_m.push_back(0.01 * i);
        profile.height_m.push_back(0.02 * std::sin(0.1 * i));
    }
    const SinkageLaw law{30, 1.7};
    Drive drive(profile_course(rocky32(), profile, law, 0.4, 3));
    EXPECT_NEAR(drive.options().length_cm, 300 - 80 - 6.5, 1e-9);
    while (!drive.finished()) {
        const DriveStep step = drive.step(full_speed_ahead());
        ASSERT_EQ(step.inputs.range_present, 3);
        ASSERT_GE(step.truth.sinkage_mm, 4 - 1e-9);
    }
    EXPECT_EQ(drive.end(), DriveEnd::reached);
    profile.distance_m.resize(50);
    profile.height_m.resize(50);
    EXPECT_THROW(profile_course(rocky32(), profile, law, 0.4, 3), InputError);
}

// Every wheel of the course stands on the ground it is given; the Mars profiles included when
// there.
TEST(MarsData, CoursePutsAllWheelsOnTheGround) {
    const std::string folder = ROVER_SOURCE_DIR "/../shared/data/mars-height-profiles/";
    std::vector<Profile> profiles;
    try {
        for (const char* name :
             {"rear_long_01", "front_fine_03", "rear_fine_02", "front_long_04"}) {
            profiles.push_back(load_profile(folder + name + ".csv"));
        }
    } catch (const InputError& error) {
        GTEST_SKIP() << error.what();
    }
    const Course course = stitch(profiles, 20, 0.3);
    Drive drive(profile_course(rocky32(), course.profile, built_in_sinkage_law(WheelKind::grouser),
                               0.5, 1));
    while (!drive.finished()) {
        drive.step(full_speed_ahead());
        ASSERT_LT(drive.state().left.residual_cm, 1e-6) << drive.state().position_cm;
    }
    EXPECT_EQ(drive.end(), DriveEnd::reached);
}

}  // namespace
}  // namespace host_sim
