// real_logs_test.cpp - public recordings of real vehicles, imported and replayed by the program:
// what their sensors cannot know is not claimed. Skipped without the study data.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "host_sim/log/log_io.hpp"
#include "tests/system/program.hpp"

namespace {

using system_test::Folder;
using system_test::Outcome;
using system_test::rover85;
using testing::HasSubstr;

/// Travel by the tachometers since the first step, in pulses of both sides together: of each side's
/// present wheels the mean, of which all are equal here; a missing side moves as the other.
double tachometer_travel_mm(const host_sim::Log& log, std::size_t step) {
    double pulses[2] = {0, 0};
    int present[2] = {0, 0};
    for (std::size_t wheel = 0; wheel < hal::kWheelCount; ++wheel) {
        if ((log.steps.front().inputs.tach_present >> wheel & 1) == 0) continue;
        std::int64_t total = 0;
        for (std::size_t i = 1; i <= step; ++i) {
            total += static_cast<std::int16_t>(log.steps[i].inputs.tach_count[wheel] -
                                               log.steps[i - 1].inputs.tach_count[wheel]);
        }
        pulses[wheel % 2] += static_cast<double>(total);
        ++present[wheel % 2];
    }
    double sides = 0, sum = 0;
    for (int side = 0; side < 2; ++side) {
        if (present[side] == 0) continue;
        sum += pulses[side] / present[side];
        ++sides;
    }
    return sum / sides * log.head.calibration.tach_q16_mm_per_count / 65536.0;
}

void expect_nothing_invented(const host_sim::Log& log, unsigned available) {
    for (const host_sim::LogStep& step : log.steps) {
        const rover::Estimates& estimates = *step.estimates;
        ASSERT_EQ(unsigned{estimates.available}, available) << step.time_ms << " ms";
        ASSERT_EQ(estimates.faults, 0) << step.time_ms << " ms: an absent sensor is no fault";
        constexpr unsigned kMay = rover::kEventCycle | rover::kEventOverspeed;
        ASSERT_EQ(estimates.events & ~kMay, 0u) << step.time_ms << " ms";
        ASSERT_NE(estimates.mode, rover::SlipMode::tracking);
        ASSERT_NE(estimates.mode, rover::SlipMode::reacquiring);
        ASSERT_NE(estimates.mode, rover::SlipMode::moved);
        ASSERT_EQ(estimates.slip_percent, 0);
        ASSERT_EQ(estimates.sinkage_q4_mm, 0);
    }
    // Overspeed is no invention only where a step is longer than 15 mm.
    for (std::size_t step = 1; step < log.steps.size(); ++step) {
        if ((log.steps[step].estimates->events & rover::kEventOverspeed) == 0) continue;
        const double moved_mm =
            tachometer_travel_mm(log, step) - tachometer_travel_mm(log, step - 1);
        std::printf("overspeed at %.1f s: %.0f mm in a step\n", log.steps[step].time_ms / 1000.0,
                    moved_mm);
        ASSERT_GT(std::abs(moved_mm), 15);
    }
    // 1/16 mm is one unit; what is below it is carried.
    for (std::size_t step = 0; step < log.steps.size(); step += 50) {
        ASSERT_NEAR(log.steps[step].estimates->odometer_q4_mm, 16 * tachometer_travel_mm(log, step),
                    1.01)
            << "step " << step;
    }
}

host_sim::Log replayed(const Folder& folder, const std::vector<std::string>& import) {
    std::vector<std::string> arguments = {"import"};
    arguments.insert(arguments.end(), import.begin(), import.end());
    arguments.insert(arguments.end(), {"-o", folder / "run.rlog"});
    const Outcome imported = rover85(arguments);
    EXPECT_EQ(imported.exit_code, 0) << imported.err;
    const Outcome run = rover85({"replay", folder / "run.rlog", "--out", folder / "out"});
    EXPECT_EQ(run.exit_code, 0) << run.err;
    const std::string page = system_test::read_bytes(folder / "out/report.html");
    for (const std::string& text : {run.out, page}) {
        EXPECT_THAT(text, HasSubstr("Estimates not available on this vehicle"));
        EXPECT_THAT(text, HasSubstr("slip and slip-corrected position"));
        EXPECT_THAT(text, HasSubstr("no usable suspension geometry"));
        EXPECT_THAT(text, testing::Not(HasSubstr("alarm went up")));
    }
    return host_sim::load_log(folder / "out/traverse.rlog");
}

std::vector<std::string> files_in(const std::filesystem::path& folder, const std::string& ending) {
    std::vector<std::string> files;
    if (std::filesystem::is_directory(folder)) {
        for (const auto& entry : std::filesystem::directory_iterator(folder)) {
            if (entry.path().string().ends_with(ending)) files.push_back(entry.path().string());
        }
    }
    std::ranges::sort(files);
    return files;
}

TEST(RealLogs, OfAHuskyGiveOdometryAndAttitudeAndNothingElse) {
    const auto folder_of_data = system_test::study_data("borealtc-proprioception");
    const auto runs = files_in(folder_of_data, "_imu.csv");
    if (runs.empty()) GTEST_SKIP() << "no " << folder_of_data;
    for (const std::string& imu : runs) {
        SCOPED_TRACE(imu);
        const Folder folder;
        const std::string pro = imu.substr(0, imu.size() - 7) + "pro.csv";
        const host_sim::Log log = replayed(folder, {"borealtc", imu, pro});
        expect_nothing_invented(log, rover::kAvailableOdometry | rover::kAvailableAttitude);
        std::printf("%-24s %5zu steps, odometer %6.2f m\n",
                    std::filesystem::path(imu).filename().string().c_str(), log.steps.size(),
                    log.steps.back().estimates->odometer_q4_mm / 16000.0);
    }
}

TEST(RealLogs, OfAnOmniRobotGiveOdometryAlone) {
    const auto folder_of_data = system_test::study_data("omni-wheel-slip/runs");
    const auto runs = files_in(folder_of_data, ".csv");
    if (runs.empty()) GTEST_SKIP() << "no " << folder_of_data;
    for (std::size_t i = 0; i < runs.size(); i += 4) {
        SCOPED_TRACE(runs[i]);
        const Folder folder;
        const host_sim::Log log = replayed(folder, {"omni", runs[i]});
        expect_nothing_invented(log, rover::kAvailableOdometry);
        const double odometer_m = log.steps.back().estimates->odometer_q4_mm / 16000.0;
        double true_m = NAN;  // the camera's last sight
        for (const host_sim::LogStep& step : log.steps) {
            if (step.truth && !std::isnan(step.truth->position_mm)) {
                true_m = step.truth->position_mm / 1000;
            }
        }
        std::printf("%-24s odometer %5.2f m, camera %5.2f m: slip %3.0f %%\n",
                    std::filesystem::path(runs[i]).filename().string().c_str(), odometer_m, true_m,
                    100 * (1 - true_m / odometer_m));
        EXPECT_GT(odometer_m, 0.3);
    }
}

}  // namespace
