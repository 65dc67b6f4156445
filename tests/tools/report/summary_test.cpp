#include "tools/report/summary.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>
#include <sstream>

namespace {

using host_sim::Log;
using host_sim::LogStep;
using report::Summary;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// Four steps whose every figure can be worked out with a pencil; the sums stand beside the tests.
Log tiny_log() {
    Log log;
    log.head.vehicle = "# a rover\nname = \"Rocky 3.2\"\nmass_kg = 15\n";
    log.head.image_identity = "0.1.0-abc";
    log.head.notes["seed"] = "7";
    log.steps.resize(4);
    const double position_mm[] = {0, 1000, 2000, 4000};
    const double firmware_mm[] = {0, 1020, 2050, 4080};
    const double odometer_mm[] = {0, 1250, 2500, 5000};
    const double sigma_mm[] = {0, 10, 50, 100};
    const double sinkage_mm[] = {0, 4, 8, 12};
    const double true_sinkage_mm[] = {kNan, 5, 8, 14};
    const int slip_percent[] = {0, 10, 20, 30};
    const double true_slip[] = {kNan, 0.10, 0.25, 0.30};
    const unsigned cycles[] = {65534, 65535, 1, 3};
    const rover::SlipMode modes[] = {rover::SlipMode::odometry_only, rover::SlipMode::tracking,
                                     rover::SlipMode::tracking, rover::SlipMode::reacquiring};
    for (std::size_t row = 0; row < 4; ++row) {
        LogStep& step = log.steps[row];
        step.time_ms = static_cast<std::uint32_t>(1000 + 100 * row);
        step.inputs.tach_present = 0x3F;
        step.inputs.range_present = row == 2 ? 0 : 1;
        step.inputs.adc_q4_count[4] = hal::kAdcAbsent;  // roll
        host_sim::Truth& truth = step.truth.emplace();
        truth.position_mm = position_mm[row];
        truth.sinkage_mm = true_sinkage_mm[row];
        truth.slip = true_slip[row];
        rover::Estimates& e = step.estimates.emplace();
        e.position_q4_mm = static_cast<std::int32_t>(16 * firmware_mm[row]);
        e.odometer_q4_mm = static_cast<std::int32_t>(16 * odometer_mm[row]);
        e.position_sigma_q4_mm = static_cast<std::uint16_t>(16 * sigma_mm[row]);
        e.sinkage_q4_mm = static_cast<std::int16_t>(16 * sinkage_mm[row]);
        e.slip_percent = static_cast<std::int8_t>(slip_percent[row]);
        e.cycle_count = static_cast<std::uint16_t>(cycles[row]);
        e.mode = modes[row];
        e.available = rover::kAvailableOdometry;
        if (row != 0) e.available |= rover::kAvailableSlip | rover::kAvailableSinkage;
    }
    log.steps[1].estimates->events = rover::kEventSlipAlarm | rover::kEventOverspeed;
    log.steps[2].estimates->events = rover::kEventLostLock | rover::kEventTickGap;
    log.steps[3].estimates->events = rover::kEventSlipAlarm | rover::kEventTickGap;
    for (std::size_t row = 1; row < 4; ++row) log.steps[row].estimates->faults = rover::kFaultRoll;
    return log;
}

std::string all_of(const Summary& summary) {
    std::string text;
    for (const std::string& sentence : report::sentences(summary)) text += sentence + "\n";
    return text;
}

TEST(Summarize, DistancesAndSlip) {
    const Summary summary = report::summarize(tiny_log());
    EXPECT_EQ(summary.step_count, 4u);
    EXPECT_DOUBLE_EQ(summary.duration_s, 0.3);
    EXPECT_DOUBLE_EQ(summary.true_distance_m.value(), 4.0);
    EXPECT_DOUBLE_EQ(summary.firmware_distance_m.value(), 4.08);
    EXPECT_DOUBLE_EQ(summary.wheel_distance_m.value(), 5.0);
    EXPECT_NEAR(summary.slip_overall_percent.value(), 20.0, 1e-9);  // 1 - 4/5
}

TEST(Summarize, PositionErrors) {
    const Summary summary = report::summarize(tiny_log());
    EXPECT_NEAR(summary.firmware_error_m.value(), 0.08, 1e-12);
    EXPECT_NEAR(summary.wheel_error_m.value(), 1.0, 1e-12);
    EXPECT_NEAR(summary.firmware_error_percent.value(), 2.0, 1e-9);  // 0.08/4
    EXPECT_NEAR(summary.wheel_error_percent.value(), 25.0, 1e-9);    // 1/4
    EXPECT_DOUBLE_EQ(summary.position_sigma_m.value(), 0.1);
    // |20| > 10, |50| <= 50, |80| <= 100
    EXPECT_NEAR(summary.within_sigma_share.value(), 2.0 / 3.0, 1e-12);
}

TEST(Summarize, SinkageAndSlipOnlyWhereAvailable) {
    const Summary summary = report::summarize(tiny_log());
    EXPECT_DOUBLE_EQ(summary.sinkage_mm.estimated_mean.value(), 8.0);  // (4 + 8 + 12)/3
    EXPECT_DOUBLE_EQ(summary.sinkage_mm.estimated_greatest.value(), 12.0);
    EXPECT_DOUBLE_EQ(summary.sinkage_mm.true_mean.value(), 9.0);  // (5 + 8 + 14)/3
    EXPECT_DOUBLE_EQ(summary.sinkage_mm.true_greatest.value(), 14.0);
    EXPECT_NEAR(summary.sinkage_mm.rms_error.value(), std::sqrt(5.0 / 3.0), 1e-12);  // 1, 0, 2
    EXPECT_DOUBLE_EQ(summary.slip_percent.estimated_mean.value(), 20.0);
    EXPECT_NEAR(summary.slip_percent.true_mean.value(), 65.0 / 3.0, 1e-9);
    EXPECT_NEAR(summary.slip_percent.rms_error.value(), std::sqrt(25.0 / 3.0), 1e-9);  // 0, 5, 0
}

TEST(Summarize, AlarmsCountRisesAndSayWhereTheFirstWas) {
    const Summary summary = report::summarize(tiny_log());
    EXPECT_EQ(summary.slip_alarm.count, 2u);
    EXPECT_DOUBLE_EQ(summary.slip_alarm.raised_share, 0.5);
    EXPECT_DOUBLE_EQ(summary.slip_alarm.first_time_s.value(), 1.1);
    EXPECT_DOUBLE_EQ(summary.slip_alarm.first_place_m.value(), 1.0);
    EXPECT_EQ(summary.sinkage_alarm.count, 0u);
    EXPECT_FALSE(summary.sinkage_alarm.first_time_s.has_value());
}

TEST(Summarize, CountsEventsModesFaultsAndCyclesAcrossTheWrap) {
    const Summary summary = report::summarize(tiny_log());
    EXPECT_EQ(summary.cycle_count, 5u);  // 1 + 2 + 2
    EXPECT_EQ(summary.lost_lock_count, 1u);
    EXPECT_EQ(summary.tick_gap_count, 2u);
    EXPECT_EQ(summary.overspeed_count, 1u);
    EXPECT_THAT(summary.fault_steps, ElementsAre(testing::Pair("roll", 3u)));
    EXPECT_DOUBLE_EQ(summary.mode_share.at("tracking"), 0.5);
    EXPECT_DOUBLE_EQ(summary.mode_share.at("reacquiring"), 0.25);
    EXPECT_DOUBLE_EQ(summary.mode_share.at("moved"), 0.0);
    EXPECT_DOUBLE_EQ(summary.available_share.at("slip"), 0.75);
}

TEST(Summarize, SaysWhatIsMissing) {
    const Summary summary = report::summarize(tiny_log());
    EXPECT_THAT(summary.sensors_missing, ElementsAre("roll inclinometer"));
    EXPECT_THAT(summary.sensors_intermittent, ElementsAre("range module"));
    EXPECT_THAT(summary.not_available,
                ElementsAre("pitch and roll", "wheel heights from the suspension",
                            "ground ahead of the wheels"));
    EXPECT_EQ(summary.vehicle, "Rocky 3.2");
    EXPECT_EQ(summary.image_identity, "0.1.0-abc");
    EXPECT_EQ(summary.notes.at("seed"), "7");
}

TEST(Summarize, WithoutTruthNoErrorIsGiven) {
    Log log = tiny_log();
    for (LogStep& step : log.steps) step.truth.reset();
    const Summary summary = report::summarize(log);
    EXPECT_FALSE(summary.has_truth);
    EXPECT_FALSE(summary.true_distance_m || summary.firmware_error_m ||
                 summary.wheel_error_percent || summary.within_sigma_share ||
                 summary.slip_overall_percent || summary.sinkage_mm.true_mean ||
                 summary.sinkage_mm.rms_error);
    EXPECT_DOUBLE_EQ(summary.firmware_distance_m.value(), 4.08);
    EXPECT_DOUBLE_EQ(summary.sinkage_mm.estimated_mean.value(), 8.0);
}

TEST(Summarize, WithoutEstimatesTheWheelsComeFromTheTachometers) {
    Log log = tiny_log();
    log.head.calibration.tach_q16_mm_per_count = 65535;
    for (std::size_t row = 0; row < 4; ++row) {
        log.steps[row].estimates.reset();
        for (auto& count : log.steps[row].inputs.tach_count) {
            count = static_cast<std::uint16_t>(1000 * row);
        }
    }
    const Summary summary = report::summarize(log);
    EXPECT_FALSE(summary.has_estimates);
    EXPECT_NEAR(summary.wheel_distance_m.value(), 3.0, 1e-4);  // 3000 pulses of 65535/65536 mm
    EXPECT_FALSE(summary.firmware_distance_m || summary.firmware_error_m ||
                 summary.sinkage_mm.estimated_mean);
    EXPECT_TRUE(summary.mode_share.empty());
    EXPECT_TRUE(summary.not_available.empty());
}

TEST(Summarize, NotANumberPositionsAreSkipped) {
    Log log = tiny_log();
    log.steps[0].truth->position_mm = kNan;
    log.steps[3].truth->position_mm = kNan;
    const Summary summary = report::summarize(log);
    EXPECT_DOUBLE_EQ(summary.true_distance_m.value(), 1.0);
    EXPECT_NEAR(summary.firmware_error_m.value(), 0.03, 1e-12);  // (2050 - 1020) - 1000 mm
}

TEST(Summarize, AnyShortLogIsAccepted) {
    EXPECT_EQ(report::summarize(Log{}).step_count, 0u);
    Log log = tiny_log();
    log.steps.resize(1);
    const Summary summary = report::summarize(log);
    EXPECT_FALSE(summary.has_truth);
    EXPECT_FALSE(summary.true_distance_m || summary.wheel_distance_m || summary.firmware_error_m);
    EXPECT_FALSE(all_of(summary).empty());
}

TEST(Sentences, SayTheHeadlineFigures) {
    const std::string text = all_of(report::summarize(tiny_log()));
    EXPECT_THAT(text,
                HasSubstr("The rover drove 4.00 m in 0.3 s; its wheels turned 5.00 m, so 20 % "
                          "of the wheel travel was slip."));
    EXPECT_THAT(text,
                HasSubstr("the firmware's position is off by 2.0 % (8 cm too far); plain wheel "
                          "odometry is off by 25 %."));
    EXPECT_THAT(text, HasSubstr("Sinkage is estimated at 8.0 mm on average and 12 mm at most; the "
                                "truth is 9.0 mm and 14 mm (RMS error 1.3 mm)."));
    EXPECT_THAT(text, HasSubstr("The slip alarm went up twice, first at 1.00 m (after 1.1 s);"));
    EXPECT_THAT(text, HasSubstr("The sinkage alarm never went up."));
    EXPECT_THAT(text, HasSubstr("loss of lock once"));
    EXPECT_THAT(text, HasSubstr("Sensors missing throughout: roll inclinometer."));
}

TEST(Sentences, InventNothingWithoutTruth) {
    Log log = tiny_log();
    for (LogStep& step : log.steps) step.truth.reset();
    const std::string text = all_of(report::summarize(log));
    EXPECT_THAT(text, HasSubstr("no true position, so no error can be given"));
    EXPECT_THAT(text,
                HasSubstr("By the firmware's slip-corrected position the rover drove 4.08 m."));
    EXPECT_THAT(text, Not(HasSubstr("off by")));
    EXPECT_THAT(text, Not(HasSubstr("truth is")));
}

TEST(Sentences, InventNothingWithoutAController) {
    Log log = tiny_log();
    for (LogStep& step : log.steps) step.estimates.reset();
    const std::string text = all_of(report::summarize(log));
    EXPECT_THAT(text, HasSubstr("No controller has run on this log"));
    EXPECT_THAT(text, HasSubstr("True sinkage is 9.0 mm on average and 14 mm at most."));
    EXPECT_THAT(text, Not(HasSubstr("alarm")));
    EXPECT_THAT(text, Not(HasSubstr("not available")));
}

TEST(Sentences, OdometryOnlyIsCalledThat) {
    Log log = tiny_log();
    for (LogStep& step : log.steps) {
        step.estimates->available = rover::kAvailableOdometry;
        step.estimates->position_q4_mm = step.estimates->odometer_q4_mm;
        step.estimates->events = 0;
    }
    const std::string text = all_of(report::summarize(log));
    EXPECT_THAT(text, HasSubstr("its position is plain wheel odometry"));
    EXPECT_THAT(text, HasSubstr("At the end it is off by 25 %."));
    EXPECT_THAT(text, HasSubstr("Estimates not available on this vehicle: pitch and roll, "));
    EXPECT_THAT(text, Not(HasSubstr("Sinkage is estimated")));
    EXPECT_THAT(text, Not(HasSubstr("alarm")));
}

TEST(Sentences, TurningOnTheSpotExplainsWheelsThatWentNowhere) {
    Log log = tiny_log();
    for (LogStep& step : log.steps) step.truth.reset();
    EXPECT_THAT(all_of(report::summarize(log)), Not(HasSubstr("turned on the spot")));
    log.steps[3].estimates->mode = rover::SlipMode::turning;
    const std::string text = all_of(report::summarize(log));
    EXPECT_THAT(text, HasSubstr("The wheels turned 5.00 m forward in"));
    EXPECT_THAT(text, HasSubstr("For 25 % of the time the vehicle turned on the spot."));
}

TEST(Texts, NumbersReadWell) {
    EXPECT_EQ(report::text_of_percent(-0.166), "0.17 %");
    EXPECT_EQ(report::text_of_percent(2.26), "2.3 %");
    EXPECT_EQ(report::text_of_percent(9.96), "10 %");
    EXPECT_EQ(report::text_of_percent(0), "0 %");
    EXPECT_EQ(report::text_of_percent(0.001), "less than 0.01 %");
    EXPECT_EQ(report::text_of_distance(62.46), "62.5 m");
    EXPECT_EQ(report::text_of_distance(9.996), "10.0 m");
    EXPECT_EQ(report::text_of_distance(-0.123), "12 cm");
    EXPECT_EQ(report::text_of_distance(0.003), "3 mm");
    EXPECT_EQ(report::text_of_duration(12.51), "12.5 s");
    EXPECT_EQ(report::text_of_duration(59.99), "1 min");
    EXPECT_EQ(report::text_of_duration(750), "12 min 30 s");
    EXPECT_EQ(report::text_of_duration(7500), "2 h 5 min");
    EXPECT_EQ(report::text_of_count(0), "0");
    EXPECT_EQ(report::text_of_count(999), "999");
    EXPECT_EQ(report::text_of_count(1234567), "1,234,567");
}

TEST(SummaryJson, CarriesFiguresAndNullsForTheUnknown) {
    Log log = tiny_log();
    auto json = nlohmann::json::parse(report::summary_json(report::summarize(log)));
    EXPECT_EQ(json["steps"], 4);
    EXPECT_DOUBLE_EQ(json["distance_m"]["true"].get<double>(), 4.0);
    EXPECT_NEAR(json["position_error"]["firmware_percent"].get<double>(), 2.0, 1e-9);
    EXPECT_EQ(json["alarms"]["slip"]["count"], 2);
    EXPECT_EQ(json["events"]["cycles"], 5);
    EXPECT_EQ(json["sensors"]["missing"][0], "roll inclinometer");
    EXPECT_EQ(json["notes"]["seed"], "7");
    for (LogStep& step : log.steps) {
        step.truth.reset();
        step.estimates.reset();
    }
    json = nlohmann::json::parse(report::summary_json(report::summarize(log)));
    EXPECT_TRUE(json["distance_m"]["true"].is_null());
    EXPECT_TRUE(json["position_error"]["firmware_percent"].is_null());
    EXPECT_TRUE(json["alarms"].is_null());
}

TEST(SummaryJson, HostileBytesStayValidJson) {
    Log log = tiny_log();
    log.head.notes["bad"] = "\xff\xfe\"\\</script>";
    EXPECT_TRUE(nlohmann::json::accept(report::summary_json(report::summarize(log))));
}

TEST(WriteSummaryJson, ReplacesTheFileAsAWhole) {
    const auto file = std::filesystem::path(testing::TempDir()) / "rover85_summary_test.json";
    std::ofstream(file) << "old";
    report::write_summary_json(report::summarize(tiny_log()), file);
    std::stringstream text;
    text << std::ifstream(file).rdbuf();
    EXPECT_TRUE(nlohmann::json::accept(text.str()));
    EXPECT_FALSE(std::filesystem::exists(file.string() + ".part"));
    std::filesystem::remove(file);
}

TEST(WriteSummaryJson, SaysWhichFileAndWhatToDo) {
    try {
        report::write_summary_json(Summary{}, "/nonexistent-folder/summary.json");
        FAIL() << "no error";
    } catch (const std::runtime_error& error) {
        EXPECT_THAT(error.what(), HasSubstr("/nonexistent-folder/summary.json: cannot write: "));
        EXPECT_THAT(error.what(), HasSubstr("Check that the folder exists"));
    }
}

}  // namespace
