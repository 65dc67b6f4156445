// alarm_sweep_test.cpp - counting of false alarms and delays by hand; what the alarms promise.
#include "host_sim/campaign/alarm_sweep.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <sstream>

#include "host_sim/bind/slip_estimators.hpp"

namespace {

using namespace host_sim;

TEST(CountFalseAlarms, CountsRisesAboveTheThreshold) {
    const std::vector<double> level = {0, 2, 2, 1, 2, 0, 3};
    EXPECT_EQ(count_false_alarms(level, {}, 1), 3u);
    EXPECT_EQ(count_false_alarms(level, {}, 2), 1u);
    EXPECT_EQ(count_false_alarms(level, {}, 3), 0u);
}

TEST(CountFalseAlarms, ATrueLevelExcusesTheAlarmForFiveCycles) {
    std::vector<double> truth(20, 0.0);
    truth[3] = 5;
    for (std::size_t rise = 0; rise < 20; ++rise) {
        std::vector<double> level(20, 0.0);
        level[rise] = 2;
        const bool excused = rise >= 3 && rise < 3 + kLagCycles;
        EXPECT_EQ(count_false_alarms(level, truth, 1), excused ? 0u : 1u) << rise;
    }
}

TEST(Detect, CountsCyclesFromTheOnsetOn) {
    std::vector<double> level(100, 0.0);
    level[13] = 2;
    EXPECT_EQ(detect(level, 10, 1).cycles, 4u);
    EXPECT_EQ(detect(level, 13, 1).cycles, 1u);
    EXPECT_EQ(detect(level, 14, 1).kind, DetectionKind::up_before);
    EXPECT_EQ(detect(level, 15, 1).kind, DetectionKind::missed);
    level[60] = 2;
    EXPECT_EQ(detect(level, 61 - kWatchedCycles, 1).cycles, kWatchedCycles);
    EXPECT_EQ(detect(level, 60 - kWatchedCycles, 1).kind, DetectionKind::missed);
}

TEST(SummarizeDetections, MissedRunsCountAsEndless) {
    std::vector<Detection> seen;
    for (std::size_t i = 1; i <= 8; ++i) seen.push_back({DetectionKind::detected, 9 - i});
    seen.push_back({DetectionKind::missed, 0});
    seen.push_back({DetectionKind::missed, 0});
    seen.push_back({DetectionKind::up_before, 0});
    const DetectionSummary summary = summarize_detections(seen);
    EXPECT_EQ(summary.runs, 10u);
    EXPECT_EQ(summary.median, 5u);
    EXPECT_FALSE(summary.percent90.has_value());
    EXPECT_DOUBLE_EQ(summary.missed_share, 0.2);
}

/// The thresholds were chosen on seeds 1 to 400 and 700000 to 700039; these are others.
const SweepAlarmResult& measured() {
    static const SweepAlarmResult result =
        sweep_alarm({.seeds = 40, .seed_base = 900000, .threads = 1}, make_slip_estimator);
    return result;
}

const AlarmCurve& curve_of(AlarmLevel level) {
    return measured().curves.at(static_cast<std::size_t>(level));
}

TEST(SlipAlarm, IsFalseLessThanOncePer100Metres) {
    for (const double rate : curve_of(AlarmLevel::slip_alarm).false_per_100_m.at(0)) {
        EXPECT_LT(rate, 1);
    }
}

TEST(SlipAlarm, IsUpWithin8CyclesIn90PercentOfOnsets) {
    for (const AlarmCurve::Case& one : curve_of(AlarmLevel::slip_alarm).cases) {
        for (const DetectionSummary& row : one.rows.at(0)) {
            ASSERT_TRUE(row.percent90.has_value()) << one.name;
            EXPECT_LE(*row.percent90, 8u) << one.name;
        }
    }
}

// At roughness 0.08 ground that gives way by 2 to 3 cm is common, and errors are 0.7 cm.
TEST(SinkageAlarm, At3CentimetresIsFalseLessThanOncePer100MetresUpToRoughness0p04ElseTwice) {
    const AlarmCurve& curve = curve_of(AlarmLevel::sinkage_cm);
    ASSERT_EQ(curve.thresholds.at(5), 3);
    for (std::size_t i = 0; i < kSweepRoughness.size(); ++i) {
        EXPECT_LT(curve.false_per_100_m.at(5)[i], kSweepRoughness[i] <= 0.04 ? 1 : 2);
    }
}

TEST(SinkageAlarm, At3CentimetresSees4And6CentimetresWithin8Cycles) {
    const AlarmCurve& curve = curve_of(AlarmLevel::sinkage_cm);
    for (const std::size_t step : {1u, 2u}) {
        for (const DetectionSummary& row : curve.cases.at(step).rows.at(5)) {
            ASSERT_TRUE(row.percent90.has_value());
            EXPECT_LE(*row.percent90, 8u) << curve.cases.at(step).name;
        }
    }
}

TEST(SweepAlarm, ResultDoesNotDependOnTheNumberOfThreads) {
    SweepAlarmOptions options{.seeds = 3, .seed_base = 5, .threads = 1};
    const std::string one = sweep_alarm_json(options, sweep_alarm(options, make_slip_estimator));
    options.threads = 3;
    EXPECT_EQ(sweep_alarm_json(options, sweep_alarm(options, make_slip_estimator)), one);
}

TEST(RunSweepAlarm, PrintsTablesOrTheSameAsJson) {
    SweepAlarmOptions options{.terrain = TerrainKind::fractal, .seeds = 1, .threads = 1};
    std::ostringstream out;
    std::ostringstream err;
    EXPECT_EQ(run_sweep_alarm(options, make_slip_estimator, out, err), 0);
    for (const char* word : {"fractal", "match_cost", "wheels spin", "sinkage grows by 4 cm"}) {
        EXPECT_NE(out.str().find(word), std::string::npos) << word;
    }
    options.json_path = "-";
    std::ostringstream json;
    EXPECT_EQ(run_sweep_alarm(options, make_slip_estimator, json, err), 0);
    const auto document = nlohmann::json::parse(json.str());
    EXPECT_EQ(document["false_alarms"].size(), 6u * (10 + 12 + 1 + 9));
    EXPECT_EQ(document["detections"].size(), 6u * (2 * (10 + 12 + 1) + 3 * 9));
    EXPECT_EQ(err.str(), "");
}

TEST(RunSweepAlarm, RefusesNoSeedsWithCode2) {
    std::ostringstream out;
    std::ostringstream err;
    EXPECT_EQ(run_sweep_alarm({.seeds = 0}, make_slip_estimator, out, err), 2);
    EXPECT_NE(err.str().find("seeds"), std::string::npos);
    EXPECT_EQ(out.str(), "");
}

}  // namespace
