// drive_test.cpp - motion, geometry and determinism of the whole vehicle.
#include "host_sim/world/drive.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <functional>
#include <numbers>
#include <vector>

namespace host_sim {
namespace {

Terrain level() {
    return Terrain(-200, 100, std::vector<double>(100, 0.0));
}

DriveOptions plain(double length_cm) {
    DriveOptions options;
    options.vehicle = rocky32();
    options.left = Track(level(), SinkageField());
    options.advance = {AdvanceKind::constant, 5, 0, 0};
    options.length_cm = length_cm;
    return options;
}

DriveOptions rough(double length_cm, double roughness, std::uint64_t seed) {
    DriveOptions options = plain(length_cm);
    const TerrainSpan span{150, length_cm, 200};
    options.left = Track(make_terrain(TerrainKind::fractal, seed, span).scaled(roughness),
                         make_sinkage(TerrainKind::fractal, seed, span).scaled(roughness));
    options.advance.kind = AdvanceKind::gaussian;
    options.advance.sigma_cm = 1;
    options.seed = seed;
    return options;
}

hal::Commands drive_at(int left_percent, int right_percent) {
    hal::Commands commands;
    for (std::size_t wheel = 0; wheel < hal::kWheelCount; ++wheel) {
        commands.drive_percent[wheel] =
            static_cast<std::int8_t>(wheel % 2 == 0 ? left_percent : right_percent);
    }
    return commands;
}

bool same(const hal::RawInputs& a, const hal::RawInputs& b) {
    return a.tick_count == b.tick_count && a.tach_present == b.tach_present &&
           std::memcmp(a.adc_q4_count, b.adc_q4_count, sizeof a.adc_q4_count) == 0 &&
           std::memcmp(a.tach_count, b.tach_count, sizeof a.tach_count) == 0 &&
           a.range_scan_count == b.range_scan_count && a.range_present == b.range_present &&
           std::memcmp(a.range_q1_mm, b.range_q1_mm, sizeof a.range_q1_mm) == 0;
}

// 1 cm/s of rim speed, 5 cm of advance for 6 cm of odometer.
TEST(Drive, AdvancesFiveCentimetresForSixOfOdometer) {
    Drive drive(plain(50));
    const DriveStep first = drive.step(full_speed_ahead());
    EXPECT_EQ(drive.state().time_s, 0);
    EXPECT_EQ(first.truth.position_mm, 0);
    EXPECT_EQ(first.inputs.tick_count, 0);
    EXPECT_TRUE(std::isnan(first.truth.slip));
    for (int i = 1; i <= 300; ++i) {
        const DriveStep step = drive.step(full_speed_ahead());
        ASSERT_NEAR(drive.state().time_s, 0.1 * i, 1e-9);
        ASSERT_NEAR(drive.state().odometer_cm, 0.1 * i, 1e-9);
        ASSERT_NEAR(step.truth.position_mm, 10 * 0.1 * i * 5 / 6, 1e-6);
        ASSERT_EQ(step.inputs.tick_count, 10 * i);
        const double pulses = 0.1 * i / (2 * std::numbers::pi * 6.5) * 2000;
        ASSERT_NEAR(step.inputs.tach_count[0], pulses, 1.0);
        if (i > 60) {
            ASSERT_NEAR(step.truth.slip, 1.0 / 6, 1e-12);
        }
    }
}

TEST(Drive, EndsWhenTheRearWheelHasComeTheLength) {
    Drive drive(plain(50));
    int steps = 0;
    while (!drive.finished()) {
        drive.step(full_speed_ahead());
        ASSERT_LT(++steps, 1000);
    }
    EXPECT_EQ(drive.end(), DriveEnd::reached);
    EXPECT_NEAR(steps, 600, 2);
    EXPECT_GE(drive.state().position_cm, 50 - 1e-9);
    const double position = drive.state().position_cm;
    drive.step(full_speed_ahead());
    EXPECT_EQ(drive.state().position_cm, position);
}

TEST(Drive, GivesUpWhenOutOfTimeOrFarBehindTheStart) {
    DriveOptions options = plain(50);
    options.max_time_s = 10;
    Drive idle(options);
    while (!idle.finished()) idle.step({});
    EXPECT_EQ(idle.end(), DriveEnd::out_of_time);
    EXPECT_NEAR(idle.state().time_s, 10, 0.11);
    Drive back(plain(50));
    while (!back.finished()) back.step(drive_at(-100, -100));
    EXPECT_EQ(back.end(), DriveEnd::left_course);
}

TEST(Drive, ReversesAndTurnsOnTheSpot) {
    Drive drive(plain(50));
    for (int i = 0; i < 201; ++i) drive.step(full_speed_ahead());
    const double there = drive.state().position_cm;
    const double travel = drive.state().rim_travel_cm[0];
    for (int i = 0; i < 100; ++i) drive.step(drive_at(60, -60));
    EXPECT_NEAR(drive.state().position_cm, there, 1e-9);
    EXPECT_NEAR(drive.state().odometer_cm, 20, 1e-9);
    EXPECT_NEAR(drive.state().rim_travel_cm[0], travel + 6, 1e-9);
    EXPECT_NEAR(drive.state().rim_travel_cm[1], travel - 6, 1e-9);
    hal::RawInputs inputs;
    for (int i = 0; i < 200; ++i) inputs = drive.step(drive_at(-50, -50)).inputs;
    EXPECT_NEAR(drive.state().position_cm, there - 10 * 5.0 / 6, 1e-6);
    EXPECT_NEAR(drive.state().odometer_cm, 10, 1e-9);
}

TEST(Drive, CommandsBeyondFullSpeedAreFullSpeed) {
    Drive drive(plain(50));
    drive.step({});
    drive.step(drive_at(127, 127));
    EXPECT_NEAR(drive.state().odometer_cm, 0.1, 1e-12);
    drive.step(drive_at(-128, -128));
    EXPECT_NEAR(drive.state().odometer_cm, 0, 1e-12);
}

TEST(Drive, MovedByHandChangesThePlaceAndNoWheel) {
    DriveOptions options = rough(300, 0.02, 4);
    options.hand_moves = {{30, 40}, {20, -12}};
    options.sensors = SensorModel::noiseless();
    Drive drive(options);
    options.hand_moves.clear();
    Drive undisturbed(options);
    for (int i = 0; i <= 320; ++i) {
        const DriveStep a = drive.step(full_speed_ahead());
        const DriveStep b = undisturbed.step(full_speed_ahead());
        ASSERT_EQ(std::memcmp(a.inputs.tach_count, b.inputs.tach_count, sizeof a.inputs.tach_count),
                  0);
        const double moved = i >= 300 ? 28 : i >= 200 ? -12 : 0;
        ASSERT_NEAR(a.truth.position_mm - b.truth.position_mm, 10 * moved, 1e-6) << i;
    }
}

// The inputs mean what the state is: angles decoded with the nominal record give z(1), z(2) and
// pitch within converter resolution, the look-ahead height its ground.
TEST(Drive, InputsDecodeToTheTrueGeometry) {
    DriveOptions options = rough(400, 0.04, 5);
    const TerrainSpan span{150, 400, 200};
    const Terrain right = make_terrain(TerrainKind::fractal, 5, span, "right").scaled(0.03);
    options.right = Track(right, SinkageField());
    options.sensors.range_noise_mm = 0;
    Drive drive(options);
    const hal::Calibration record = nominal_calibration(options.vehicle);
    double roll_seen = 0;
    while (!drive.finished()) {
        const DriveStep step = drive.step(full_speed_ahead());
        double angle[5];
        for (std::size_t i = 0; i < 5; ++i) {
            angle[i] = (step.inputs.adc_q4_count[i] - 32760.0) * record.angle[i].gain_q16 / 65536 /
                       65536 * 2 * std::numbers::pi;
        }
        const DriveState& state = drive.state();
        const double rho_left = angle[3] + angle[2];
        const double rho_right = angle[3] - angle[2];
        ASSERT_NEAR(10 * state.left.z_middle_cm,
                    375 * std::sin(rho_left) - 125 * std::sin(rho_left + angle[0]), 0.3);
        ASSERT_NEAR(10 * state.left.z_front_cm,
                    375 * std::sin(rho_left) + 125 * std::sin(rho_left + angle[0]), 0.5);
        ASSERT_NEAR(10 * state.right.z_middle_cm,
                    375 * std::sin(rho_right) - 125 * std::sin(rho_right + angle[1]), 0.3);
        ASSERT_NEAR(angle[4], state.roll_rad, 1e-3);
        roll_seen = std::max(roll_seen, std::abs(state.roll_rad));

        // Heights at the wheels are those of the load-bearing surface.
        const double rear = state.position_cm;
        ASSERT_NEAR(step.truth.surface_front_mm - step.truth.surface_rear_mm,
                    10 * state.left.z_front_cm, 1e-5);
        ASSERT_NEAR(step.truth.ground_front_mm - step.truth.surface_front_mm, step.truth.sinkage_mm,
                    1e-9);
        // Sample 0, 41.25 cm ahead of the body reference, lies on the undisturbed ground.
        ASSERT_EQ(step.inputs.range_present, 3);
        const double below = step.inputs.range_q1_mm[0] / 20.0 - 6.5;
        const double pitch = state.pitch_rad;
        const double x = rear + 18.75 * std::cos(state.left.rocker_rad) + 41.25 * std::cos(pitch) -
                         below * std::sin(pitch);
        const double y = 0.1 * step.truth.surface_rear_mm + 6.5 +
                         18.75 * std::sin(state.left.rocker_rad) + 41.25 * std::sin(pitch) +
                         below * std::cos(pitch);
        ASSERT_NEAR(y, drive.options().left.ground_cm(x), 0.05);
    }
    EXPECT_GT(roll_seen, 0.01);
}

// Left side higher: roll is positive (right side down), and the differential carries the rest.
TEST(Drive, HigherLeftGroundRollsTheRightSideDown) {
    DriveOptions options = plain(20);
    options.left = Track(Terrain(-200, 100, std::vector<double>(100, 4.0)), SinkageField());
    options.right = Track(level(), SinkageField());
    Drive drive(options);
    drive.step({});
    EXPECT_NEAR(drive.state().roll_rad, std::atan(4.0 / 40.0), 1e-9);
    EXPECT_NEAR(drive.state().pitch_rad, 0, 1e-9);
}

TEST(Drive, FollowsFromItsSeedAlone) {
    const auto run = [](std::uint64_t seed) {
        DriveOptions options = rough(60, 0.04, 6);
        options.seed = seed;
        options.faults = parse_faults("pitch:dropped@3-30,tach:dropped@10-");
        Drive drive(options);
        std::vector<hal::RawInputs> all;
        while (!drive.finished()) all.push_back(drive.step(full_speed_ahead()).inputs);
        return all;
    };
    const auto first = run(1);
    const auto again = run(1);
    const auto other = run(2);
    ASSERT_EQ(first.size(), again.size());
    for (std::size_t i = 0; i < first.size(); ++i) ASSERT_TRUE(same(first[i], again[i])) << i;
    int differing = 0;
    for (std::size_t i = 0; i < std::min(first.size(), other.size()); ++i) {
        differing += same(first[i], other[i]) ? 0 : 1;
    }
    EXPECT_GT(differing, 500);
}

// More noise must not change where the vehicle goes.
TEST(Drive, SensorsAndFaultsDoNotMoveTheVehicle) {
    DriveOptions options = rough(60, 0.04, 6);
    Drive quiet(options);
    options.sensors.potentiometer_noise_rad = 0.01;
    options.faults = parse_faults("tach:absent@0-,bogie_left:stuck@1-");
    Drive loud(options);
    while (!quiet.finished()) {
        ASSERT_EQ(quiet.step(full_speed_ahead()).truth.position_mm,
                  loud.step(full_speed_ahead()).truth.position_mm);
    }
}

TEST(Drive, MeanAdvanceIsThatOfTheModel) {
    DriveOptions options = rough(6250, 0.01, 8);
    Drive drive(options);
    while (!drive.finished()) drive.step(full_speed_ahead());
    // 1250 cycles of N(5, 1): the mean is known to 0.03.
    EXPECT_NEAR(6 * drive.state().position_cm / drive.state().odometer_cm, 5,
                5 * 1 / std::sqrt(1250));
}

TEST(Drive, SlopeAndSinkageSlowTheVehicle) {
    const auto odometer = [](double grade, double depth_cm) {
        DriveOptions options = plain(300);
        options.left = Track(Terrain(-100, 1000, {-100 * grade, 900 * grade}), depth_cm, {0, 1});
        options.advance = {AdvanceKind::slope_sinkage, 5, 0, 0};
        Drive drive(options);
        while (!drive.finished()) drive.step(full_speed_ahead());
        return drive.state().odometer_cm;
    };
    EXPECT_NEAR(odometer(0, 0), 360, 0.2);
    // Slope is z(2)/50 = sin(angle); mean 5 (1 - slope/0.6) of 6 cm.
    const double slope = std::sin(std::atan(0.2));
    EXPECT_NEAR(odometer(0.2, 0), 360 / (1 - slope / 0.6), 1);
    EXPECT_NEAR(odometer(-0.2, 0), 360, 0.2);
    EXPECT_NEAR(odometer(0, 2), 360 / (1 - 2 / 5.0), 1);
}

// Sinkage = static + law(slip of the previous cycle): slip 1/6 throughout.
TEST(Drive, RutDepthFollowsTheSlipOfThePreviousCycle) {
    DriveOptions options = plain(100);
    options.left = Track(level(), 0.5, {30, 1});
    Drive drive(options);
    for (int i = 0; i < 60; ++i) drive.step(full_speed_ahead());
    EXPECT_NEAR(drive.state().sinkage_front_cm, 0.5, 1e-6);
    for (int i = 0; i < 400; ++i) drive.step(full_speed_ahead());
    EXPECT_NEAR(drive.state().sinkage_front_cm, 0.5 + 3.0 / 6, 1e-4);
}

TEST(Drive, SamplesBeyondTheGroundAreAbsent) {
    DriveOptions options = plain(40);
    options.left =
        Track(Terrain(0, 10, std::vector<double>(12, 0.0)), SinkageField());  // to 110 cm
    Drive drive(options);
    while (!drive.finished()) {
        const hal::RawInputs inputs = drive.step(full_speed_ahead()).inputs;
        const bool both = drive.state().position_cm + 80 <= 110;
        ASSERT_EQ(inputs.range_present, both ? 3 : 1) << drive.state().position_cm;
    }
    EXPECT_NEAR(drivable_length_cm(options.vehicle, options.left.ground(), 0), 30 - 6.5, 1e-9);
    EXPECT_EQ(drivable_length_cm(options.vehicle, Terrain(), 0), 0);
}

TEST(Drive, RefusesOptionsItCannotDrive) {
    const auto refused = [](const std::function<void(DriveOptions&)>& change) {
        DriveOptions options = plain(50);
        change(options);
        EXPECT_THROW(Drive{options}, InputError);
    };
    refused([](DriveOptions& o) { o.vehicle = Vehicle{}; });
    refused([](DriveOptions& o) { o.length_cm = 0; });
    refused([](DriveOptions& o) { o.length_cm = std::nan(""); });
    refused([](DriveOptions& o) { o.length_cm = 1e9; });
    refused([](DriveOptions& o) { o.start_cm = -1000; });
    refused([](DriveOptions& o) { o.start_cm = std::nan(""); });
    refused([](DriveOptions& o) { o.right = Track(); });
    refused([](DriveOptions& o) { o.max_time_s = -1; });
    refused([](DriveOptions& o) { o.advance.mean_cm = INFINITY; });
    refused([](DriveOptions& o) { o.advance.sigma_cm = -1; });
    refused([](DriveOptions& o) { o.hand_moves = {{1, std::nan("")}}; });
    refused([](DriveOptions& o) { o.sensors.range_scan_steps = 0; });
}

// Any commands at all, on the roughest ground: the state stays finite and the course ends.
TEST(Drive, SurvivesRandomCommandsOnRoughGround) {
    Random random = stream(1, "commands");
    for (std::uint64_t seed = 1; seed <= 5; ++seed) {
        DriveOptions options = rough(100, 0.08, seed);
        options.max_time_s = 100;
        options.hand_moves = {{5, 30}, {9, -60}, {50, 1000}};
        Drive drive(options);
        while (!drive.finished()) {
            hal::Commands commands;
            for (std::int8_t& percent : commands.drive_percent) {
                percent = static_cast<std::int8_t>(random.uniform(-128, 128));
            }
            const DriveStep step = drive.step(commands);
            ASSERT_TRUE(std::isfinite(step.truth.surface_front_mm));
            ASSERT_TRUE(std::isfinite(drive.state().pitch_rad));
        }
    }
}

}  // namespace
}  // namespace host_sim
