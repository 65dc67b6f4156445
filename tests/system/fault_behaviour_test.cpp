// fault_behaviour_test.cpp - what the controller does while a sensor of the simulated vehicle
// fails, and after it is back. Faults last from 300 s to 600 s of a drive at 1 cm/s wheel speed: 50
// slip-and-sinkage cycles each 6 s apart.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>
#include <string>

#include "firmware/config/controller_tuning.hpp"
#include "host_sim/bind/host_target.hpp"
#include "host_sim/world/course.hpp"

namespace {

using host_sim::LogStep;
using rover::SlipMode;

constexpr double kFromS = 300, kToS = 600;
constexpr double kCycleS = 6.0;
/// Up to a cycle until the frozen value is first seen, eight that repeat it, and one at half speed
/// while the slip alarm is up.
constexpr double kStuckS = (rover::kStuckCycles + 3) * kCycleS;
constexpr std::uint64_t kSeed = 5;

constexpr unsigned kAllAvailable = rover::kAvailableOdometry | rover::kAvailableAttitude |
                                   rover::kAvailableLinkage | rover::kAvailableSlip |
                                   rover::kAvailableLookAhead | rover::kAvailableSinkage;

class FaultyDrive {
public:
    explicit FaultyDrive(const std::string& faults) {
        const host_sim::Vehicle vehicle = host_sim::rocky32();
        host_sim::DriveOptions course =
            host_sim::random_course(vehicle, host_sim::TerrainKind::wilcox1994, 0.02, 8.0, kSeed);
        course.faults = host_sim::parse_faults(faults);
        host_sim::LogHead head;
        head.calibration = host_sim::nominal_calibration(vehicle);
        host_sim::Drive drive(course);
        log_ = host_sim::drive_on_host(drive, std::move(head));
        EXPECT_EQ(drive.end(), host_sim::DriveEnd::reached);
        std::printf(
            "%-50s position error at 300 s %+4.0f mm, at 600 s %+4.0f mm, at the end %+4.0f mm "
            "(sigma %.0f mm)\n",
            faults.c_str(), error_mm(at(kFromS)), error_mm(at(kToS)), end_error_mm(),
            end().position_sigma_q4_mm / 16.0);
    }

    [[nodiscard]] const LogStep& at(double time_s) const {
        return log_.steps.at(static_cast<std::size_t>(std::lround(10 * time_s)));
    }
    [[nodiscard]] const rover::Estimates& estimates_at(double time_s) const {
        return *at(time_s).estimates;
    }
    [[nodiscard]] const rover::Estimates& end() const { return *log_.steps.back().estimates; }
    [[nodiscard]] double end_error_mm() const { return error_mm(log_.steps.back()); }

    static double error_mm(const LogStep& step) {
        return step.estimates->position_q4_mm / 16.0 - step.truth->position_mm;
    }
    [[nodiscard]] double worst_error_mm() const {
        double worst = 0;
        for (const LogStep& step : log_.steps) worst = std::fmax(worst, std::abs(error_mm(step)));
        return worst;
    }

    /// Does `claim(estimates)` hold in every step of [from, to)?
    template <class Claim>
    [[nodiscard]] bool always(double from_s, double to_s, Claim claim) const {
        for (double time_s = from_s; time_s < to_s - 0.05; time_s += 0.1) {
            if (!claim(estimates_at(time_s))) {
                ADD_FAILURE() << "not so at " << time_s << " s: mode "
                              << static_cast<int>(estimates_at(time_s).mode) << ", available "
                              << int{estimates_at(time_s).available} << ", faults "
                              << estimates_at(time_s).faults;
                return false;
            }
        }
        return true;
    }

    /// Seconds from `from_s` until `claim(estimates)` first holds; empty: never.
    template <class Claim>
    [[nodiscard]] std::optional<double> delay_s(double from_s, Claim claim) const {
        for (double time_s = from_s; 10 * time_s < static_cast<double>(log_.steps.size() - 1);
             time_s += 0.1) {
            if (claim(estimates_at(time_s))) return time_s - from_s;
        }
        return std::nullopt;
    }

private:
    host_sim::Log log_;
};

bool has_all(const rover::Estimates& estimates) {
    return estimates.available == kAllAvailable;
}
bool tracks(const rover::Estimates& estimates) {
    return estimates.mode == SlipMode::tracking;
}

/// The map of one wheelbase, 50 cm, is ten cycles of 5 cm; three more until a match is believed,
/// and half as many again on ground that matches badly at first.
constexpr double kReacquireS = 1.5 * 13 * kCycleS + 60;

void expect_recovered(const FaultyDrive& drive) {
    const auto delay = drive.delay_s(
        kToS, [](const auto& estimates) { return tracks(estimates) && has_all(estimates); });
    ASSERT_TRUE(delay.has_value());
    EXPECT_LE(*delay, kReacquireS);
    EXPECT_TRUE(drive.always(kToS + *delay, kToS + *delay + 60, tracks));
    EXPECT_EQ(drive.end().faults, 0);
    EXPECT_LE(std::abs(drive.end_error_mm()), drive.end().position_sigma_q4_mm / 16.0);
}

TEST(FaultBehaviour, WithoutAFaultEverythingIsAvailable) {
    const FaultyDrive drive("");
    EXPECT_TRUE(drive.always(kFromS, kToS, has_all));
    EXPECT_TRUE(drive.always(0, kToS, [](const auto& e) { return e.faults == 0; }));
    EXPECT_LE(drive.worst_error_mm(), 200);
}

TEST(FaultBehaviour, AnAbsentLeftBogieMovesTheEstimatorToTheRightSide) {
    const FaultyDrive drive("bogie_left:absent@300-600");
    // The wheel heights stay available; slip waits until the right side has made its own map.
    EXPECT_TRUE(drive.always(
        kFromS, kToS, [](const auto& e) { return (e.available & rover::kAvailableLinkage) != 0; }));
    EXPECT_EQ(drive.estimates_at(kFromS + kCycleS).mode, SlipMode::reacquiring);
    EXPECT_EQ(drive.estimates_at(kFromS + kCycleS).available & rover::kAvailableSlip, 0);
    EXPECT_TRUE(drive.always(kFromS + kReacquireS, kToS, tracks));
    EXPECT_TRUE(drive.always(kFromS + kReacquireS, kToS, [](const auto& e) {
        return e.available == (rover::kAvailableOdometry | rover::kAvailableAttitude |
                               rover::kAvailableLinkage | rover::kAvailableSlip);
    })) << "the look-ahead belongs to the left side";
    EXPECT_LE(drive.worst_error_mm(), 250) << "ten cycles by odometry, none off by half";
    expect_recovered(drive);
}

TEST(FaultBehaviour, AStuckLeftBogieIsReportedWithinElevenCyclesAndReplacedByTheRight) {
    const FaultyDrive drive("bogie_left:stuck@300-600");
    const auto delay = drive.delay_s(
        kFromS, [](const auto& e) { return (e.faults & rover::kFaultBogieLeft) != 0; });
    ASSERT_TRUE(delay.has_value());
    EXPECT_LE(*delay, kStuckS);
    EXPECT_TRUE(drive.always(kFromS + *delay, kToS, [](const auto& e) {
        return e.faults == rover::kFaultBogieLeft && (e.events & rover::kEventSensorFault) != 0 &&
               (e.available & rover::kAvailableLinkage) != 0;
    }));
    EXPECT_TRUE(tracks(drive.estimates_at(kToS - 1)));
    EXPECT_LE(drive.worst_error_mm(), 400) << "ten cycles of a frozen linkage on top";
    expect_recovered(drive);
}

void expect_learned_odometry(const FaultyDrive& drive, double from_s) {
    EXPECT_TRUE(drive.always(from_s + 2 * kCycleS, kToS, [](const auto& e) {
        constexpr unsigned kNeedLinkage = rover::kAvailableLinkage | rover::kAvailableSlip |
                                          rover::kAvailableSinkage | rover::kAvailableLookAhead;
        return e.mode == SlipMode::odometry_only && (e.available & kNeedLinkage) == 0 &&
               (e.available & rover::kAvailableOdometry) != 0 &&
               (e.events & (rover::kEventSlipAlarm | rover::kEventSinkageAlarm)) == 0;
    }));
    // Position runs on with the share of the odometer that was learned before: 1 - slip, which is
    // reported in whole percent.
    const rover::Estimates &first = drive.estimates_at(from_s + 2 * kCycleS),
                           &last = drive.estimates_at(kToS - 1);
    const double share = static_cast<double>(last.position_q4_mm - first.position_q4_mm) /
                         (last.odometer_q4_mm - first.odometer_q4_mm);
    EXPECT_NEAR(share, 1 - first.slip_percent / 100.0, 0.006);
    EXPECT_GT(share, 0.75);  // the truth is 5/6
    EXPECT_LT(share, 0.93);
    EXPECT_GT(last.position_sigma_q4_mm, first.position_sigma_q4_mm + 16 * 200)
        << "uncertainty grows by a quarter of the distance";
}

TEST(FaultBehaviour, WithoutPitchThePositionFollowsLearnedOdometry) {
    const FaultyDrive drive("pitch:absent@300-600");
    EXPECT_EQ(drive.estimates_at(kFromS + 1).available & rover::kAvailableAttitude, 0);
    expect_learned_odometry(drive, kFromS);
    expect_recovered(drive);
}

TEST(FaultBehaviour, WithoutBothBogiesThePositionFollowsLearnedOdometry) {
    const FaultyDrive drive("bogie_left:absent@300-600,bogie_right:absent@300-600");
    EXPECT_NE(drive.estimates_at(kFromS + 1).available & rover::kAvailableAttitude, 0);
    expect_learned_odometry(drive, kFromS);
    expect_recovered(drive);
}

TEST(FaultBehaviour, AStuckDifferentialIsReportedAndThePositionFollowsLearnedOdometry) {
    const FaultyDrive drive("differential:stuck@300-600");
    const auto delay = drive.delay_s(
        kFromS, [](const auto& e) { return (e.faults & rover::kFaultDifferential) != 0; });
    ASSERT_TRUE(delay.has_value());
    EXPECT_LE(*delay, kStuckS);
    EXPECT_TRUE(drive.always(kFromS + *delay + kCycleS, kToS, [](const auto& e) {
        return e.mode == SlipMode::odometry_only && e.faults == rover::kFaultDifferential;
    }));
    expect_recovered(drive);
}

TEST(FaultBehaviour, WithoutTheRangeModuleOnlySinkageAndLookAheadAreGone) {
    for (const std::string kind : {"absent", "stuck"}) {
        const FaultyDrive drive("range:" + kind + "@300-600");
        const auto stale = drive.delay_s(
            kFromS, [](const auto& e) { return (e.faults & rover::kFaultRangeStale) != 0; });
        ASSERT_TRUE(stale.has_value());
        EXPECT_LE(*stale, 0.1 * (rover::kScanStaleSteps + 1));
        EXPECT_TRUE(drive.always(kFromS + 2, kToS, [](const auto& e) {
            return e.mode == SlipMode::tracking && e.faults == rover::kFaultRangeStale &&
                   (e.available & rover::kAvailableLookAhead) == 0 &&
                   (e.available & rover::kAvailableSlip) != 0;
        }));
        // The last samples still reach ahead for a wheelbase and a half.
        EXPECT_TRUE(drive.always(kFromS + 120, kToS, [](const auto& e) {
            return (e.available & rover::kAvailableSinkage) == 0;
        }));
        EXPECT_LE(drive.worst_error_mm(), 200) << "position does not use the look-ahead";
        expect_recovered(drive);
    }
}

TEST(FaultBehaviour, OneDeadTachometerIsOutvotedAndReported) {
    const FaultyDrive stuck("tach_front_left:stuck@300-600");
    EXPECT_TRUE(stuck.always(kFromS + 2 * kCycleS, kToS, [](const auto& e) {
        return e.faults == rover::kFaultTachometer && e.mode == SlipMode::tracking &&
               e.available == kAllAvailable;
    }));
    EXPECT_LE(stuck.worst_error_mm(), 200);
    expect_recovered(stuck);
    const FaultyDrive absent("tach_front_left:absent@300-600");
    EXPECT_TRUE(absent.always(
        kFromS, kToS, [](const auto& e) { return e.faults == 0 && e.available == kAllAvailable; }));
    EXPECT_EQ(absent.estimates_at(kToS).odometer_q4_mm, stuck.estimates_at(kToS).odometer_q4_mm);
}

TEST(FaultBehaviour, WithoutAnyTachometerNoOdometryIsClaimedAndThePositionStands) {
    const FaultyDrive drive("tach:absent@300-600");
    const rover::Estimates& before = drive.estimates_at(kFromS - 0.1);
    EXPECT_TRUE(drive.always(kFromS, kToS, [](const auto& e) {
        return (e.available & rover::kAvailableOdometry) == 0;
    }));
    EXPECT_TRUE(drive.always(kFromS + 2 * kCycleS, kToS, [](const auto& e) {
        return (e.available & (rover::kAvailableSlip | rover::kAvailableSinkage)) == 0;
    }));
    EXPECT_EQ(drive.estimates_at(kToS - 1).odometer_q4_mm, before.odometer_q4_mm);
    EXPECT_LE(std::abs(drive.estimates_at(kToS - 1).position_q4_mm - before.position_q4_mm),
              60 * 16);
    const auto back = drive.delay_s(kToS, tracks);
    ASSERT_TRUE(back.has_value());
    EXPECT_LE(*back, kReacquireS);
}

}  // namespace
