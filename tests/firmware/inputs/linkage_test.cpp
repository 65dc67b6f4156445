// linkage_test.cpp - kinematics against the simulated world's, which is written in double and knows
// nothing of the firmware.
#include "firmware/inputs/linkage.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>

#include "host_sim/world/linkage.hpp"

namespace {

using hal::AngleChannel;

constexpr double kRadPerBrad = std::numbers::pi / 32768.0;

std::int16_t brad(double degrees) {
    return static_cast<std::int16_t>(std::lround(degrees * 65536.0 / 360.0));
}

rover::Angles angles(std::int16_t bogie_left, std::int16_t bogie_right, std::int16_t differential,
                     std::int16_t pitch) {
    rover::Angles result;
    const std::int16_t values[] = {bogie_left, bogie_right, differential, pitch, 0};
    std::copy(std::begin(values), std::end(values), result.brad);
    result.valid = rover::kAllAngles;
    return result;
}

void invalidate(rover::Angles& angles, AngleChannel channel) {
    angles.brad[static_cast<std::size_t>(channel)] = 0;
    angles.valid = static_cast<std::uint8_t>(angles.valid & ~rover::channel_bit(channel));
}

TEST(Linkage, HeightsAndDistancesAreWithinATenthOfAMillimetreAndAUnitOverAllPoses) {
    double worst_mm = 0;
    double worst_q6 = 0;
    for (int rocker_deg = -60; rocker_deg <= 60; rocker_deg += 3) {
        for (int bogie_deg = -45; bogie_deg <= 45; bogie_deg += 3) {
            for (int pitch_deg = -20; pitch_deg <= 20; pitch_deg += 20) {
                const std::int16_t pitch = brad(pitch_deg);
                const std::int16_t differential = brad(rocker_deg - pitch_deg);
                const std::int16_t bogie = brad(bogie_deg);
                const auto pose = rover::linkage_pose(angles(bogie, 0, differential, pitch));
                ASSERT_EQ(pose.side, rover::Side::left);
                const double rho = (pitch + differential) * kRadPerBrad;
                const double beta = rho + bogie * kRadPerBrad;
                const auto off_mm = [&](std::int16_t q4, double real_cm) {
                    worst_mm = std::fmax(worst_mm, std::abs(q4 / 16.0 - 10 * real_cm));
                };
                const auto off_q6 = [&](std::uint16_t q6, double real_cm) {
                    const double real_q6 = std::fmax(0.0, real_cm * 64 / 2.5);
                    worst_q6 = std::fmax(worst_q6, std::abs(q6 - real_q6));
                };
                off_mm(pose.middle_height_q4_mm, 37.5 * std::sin(rho) - 12.5 * std::sin(beta));
                off_mm(pose.front_height_q4_mm, 37.5 * std::sin(rho) + 12.5 * std::sin(beta));
                off_q6(pose.middle_distance_q6_bin, 37.5 * std::cos(rho) - 12.5 * std::cos(beta));
                off_q6(pose.front_distance_q6_bin, 37.5 * std::cos(rho) + 12.5 * std::cos(beta));
            }
        }
    }
    RecordProperty("worst_height_mm", std::to_string(worst_mm));
    RecordProperty("worst_distance_q6_bin", std::to_string(worst_q6));
    // Both sines are within 1.1 / 16384 (0.034 mm at 375 + 125 mm), half their sum is rounded down
    // (0.008 mm), the height to 1/16 mm (0.031 mm).
    EXPECT_LE(worst_mm, 0.073);
    EXPECT_LE(worst_q6, 0.61);  // 0.24 mm: the same, and half a unit
}

/// A rover on hills, both sides on their own: what the sensors read gives back the contacts.
TEST(Linkage, TellsEachSideOfTheSimulatedRoverFromItsSensors) {
    const host_sim::LinkageGeometry geometry;
    for (int step = 0; step < 200; ++step) {
        const double x_cm = step * 1.7;
        const auto ground_left = [](double x) { return 6 * std::sin(x / 23) + std::sin(x / 5); };
        const auto ground_right = [](double x) { return 5 * std::cos(x / 31) - std::sin(x / 6); };
        const auto left = host_sim::solve_linkage(geometry, ground_left, x_cm);
        const auto right = host_sim::solve_linkage(geometry, ground_right, x_cm);
        const auto to_brad = [](double rad) {
            return static_cast<std::int16_t>(std::lround(rad / kRadPerBrad));
        };
        rover::Angles sensed = angles(to_brad(left.bogie_rad - left.rocker_rad),
                                      to_brad(right.bogie_rad - right.rocker_rad),
                                      to_brad((left.rocker_rad - right.rocker_rad) / 2),
                                      to_brad((left.rocker_rad + right.rocker_rad) / 2));
        const auto check = [&](const host_sim::LinkagePose& real, rover::Side side) {
            const auto pose = rover::linkage_pose(sensed);
            ASSERT_EQ(pose.side, side);
            // Angles in whole brad are 0.1 mrad: 0.04 mm at the rocker's arm, each of three.
            EXPECT_NEAR(pose.middle_height_q4_mm / 16.0, 10 * real.z_middle_cm, 0.12);
            EXPECT_NEAR(pose.front_height_q4_mm / 16.0, 10 * real.z_front_cm, 0.12);
            EXPECT_NEAR(pose.middle_distance_q6_bin * 25 / 64.0, 10 * (real.x_middle_cm - x_cm),
                        0.35);
            EXPECT_NEAR(pose.front_distance_q6_bin * 25 / 64.0, 10 * (real.x_front_cm - x_cm),
                        0.35);
            EXPECT_NEAR(pose.rocker_brad * kRadPerBrad, real.rocker_rad, 2e-4);
            EXPECT_NEAR(pose.bogie_brad * kRadPerBrad, real.bogie_rad, 3e-4);
        };
        check(left, rover::Side::left);
        invalidate(sensed, AngleChannel::bogie_left);
        check(right, rover::Side::right);
    }
}

TEST(Linkage, NeedsPitchDifferentialAndOneBogie) {
    const auto side_without = [](std::initializer_list<AngleChannel> missing) {
        rover::Angles sensed = angles(100, 200, 300, 400);
        for (const AngleChannel channel : missing) invalidate(sensed, channel);
        return rover::linkage_pose(sensed).side;
    };
    using enum AngleChannel;
    EXPECT_EQ(side_without({}), rover::Side::left);
    EXPECT_EQ(side_without({roll, bogie_right}), rover::Side::left);
    EXPECT_EQ(side_without({bogie_left}), rover::Side::right);
    EXPECT_EQ(side_without({bogie_left, bogie_right}), rover::Side::none);
    EXPECT_EQ(side_without({pitch}), rover::Side::none);
    EXPECT_EQ(side_without({differential}), rover::Side::none);
}

/// Where a sample lies for a rocker's and a body's angle; the bogie lies along the rocker.
rover::GroundPoint ground_point(std::int16_t rocker_brad, std::int16_t pitch_brad,
                                std::uint8_t index, int range_q1_mm) {
    const auto differential = static_cast<std::int16_t>(rocker_brad - pitch_brad);
    const auto pose = rover::linkage_pose(angles(0, 0, differential, pitch_brad));
    rover::LookAhead view;
    rover::look_ahead(pose, pitch_brad, view);
    for (; index != 0; --index) rover::look_further(view);
    rover::GroundPoint point;
    rover::ground_point(view, static_cast<std::int16_t>(range_q1_mm), 1040, point);
    return point;
}

TEST(GroundPoint, IsWhereTheSimulatedLookAheadSampleLies) {
    double worst_height_mm = 0;
    double worst_place_mm = 0;
    int seen = 0;
    for (int slope = -40; slope <= 40; slope += 5) {
        for (int rocker_deg = -30; rocker_deg <= 30; rocker_deg += 10) {
            for (int pitch_deg = -30; pitch_deg <= 30; pitch_deg += 10) {
                const std::int16_t rocker = brad(rocker_deg);
                const std::int16_t pitch = brad(pitch_deg);
                host_sim::RangeView view;
                view.rocker_rad = rocker * kRadPerBrad;
                view.pitch_rad = pitch * kRadPerBrad;
                const auto ground = [&](double x) { return 0.01 * slope * x + std::sin(x / 9); };
                view.rear_height_cm = ground(0);
                for (std::uint8_t i = 0; i < 2; ++i) {
                    const double ahead_cm = (i == 0 ? 60 : 80) - 18.75;
                    const auto sight = host_sim::look_ahead(view, ahead_cm, ground);
                    if (!sight.seen || std::abs(sight.height_cm) > 40) continue;
                    ++seen;
                    const auto range = static_cast<std::int16_t>(std::lround(20 * sight.height_cm));
                    const auto point = ground_point(rocker, pitch, i, range);
                    const double height_mm = 10 * (ground(sight.x_cm) - ground(0));
                    worst_height_mm =
                        std::fmax(worst_height_mm, std::abs(point.height_q4_mm / 16.0 - height_mm));
                    worst_place_mm =
                        std::fmax(worst_place_mm,
                                  std::abs(point.distance_q6_bin * 25 / 64.0 - 10 * sight.x_cm));
                }
            }
        }
    }
    EXPECT_GT(seen, 1000);
    RecordProperty("worst_height_mm", std::to_string(worst_height_mm));
    RecordProperty("worst_place_mm", std::to_string(worst_place_mm));
    EXPECT_LE(worst_height_mm, 0.40);  // a quarter of a millimetre is the range's own rounding
    EXPECT_LE(worst_place_mm, 0.45);
}

TEST(GroundPoint, ARangeBeyondFourHundredMillimetresIsTakenAsThat) {
    EXPECT_NEAR(ground_point(0, 0, 1, 32767).height_q4_mm / 16.0, 400, 0.2);
    EXPECT_NEAR(ground_point(0, 0, 1, -32768).height_q4_mm / 16.0, -400, 0.2);
    EXPECT_EQ(ground_point(0, brad(89), 1, 32767).distance_q6_bin, 0) << "not behind";
}

}  // namespace
