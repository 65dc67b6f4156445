// profile_test.cpp - known curves, damaged files, the Mars profiles.
#include "host_sim/world/profile.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string>

#include "host_sim/world/random.hpp"

namespace host_sim {
namespace {

const std::string kMars = ROVER_SOURCE_DIR "/../shared/data/mars-height-profiles";

std::vector<Profile> mars_profiles() {
    std::vector<std::string> paths;
    if (!std::filesystem::exists(kMars)) return {};
    for (const auto& entry : std::filesystem::directory_iterator(kMars)) {
        const std::string name = entry.path().filename().string();
        if (name.ends_with(".csv") && name != "index.csv") paths.push_back(entry.path().string());
    }
    std::sort(paths.begin(), paths.end());
    std::vector<Profile> profiles;
    for (const std::string& path : paths) profiles.push_back(load_profile(path));
    return profiles;
}

Profile made(const char* name, double length_m, double (*height_m)(double)) {
    Profile profile;
    profile.name = name;
    for (double x = 0; x <= length_m + 1e-9; x += 0.01) {
        profile.distance_m.push_back(x);
        profile.height_m.push_back(height_m(x));
    }
    return profile;
}

TEST(ParseProfile, ReadsTheTwoColumnsAndIgnoresOthers) {
    const Profile profile =
        parse_profile("note, height_m ,distance_m\r\na,1.5,-1\r\n\r\nb,-2,0.5\r\n", "dir/p.csv");
    EXPECT_EQ(profile.name, "p.csv");
    EXPECT_EQ(profile.distance_m, (std::vector<double>{-1, 0.5}));
    EXPECT_EQ(profile.height_m, (std::vector<double>{1.5, -2}));
    EXPECT_EQ(profile.length_m(), 1.5);
}

TEST(ParseProfile, RefusesWithFileAndLine) {
    const std::string head = "distance_m,height_m\n";
    const struct {
        std::string text;
        const char* expected;
    } cases[] = {
        {"", "p.csv: is empty"},
        {"distance_m\n0\n1\n", "p.csv:1: column 'height_m' is missing"},
        {head, "p.csv:1: a profile needs two rows"},
        {head + "0,0\n", "p.csv:2: a profile needs two rows"},
        {head + "0,0\n1\n", "p.csv:3: has 1 fields, the header 2"},
        {head + "0,0\n\n1,2,3\n", "p.csv:4: has 3 fields"},
        {head + "0,0\n0,1\n", "p.csv:3: distance_m does not increase"},
        {head + "0,0\n-1,1\n", "p.csv:3: distance_m does not increase"},
        {head + "0,0\nx,1\n", "p.csv:3: 'x' in column 'distance_m'"},
        {head + "0,0\n1,1e999\n", "p.csv:3: '1e999'"},
        {head + "0,0\n1,0x10\n", "p.csv:3: '0x10'"},
        {head + "0,0\n1,\n", "p.csv:3: ''"},
        {head + "0,inf\n1,0\n", "p.csv:2: 'inf'"},
        {head + "0,0\n20000,0\n", "p.csv:3: the profile is longer than 10 km"},
        {head + "0,0\n1,20000\n", "p.csv:3: height_m is beyond 10 km"},
        {head + "0,0\n0.001,0\n", "shorter than 2.5 mm"},
    };
    for (const auto& one : cases) {
        try {
            parse_profile(one.text, "p.csv");
            ADD_FAILURE() << one.text;
        } catch (const InputError& error) {
            EXPECT_NE(std::string(error.what()).find(one.expected), std::string::npos)
                << error.what();
        }
    }
}

TEST(ProfileTerrain, IsLinearBetweenThePointsAndBeginsAtZero) {
    Profile profile;
    profile.distance_m = {2, 2.1, 3};
    profile.height_m = {0, 0.1, -0.8};
    const Terrain terrain = profile_terrain(profile);
    EXPECT_EQ(terrain.begin_cm(), 0);
    EXPECT_EQ(terrain.end_cm(), 100);
    for (double x = 0; x <= 100; x += 0.25) {
        ASSERT_NEAR(terrain.height_cm(x), x <= 10 ? x : 10 - (x - 10), 1e-9) << x;
    }
}

TEST(Stitch, OfMatchingSlopesIsTheSlopeItself) {
    const auto slope = [](double x) { return 0.2 * x + 7; };
    const std::vector<Profile> profiles = {made("a", 2, slope), made("b", 1.5, slope)};
    const Course course = stitch(profiles, 5, 0.3);
    EXPECT_GE(course.profile.length_m(), 5);
    ASSERT_GE(course.seams.size(), 1u);
    EXPECT_FALSE(course.seams[0].after_reversed);
    EXPECT_NEAR(course.seams[0].slope_difference, 0, 1e-9);
    EXPECT_NEAR(course.seams[0].rms_difference_m, 0, 1e-9);
    EXPECT_NEAR(course.seams[0].begin_m, 1.7, 1e-9);
    EXPECT_NEAR(course.seams[0].end_m, 2.0, 1e-9);
    EXPECT_NEAR(course.seams[0].level_shift_m, 0.2 * 1.7, 1e-9);
    for (std::size_t i = 0; course.profile.distance_m[i] < 2.9; ++i) {
        ASSERT_NEAR(course.profile.height_m[i], slope(course.profile.distance_m[i]), 1e-9);
    }
    // Used up: they follow again, reversed, so the slope turns.
    EXPECT_TRUE(course.seams[1].after_reversed);
    EXPECT_NEAR(course.seams[1].slope_difference, -0.4, 1e-9);
}

TEST(Stitch, HeightAndSlopeAreContinuousAcrossSeams) {
    const auto wave = [](double x) { return 0.05 * std::sin(4 * x); };
    const auto tilt = [](double x) { return 3 - 0.1 * x; };
    const Course course = stitch({made("a", 2, wave), made("b", 2, tilt)}, 12, 0.4);
    // Slopes of the parts are at most 0.2, the blend adds difference * 1.5 / length.
    double last_slope = 0;
    for (std::size_t i = 1; i < course.profile.height_m.size(); ++i) {
        const double slope = (course.profile.height_m[i] - course.profile.height_m[i - 1]) / 0.0025;
        ASSERT_LT(std::abs(slope), 0.5) << course.profile.distance_m[i];
        if (i > 1) {
            ASSERT_LT(std::abs(slope - last_slope), 0.02) << course.profile.distance_m[i];
        }
        last_slope = slope;
    }
}

TEST(Stitch, OutsideSeamsTheGroundIsTheProfilesShifted) {
    const auto wave = [](double x) { return 0.05 * std::sin(9 * x); };
    const auto bump = [](double x) { return std::exp(-x * x); };
    const std::vector<Profile> parts = {made("a", 2, wave), made("b", 3, bump)};
    const Course course = stitch(parts, 4, 0.5);
    ASSERT_EQ(course.seams.size(), 1u);
    const Seam& seam = course.seams[0];
    EXPECT_EQ(seam.before, "a");
    EXPECT_EQ(seam.after, "b");
    for (std::size_t i = 0; i < course.profile.height_m.size(); i += 4) {  // every 1 cm
        const double x = course.profile.distance_m[i];
        if (x < seam.begin_m) {
            ASSERT_NEAR(course.profile.height_m[i], wave(x), 1e-9);
        } else if (x > seam.end_m) {
            ASSERT_NEAR(course.profile.height_m[i], bump(x - seam.begin_m) + seam.level_shift_m,
                        1e-9);
        }
    }
}

TEST(Stitch, RefusesWhatItCannotJoin) {
    const auto flat = [](double) { return 0.0; };
    const std::vector<Profile> one = {made("a", 1, flat)};
    EXPECT_THROW(stitch({}, 5, 0.2), InputError);
    EXPECT_THROW(stitch(one, 0, 0.2), InputError);
    EXPECT_THROW(stitch(one, 1e6, 0.2), InputError);
    EXPECT_THROW(stitch(one, 5, 0.01), InputError);
    EXPECT_THROW(stitch(one, 5, 0.6), InputError);
    EXPECT_THROW(stitch(one, 5, std::nan("")), InputError);
    EXPECT_GE(stitch(one, 5, 0.5).profile.length_m(), 5);
    EXPECT_TRUE(stitch(one, 0.5, 0.2).seams.empty());
}

// The paper's own terrain, written out as a profile, is as rough as it was made.
TEST(RoughnessOf, ThePapersTerrainIsItsRoughness) {
    for (const double roughness : {0.01, 0.04}) {
        std::vector<Profile> profiles;
        for (std::uint64_t seed = 1; seed <= 20; ++seed) {
            const Terrain terrain = make_terrain(TerrainKind::wilcox1994, seed).scaled(roughness);
            Profile profile;
            for (std::size_t i = 0; i < terrain.sample_count(); ++i) {
                profile.distance_m.push_back(terrain.sample_x_cm(i) / 100);
                profile.height_m.push_back(terrain.sample_cm(i) / 100);
            }
            profiles.push_back(profile);
        }
        for (const double bin_cm : {2.5, 5.0}) {
            const Roughness found = roughness_of(profiles, bin_cm);
            EXPECT_NEAR(found.by_step / roughness, 1, 0.02);
            EXPECT_NEAR(found.by_projection / roughness, 1, 0.02);
        }
    }
}

TEST(RoughnessOf, AMeanSlopeDoesNotCount) {
    const Roughness found = roughness_of({made("a", 2, [](double x) { return 0.3 * x; })}, 2.5);
    EXPECT_NEAR(found.rms_step_cm, 0, 1e-9);
    EXPECT_NEAR(found.by_projection, 0, 1e-9);
    EXPECT_EQ(found.steps, 80u);
    EXPECT_THROW(roughness_of({made("a", 0.05, [](double) { return 0.0; })}, 5), InputError);
    EXPECT_THROW(roughness_of({}, 5), InputError);
    for (const double bin_cm : {0.0, 0.3, 8.0, -1.0}) {
        EXPECT_THROW(roughness_of({made("a", 2, [](double) { return 0.0; })}, bin_cm), InputError);
    }
}

// The data set's description gives RMS height changes between points 2.5 and 5 cm apart, mean slope
// removed: rear 5.4 and 9.1 mm, front 4.7 and 7.5 mm.
TEST(MarsData, RoughnessIsThatOfTheDataSetsDescription) {
    const std::vector<Profile> all = mars_profiles();
    if (all.empty()) GTEST_SKIP() << kMars << " is not there";
    ASSERT_EQ(all.size(), 18u);
    std::vector<Profile> rear;
    std::vector<Profile> front;
    for (const Profile& profile : all) {
        (profile.name.starts_with("rear") ? rear : front).push_back(profile);
    }
    EXPECT_NEAR(roughness_of(rear, 2.5).rms_step_cm, 0.54, 0.03);
    EXPECT_NEAR(roughness_of(rear, 5.0).rms_step_cm, 0.91, 0.05);
    EXPECT_NEAR(roughness_of(front, 2.5).rms_step_cm, 0.47, 0.03);
    EXPECT_NEAR(roughness_of(front, 5.0).rms_step_cm, 0.75, 0.05);
    for (const double bin_cm : {2.5, 5.0}) {
        const Roughness found = roughness_of(all, bin_cm);
        std::printf("bin %.1f cm: step %.2f mm (roughness %.3f), projection %.2f mm (%.3f)\n",
                    bin_cm, 10 * found.rms_step_cm, found.by_step, 10 * found.rms_projection_cm,
                    found.by_projection);
        EXPECT_GT(found.by_step, 0.01);
        EXPECT_LT(found.by_projection, 0.08);
    }
}

TEST(MarsData, EighteenProfilesMakeACourseOfTwentyMetres) {
    const std::vector<Profile> all = mars_profiles();
    if (all.empty()) GTEST_SKIP() << kMars << " is not there";
    const Course course = stitch(all, 20, 0.3);
    EXPECT_GE(course.profile.length_m(), 20);
    EXPECT_LT(course.profile.length_m(), 24);
    double end_m = 0;
    for (const Seam& seam : course.seams) {
        EXPECT_GT(seam.begin_m, end_m) << "seams overlap";
        EXPECT_LT(seam.rms_difference_m, 0.05);
        end_m = seam.end_m;
    }
    // The course is no rougher than the ground it is made of.
    EXPECT_LT(roughness_of({course.profile}, 2.5).by_step, 1.2 * roughness_of(all, 2.5).by_step);
}

}  // namespace
}  // namespace host_sim
