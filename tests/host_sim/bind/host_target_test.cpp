// host_target_test.cpp - the native controller in the simulated world: drive, replay, degradation.
#include "host_sim/bind/host_target.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "firmware/link/telemetry.hpp"
#include "host_sim/world/course.hpp"

namespace {

using host_sim::Log;
using host_sim::LogStep;

host_sim::DriveOptions course(std::uint64_t seed) {
    auto options = host_sim::random_course(host_sim::rocky32(), host_sim::TerrainKind::fractal,
                                           0.02, 15.0, seed);
    host_sim::add_exit_ramp(options, 100);
    return options;
}

Log drive(const host_sim::DriveOptions& options) {
    host_sim::Drive world(options);
    host_sim::LogHead head;
    head.calibration = host_sim::nominal_calibration(options.vehicle);
    Log log = host_sim::drive_on_host(world, head);
    EXPECT_EQ(world.end(), host_sim::DriveEnd::reached);
    return log;
}

double end_error_percent(const Log& log) {
    const LogStep& last = log.steps.back();
    const double true_mm = last.truth->position_mm;
    return 100 * (last.estimates->position_q4_mm / 16.0 - true_mm) / true_mm;
}

bool same_estimates(const Log& a, const Log& b) {
    if (a.steps.size() != b.steps.size()) return false;
    for (std::size_t i = 0; i < a.steps.size(); ++i) {
        const hal::Commands& x = *a.steps[i].commands;
        const hal::Commands& y = *b.steps[i].commands;
        if (x.telemetry_size != y.telemetry_size) return false;
        if (std::memcmp(x.telemetry, y.telemetry, x.telemetry_size) != 0) return false;
        if (std::memcmp(x.drive_percent, y.drive_percent, sizeof x.drive_percent) != 0) {
            return false;
        }
    }
    return true;
}

TEST(HostTarget, IdentityNamesVersionSourcesAndTarget) {
    const std::string identity = host_sim::host_image_identity();
    EXPECT_EQ(identity.find("rover85 "), 0u);
    EXPECT_NE(identity.find(" sources "), std::string::npos);
    EXPECT_TRUE(identity.ends_with(" host"));
}

TEST(HostTarget, EstimatesAreThoseOfTheTelemetryFrameOfTheStep) {
    const Log log = drive(course(3));
    EXPECT_EQ(log.head.image_identity, host_sim::host_image_identity());
    for (std::size_t i = 0; i < log.steps.size(); ++i) {
        const LogStep& step = log.steps[i];
        ASSERT_TRUE(step.estimates && step.commands && step.truth);
        ASSERT_EQ(step.time_ms, 100 * i);
        const std::uint8_t* frame = step.commands->telemetry;
        ASSERT_EQ(frame[4] | frame[5] << 8, static_cast<int>(i & 0xFFFFu));
        ASSERT_EQ(step.estimates->step_count, i & 0xFFFFu);
        ASSERT_EQ(step.estimates->tick_count, step.inputs.tick_count);
    }
}

TEST(HostTarget, PositionIsBetterThanTheOdometerByAnOrderOfMagnitude) {
    for (const std::uint64_t seed : {11u, 12u, 13u, 14u}) {
        const Log log = drive(course(seed));
        const LogStep& last = log.steps.back();
        const double odometer_mm = last.estimates->odometer_q4_mm / 16.0;
        const double odometer_error =
            100 * (odometer_mm - last.truth->position_mm) / last.truth->position_mm;
        EXPECT_GT(odometer_error, 12) << seed;  // 6 cm of rim for 5 cm of way, but for the ramp
        EXPECT_LT(std::abs(end_error_percent(log)), 1.2) << seed;
        EXPECT_TRUE(last.estimates->available & rover::kAvailableSlip);
        EXPECT_EQ(last.estimates->faults, 0);
    }
}

TEST(HostTarget, WheelsThatCountOutOfStepDoNoHarm) {
    auto options = course(21);
    options.sensors.tach_spread = 0.01;
    const Log log = drive(options);
    // A side is its middle wheel; the spread of the mean of both is below 0.7 %.
    EXPECT_LT(std::abs(end_error_percent(log)), 2.0);
}

TEST(HostTarget, ReplayOfADriveGivesTheSameBytes) {
    const Log driven = drive(course(4));
    Log replayed = driven;
    for (LogStep& step : replayed.steps) {
        step.estimates.reset();
        step.commands.reset();
    }
    replayed.head.image_identity = "another";
    host_sim::replay_on_host(replayed);
    EXPECT_TRUE(same_estimates(driven, replayed));
    EXPECT_EQ(replayed.head.image_identity, host_sim::host_image_identity());
    replayed.steps[50].inputs.tach_count[0] = 9999;
    replayed.steps[50].inputs.tach_count[2] = 9999;
    host_sim::replay_on_host(replayed);
    EXPECT_FALSE(same_estimates(driven, replayed));
}

TEST(HostTarget, TheSameSeedGivesTheSameDriveAndAnotherAnother) {
    EXPECT_TRUE(same_estimates(drive(course(5)), drive(course(5))));
    EXPECT_FALSE(same_estimates(drive(course(5)), drive(course(6))));
}

TEST(HostTarget, AnEmptyLogIsReplayedAndProgressEndsAtOne) {
    Log log;
    double progress = -1;
    host_sim::replay_on_host(log, [&](double share) { progress = share; });
    EXPECT_EQ(progress, 1.0);
    EXPECT_TRUE(log.steps.empty());
}

TEST(HostTarget, ALostPotentiometerIsDrivenThroughOnTheOtherSide) {
    auto options = course(31);
    options.faults = host_sim::parse_faults("bogie_left:absent@300-");
    const Log log = drive(options);
    const rover::Estimates& last = *log.steps.back().estimates;
    EXPECT_TRUE(last.available & rover::kAvailableSlip);
    EXPECT_FALSE(last.available & rover::kAvailableSinkage);
    EXPECT_LT(std::abs(end_error_percent(log)), 2.5);
}

TEST(HostTarget, ADeadTachometerIsDrivenThrough) {
    auto options = course(32);
    options.faults = host_sim::parse_faults("tach_middle_left:stuck@100-");
    const Log log = drive(options);
    EXPECT_TRUE(log.steps.back().estimates->faults & rover::kFaultTachometer);
    EXPECT_LT(std::abs(end_error_percent(log)), 1.2);
}

TEST(HostTarget, AStuckDifferentialIsFoundAndTheRestIsOdometryWithTheLearnedSlip) {
    auto options = course(33);
    options.faults = host_sim::parse_faults("differential:stuck@400-");
    const Log log = drive(options);
    const rover::Estimates& last = *log.steps.back().estimates;
    EXPECT_TRUE(last.faults & rover::kFaultDifferential);
    EXPECT_EQ(last.mode, rover::SlipMode::odometry_only);
    EXPECT_FALSE(last.available & (rover::kAvailableLinkage | rover::kAvailableSlip));
    // Until it is found, wrong matches spoil what was learned: half of the slip is left.
    EXPECT_LT(std::abs(end_error_percent(log)), 10.0);
}

}  // namespace
