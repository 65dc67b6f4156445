// run_metrics_test.cpp - the definitions, on runs small enough to check by hand.
#include "host_sim/campaign/run_metrics.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace {

using host_sim::CycleOutcome;
using host_sim::RunMetrics;
using host_sim::RunResult;
using host_sim::summarize;

TEST(RunMetrics, OdometryErrorIsThatOfTheEndRelativeToTheTruth) {
    RunMetrics metrics(2.5);
    metrics.add({.true_cm = 5, .estimate_cm = 9});
    metrics.add({.true_cm = 10, .estimate_cm = 10.5});
    EXPECT_DOUBLE_EQ(metrics.result({}).odometry_error_pct, 5.0);
    EXPECT_EQ(metrics.result({}).cycles, 2u);
}

TEST(RunMetrics, SinkageErrorsAreMeanSquares) {
    RunMetrics metrics(2.5);
    metrics.add({.true_cm = 5, .estimate_cm = 5, .true_sinkage_cm = 1, .sinkage_cm = 3});
    metrics.add({.true_cm = 10, .estimate_cm = 10, .true_sinkage_cm = 3, .sinkage_cm = 3});
    EXPECT_DOUBLE_EQ(metrics.result({}).sinkage_square_cm2, 2.0);  // (4 + 0) / 2
    EXPECT_DOUBLE_EQ(metrics.result({}).zero_square_cm2, 5.0);     // (1 + 9) / 2
}

TEST(RunMetrics, CoverageComparesTheFinalErrorWithTheReportedSigma) {
    RunMetrics metrics(2.5);
    metrics.add({.true_cm = 100, .estimate_cm = 98});
    EXPECT_EQ(metrics.result({}).covered, std::nullopt);
    EXPECT_EQ(metrics.result(2.0).covered, true);
    EXPECT_EQ(metrics.result(1.9).covered, false);
}

TEST(RunMetrics, NoCyclesGiveNoError) {
    const RunResult result = RunMetrics(2.5).result(1.0);
    EXPECT_EQ(result.odometry_error_pct, 0);
    EXPECT_EQ(result.covered, std::nullopt);
}

// Cycles of 5 cm: the ground under the rear wheel was under the front wheel 10 cycles ago. The
// estimate gains `gain_cm` in each of the cycles [first, first + count).
bool loses_lock(int first, int count, double gain_cm) {
    RunMetrics metrics(2.5);
    double estimate_cm = 0;
    for (int cycle = 0; cycle < 200; ++cycle) {
        estimate_cm += 5;
        if (cycle >= first && cycle < first + count) estimate_cm += gain_cm;
        metrics.add({.true_cm = 5.0 * (cycle + 1), .estimate_cm = estimate_cm});
    }
    return metrics.result({}).lost_lock;
}

TEST(RunMetrics, SlowDriftIsNoLossOfLock) {
    // 0.2 cm a cycle is 2 cm over the vehicle's length, however far it adds up.
    EXPECT_FALSE(loses_lock(0, 200, 0.2));
    EXPECT_FALSE(loses_lock(0, 200, -0.2));
}

TEST(RunMetrics, MoreThanOneBinOverTheVehicleIn20CyclesInARowIsLossOfLock) {
    EXPECT_TRUE(loses_lock(20, 100, 0.3));
    EXPECT_TRUE(loses_lock(20, 100, -0.3));
    // A single jump of 4 cm is over after the 10 cycles that it takes to drive past it.
    EXPECT_FALSE(loses_lock(50, 1, 4));
    // 3 cm lie within the window from 9 cycles of 0.3 on: 19 cycles long for 17 such cycles ...
    EXPECT_FALSE(loses_lock(50, 19 - 10 + 2 * 8, 0.3));
    // ... and 20 for one more.
    EXPECT_TRUE(loses_lock(50, 20 - 10 + 2 * 8 + 1, 0.3));
}

TEST(Summarize, AveragesAsTheNamesSay) {
    const std::vector<RunResult> runs = {
        {.odometry_error_pct = -1, .sinkage_square_cm2 = 1, .zero_square_cm2 = 4, .covered = true},
        {.odometry_error_pct = 2, .sinkage_square_cm2 = 7, .zero_square_cm2 = 4, .lost_lock = true},
        {.odometry_error_pct = 5, .sinkage_square_cm2 = 4, .zero_square_cm2 = 4, .covered = false}};
    const host_sim::Summary summary = summarize(runs);
    EXPECT_EQ(summary.runs, 3u);
    EXPECT_DOUBLE_EQ(summary.mean_pct, 2.0);
    EXPECT_DOUBLE_EQ(summary.mean_abs_pct, 8.0 / 3);
    EXPECT_DOUBLE_EQ(summary.sd_pct, 3.0);  // (9 + 0 + 9) / 2 = 9
    EXPECT_DOUBLE_EQ(summary.worst_abs_pct, 5.0);
    EXPECT_DOUBLE_EQ(summary.sinkage_rms_cm, 2.0);
    EXPECT_DOUBLE_EQ(summary.sinkage_zero_rms_cm, 2.0);
    EXPECT_EQ(summary.lost_lock_runs, 1u);
    EXPECT_EQ(summary.sigma_coverage, 0.5);  // of the two runs that reported one
}

TEST(Summarize, OneRunHasNoSpreadAndNoRunsAreAllZero) {
    const std::vector<RunResult> one = {{.odometry_error_pct = -3}};
    EXPECT_EQ(summarize(one).sd_pct, 0);
    EXPECT_EQ(summarize(one).sigma_coverage, std::nullopt);
    EXPECT_EQ(summarize({}).runs, 0u);
    EXPECT_EQ(summarize({}).mean_pct, 0);
}

}  // namespace
