#include "tools/rover85/calibrate_command.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "host_sim/calibration/calibration_file.hpp"
#include "host_sim/log/log_io.hpp"
#include "tests/host_sim/calibration/synthetic_swing.hpp"
#include "tests/tools/rover85/command_line.hpp"

namespace {

using host_sim::test::SwingTruth;
using host_sim::test::SyntheticSwing;
using rover85_test::Outcome;
using rover85_test::run_command;
using rover85_test::TestFolder;

/// Both bogies swung between +-30 deg, the differential absent, the inclinometer steady.
host_sim::Log swing_log() {
    const std::vector<host_sim::Reading> left =
        SyntheticSwing({.zero_q4_count = 33000, .gain_q16 = 16000, .seed = 5}).record();
    const std::vector<host_sim::Reading> right =
        SyntheticSwing({.zero_q4_count = 32000, .gain_q16 = 17000, .seed = 6}).record();
    host_sim::Log log;
    log.head.vehicle = "name = \"test\"\n";
    for (std::size_t i = 0; i < std::min(left.size(), right.size()); ++i) {
        host_sim::LogStep step;
        step.time_ms = left[i].time_ms;
        std::ranges::fill(step.inputs.adc_q4_count, hal::kAdcAbsent);
        step.inputs.adc_q4_count[0] = left[i].q4_count;
        step.inputs.adc_q4_count[1] = right[i].q4_count;
        step.inputs.adc_q4_count[3] = 32900;
        step.inputs.adc_q4_count[4] = 32600;
        log.steps.push_back(step);
    }
    return log;
}

TEST(CalibrateCommand, WritesTheRecordAndACopyOfTheLogWithIt) {
    const TestFolder folder("calibrate");
    host_sim::write_rlog(folder.file("swing.rlog"), swing_log());
    const Outcome outcome = run_command(
        add_calibrate_command,
        {"calibrate", folder.file("swing.rlog"), "-o", folder.file("c.toml"), "--apply",
         folder.file("applied.csv"), "--channel", "bogie_left", "--channel", "bogie_right",
         "--stop-deg", "30", "--level-from", "0", "--level-to", "8", "--flip", "bogie_right"});
    ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
    EXPECT_NE(outcome.out.find("bogie_left"), std::string::npos);
    const hal::Calibration record = host_sim::load_calibration(folder.file("c.toml"));
    EXPECT_NEAR(record.angle[0].zero_q4_count, 33000, 8);
    EXPECT_NEAR(record.angle[0].gain_q16, 16000, 10);
    EXPECT_NEAR(record.angle[1].zero_q4_count, 32000, 8);
    EXPECT_NEAR(record.angle[1].gain_q16, 17000, 10);
    EXPECT_TRUE(record.angle[1].inverted);
    EXPECT_EQ(record.angle[2].zero_q4_count, 32760);
    EXPECT_EQ(record.angle[3].zero_q4_count, 32900);
    EXPECT_EQ(record.angle[4].zero_q4_count, 32600);
    const host_sim::Log applied = host_sim::load_log(folder.file("applied.csv"));
    EXPECT_EQ(host_sim::encode_calibration(applied.head.calibration),
              host_sim::encode_calibration(record));
    EXPECT_EQ(applied.steps.size(), swing_log().steps.size());
    EXPECT_EQ(applied.head.vehicle, "name = \"test\"\n");
}

TEST(CalibrateCommand, WithoutOutputTheRecordGoesToStandardOutput) {
    const TestFolder folder("calibrate_stdout");
    host_sim::write_rlog(folder.file("swing.rlog"), swing_log());
    const Outcome outcome =
        run_command(add_calibrate_command, {"calibrate", folder.file("swing.rlog"), "--no-swing",
                                            "--level-from", "0", "--level-to", "8"});
    ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
    EXPECT_EQ(host_sim::parse_calibration(outcome.out, "stdout").angle[3].zero_q4_count, 32900);
}

TEST(CalibrateCommand, RefusesWithOneLineAndWritesNothing) {
    const TestFolder folder("calibrate_bad");
    host_sim::write_rlog(folder.file("swing.rlog"), swing_log());
    const auto refuse = [&](std::vector<std::string> more) {
        std::vector<std::string> arguments = {"calibrate", folder.file("swing.rlog"),
                                              "-o",        folder.file("c.toml"),
                                              "--apply",   folder.file("applied.rlog")};
        arguments.insert(arguments.end(), more.begin(), more.end());
        const Outcome outcome = run_command(add_calibrate_command, arguments);
        EXPECT_FALSE(std::filesystem::exists(folder.file("c.toml")));
        EXPECT_FALSE(std::filesystem::exists(folder.file("applied.rlog")));
        EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'),
                  outcome.exit_code == 3 ? 1 : 0);
        return outcome;
    };
    Outcome outcome = refuse({});
    EXPECT_EQ(outcome.exit_code, 3);
    EXPECT_NE(outcome.err.find("swing.rlog: differential: the sensor is absent"), std::string::npos)
        << outcome.err;
    EXPECT_EQ(refuse({"--channel", "bogie_left", "--visits", "6"}).exit_code, 3);
    EXPECT_EQ(refuse({"--channel", "bogie_left", "--stop-deg", "20"}).exit_code, 3);
}

TEST(CalibrateCommand, RefusesAFileThatIsNoLog) {
    const TestFolder folder("calibrate_missing");
    const Outcome outcome =
        run_command(add_calibrate_command, {"calibrate", folder.file("none.rlog")});
    EXPECT_EQ(outcome.exit_code, 3);
    EXPECT_NE(outcome.err.find("none.rlog"), std::string::npos) << outcome.err;
}

TEST(CalibrateCommand, UsageErrors) {
    const auto code = [](std::vector<std::string> arguments) {
        arguments.insert(arguments.begin(), {"calibrate", "x.rlog"});
        return run_command(add_calibrate_command, arguments).exit_code;
    };
    EXPECT_EQ(run_command(add_calibrate_command, {"calibrate"}).exit_code, 2);
    EXPECT_EQ(code({"--no-swing"}), 2);
    EXPECT_EQ(code({"--stop-deg", "50"}), 2);
    EXPECT_EQ(code({"--channel", "pitch"}), 2);
    EXPECT_EQ(code({"--level-from", "3"}), 2);
    EXPECT_EQ(code({"--turned-from", "3", "--turned-to", "9"}), 2);
    EXPECT_EQ(code({"--visits", "1"}), 2);
    EXPECT_EQ(code({"--apply", "x.txt"}), 2);
    EXPECT_EQ(code({"--flip", "mast"}), 2);
}

}  // namespace
