// motion_test.cpp - driving backwards, turning on the spot and being put down elsewhere: the world
// is driven by a script, the controller sees its inputs, and its commands are ignored.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <functional>

#include "host_sim/bind/host_target.hpp"
#include "host_sim/world/course.hpp"
#include "tests/system/program.hpp"

namespace {

using rover::SlipMode;

hal::Commands drive_percent(int left, int right) {
    hal::Commands commands;
    for (std::size_t wheel = 0; wheel < hal::kWheelCount; ++wheel) {
        commands.drive_percent[wheel] = static_cast<std::int8_t>(wheel % 2 == 0 ? left : right);
    }
    return commands;
}

const hal::Commands kAhead = drive_percent(100, 100), kBack = drive_percent(-100, -100),
                    kTurn = drive_percent(-100, 100), kStop = drive_percent(0, 0);

struct Part {
    double seconds;
    hal::Commands commands;
};

/// A drive over 0.02-rough ground by a script of commands; estimates by replaying its inputs.
host_sim::Log scripted(const std::vector<Part>& parts,
                       const std::vector<host_sim::HandMove>& moves = {}) {
    const host_sim::Vehicle vehicle = host_sim::rocky32();
    host_sim::DriveOptions course =
        host_sim::random_course(vehicle, host_sim::TerrainKind::wilcox1994, 0.02, 20.0, 11);
    course.hand_moves = moves;
    host_sim::Drive drive(course);
    host_sim::Log log;
    log.head.calibration = host_sim::nominal_calibration(vehicle);
    for (const Part& part : parts) {
        for (int i = 0; i < std::lround(10 * part.seconds); ++i) {
            host_sim::DriveStep driven = drive.step(part.commands);
            host_sim::LogStep& step = log.steps.emplace_back();
            step.time_ms = static_cast<std::uint32_t>(100 * (log.steps.size() - 1));
            step.inputs = driven.inputs;
            step.truth = driven.truth;
        }
    }
    EXPECT_EQ(drive.end(), host_sim::DriveEnd::running);
    host_sim::replay_on_host(log);
    return log;
}

const host_sim::LogStep& at(const host_sim::Log& log, double time_s) {
    return log.steps.at(static_cast<std::size_t>(std::lround(10 * time_s)));
}
double error_mm(const host_sim::LogStep& step) {
    return step.estimates->position_q4_mm / 16.0 - step.truth->position_mm;
}

/// Metres of wheel travel from `from_s` until the estimator tracks again; fails when it never does.
double reacquired_after_m(const host_sim::Log& log, double from_s) {
    const std::int32_t start = at(log, from_s).estimates->odometer_q4_mm;
    for (std::size_t i = static_cast<std::size_t>(10 * from_s); i < log.steps.size(); ++i) {
        const rover::Estimates& estimates = *log.steps[i].estimates;
        if (estimates.mode == SlipMode::tracking) {
            return (estimates.odometer_q4_mm - start) / 16000.0;
        }
    }
    ADD_FAILURE() << "never tracks again";
    return 1e9;
}

/// A wheelbase of ground that the front wheel has measured, then the 17 cycles that lock takes in
/// the median (docs/design/slip-and-sinkage.md, "Defined behaviour").
constexpr double kReacquireM = 0.5 * 6 / 5 + 17 * 0.06;

TEST(Motion, DrivingBackwardsIsFollowedByOdometryAndKnownGroundIsFoundAgain) {
    const host_sim::Log log = scripted({{300, kAhead}, {100, kBack}, {400, kAhead}});
    ASSERT_EQ(at(log, 299).estimates->mode, SlipMode::tracking);
    const double before_mm = error_mm(at(log, 299));
    // Two cycles backwards, 12 s, are needed to tell reversing from a rocking wheel.
    for (double time_s = 320; time_s < 399; time_s += 0.1) {
        ASSERT_EQ(at(log, time_s).estimates->mode, SlipMode::reversing) << time_s;
    }
    EXPECT_LT(at(log, 399).estimates->position_q4_mm, at(log, 299).estimates->position_q4_mm);
    // 1 m of wheel travel back, of which the odometer cannot tell slip from advance: 20 % of it.
    EXPECT_LE(std::abs(error_mm(at(log, 399)) - before_mm), 300);
    const double distance_m = reacquired_after_m(log, 400);
    std::printf("reversed 1 m: tracks again after %.2f m; error before %+.0f mm, after %+.0f mm\n",
                distance_m, before_mm, error_mm(log.steps.back()));
    EXPECT_LE(distance_m, 1.0 * 6 / 5 + kReacquireM) << "the way back, then a wheelbase";
    EXPECT_LE(std::abs(error_mm(log.steps.back())),
              log.steps.back().estimates->position_sigma_q4_mm / 16.0);
}

TEST(Motion, TurningOnTheSpotClaimsNoAdvance) {
    const host_sim::Log log = scripted({{300, kAhead}, {90, kTurn}, {300, kAhead}});
    ASSERT_EQ(at(log, 299).estimates->mode, SlipMode::tracking);
    for (double time_s = 312; time_s < 389; time_s += 0.1) {
        ASSERT_EQ(at(log, time_s).estimates->mode, SlipMode::turning) << time_s;
        ASSERT_EQ(at(log, time_s).estimates->available & rover::kAvailableSlip, 0) << time_s;
    }
    const auto position = [&](double time_s) { return at(log, time_s).estimates->position_q4_mm; };
    EXPECT_LE(std::abs(position(389) - position(312)), 16) << "1 mm";
    EXPECT_NEAR(error_mm(at(log, 389)), error_mm(at(log, 299)), 60) << "less than a cycle";
    const double distance_m = reacquired_after_m(log, 390);
    std::printf("turned 90 s: tracks again after %.2f m; error %+.0f mm\n", distance_m,
                error_mm(log.steps.back()));
    EXPECT_LE(distance_m, kReacquireM);
    EXPECT_LE(std::abs(error_mm(log.steps.back())),
              log.steps.back().estimates->position_sigma_q4_mm / 16.0);
}

TEST(Motion, BeingPutDownElsewhereWhileStandingIsNoticedAndSurvived) {
    const host_sim::Log log = scripted({{300, kAhead}, {20, kStop}, {400, kAhead}}, {{310, 70}});
    ASSERT_EQ(at(log, 309).estimates->mode, SlipMode::tracking);
    EXPECT_EQ(at(log, 311).estimates->mode, SlipMode::moved);
    EXPECT_EQ(at(log, 311).estimates->available & rover::kAvailableSlip, 0);
    const double distance_m = reacquired_after_m(log, 320);
    // By how far it was moved nobody told it: the error is that, and stays that.
    const double moved_mm = error_mm(at(log, 309)) - error_mm(at(log, 311));
    const double since_mm = error_mm(log.steps.back()) - error_mm(at(log, 311));
    std::printf("put down %.0f mm on: tracks again after %.2f m; error since then %+.0f mm\n",
                moved_mm, distance_m, since_mm);
    EXPECT_NEAR(moved_mm, 700, 60) << "and what is left of a cycle";
    EXPECT_LE(distance_m, kReacquireM);
    EXPECT_LE(std::abs(since_mm), 0.05 * 3300);
}

TEST(Motion, HandMoveOfTheProgramCountsAsTrueDistanceTheWheelsDidNotDrive) {
    const system_test::Folder folder;
    const system_test::Outcome run =
        system_test::rover85({"simulate", "--length", "6", "--seed", "5", "--roughness", "0.04",
                              "--hand-move", "300:70", "--out", folder / "drive"});
    ASSERT_EQ(run.exit_code, 0) << run.err;
    EXPECT_NE(run.out.find("The rover drove 7.0"), std::string::npos) << run.out;
    // 6 m and the ramp, 0.7 m of it carried; the wheels of a 6.0 : 5.0 slip turn 7.2 m or so.
    EXPECT_NE(run.out.find("its wheels turned 7."), std::string::npos) << run.out;
}

}  // namespace
