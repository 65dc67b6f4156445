#include "tools/rover85/import_command.hpp"

#include <gtest/gtest.h>

#include <fstream>

#include "host_sim/import/borealtc.hpp"
#include "host_sim/import/omni_wheel_slip.hpp"
#include "host_sim/log/log_io.hpp"
#include "tests/tools/rover85/command_line.hpp"

namespace {

using rover85_test::Outcome;
using rover85_test::run_command;
using rover85_test::TestFolder;

void write_text(const std::string& path, const std::string& text) {
    std::ofstream(path, std::ios::binary) << text;
}

std::string imu_text() {
    std::string text = std::string(host_sim::kBorealtcImuHeader) + "\n";
    for (int row = 0; row <= 30; ++row) {
        text += std::to_string(row / 100.0) + ",0,0,0,0,0,9.81\n";
    }
    return text;
}

std::string pro_text() {
    return std::string(host_sim::kBorealtcProHeader) +
           "\n0,1,1,0.5,0.5\n0.154,1,1,0.5,0.5\n0.308,1,1,0.5,0.5\n";
}

TEST(ImportCommand, WritesAHuskyRunThatReadsBack) {
    const TestFolder folder("import_husky");
    write_text(folder.file("a_imu.csv"), imu_text());
    write_text(folder.file("a_pro.csv"), pro_text());
    for (const std::string name : {"a.rlog", "a.csv"}) {
        const Outcome outcome =
            run_command(add_import_command, {"import", "borealtc", folder.file("a_imu.csv"),
                                             folder.file("a_pro.csv"), "-o", folder.file(name)});
        EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
        EXPECT_NE(outcome.out.find("3 steps"), std::string::npos) << outcome.out;
        const host_sim::Log log = host_sim::load_log(folder.file(name));
        ASSERT_EQ(log.steps.size(), 3U);
        EXPECT_EQ(log.steps[2].inputs.tach_count[0], 289);  // 0.15 m / 0.51868 mm
        EXPECT_EQ(log.steps[2].inputs.adc_q4_count[3], 32768);
        EXPECT_EQ(log.steps[2].inputs.adc_q4_count[0], hal::kAdcAbsent);
        EXPECT_EQ(log.head.calibration.tach_q16_mm_per_count, 33992);
        EXPECT_EQ(log.head.notes.at("source"), "BorealTC, a_imu.csv and a_pro.csv");
    }
}

TEST(ImportCommand, WritesAnOmniRunWithTruthThatReadsBack) {
    const TestFolder folder("import_omni");
    std::string text = std::string(host_sim::kOmniHeader) + "\n";
    for (int row = 0; row <= 10; ++row) {  // 320 ticks a row and wheel, half a pixel a row
        text += std::to_string(row * 50) + ",0.1,0,0,0,0,0," + std::to_string(-320 * row) + ",0," +
                std::to_string(320 * row) + ",0,0,0,0,0,0,0,0,0,100," +
                std::to_string(500 - 0.5 * row) + ",0,0,0,0\n";
    }
    write_text(folder.file("run.csv"), text);
    const Outcome outcome =
        run_command(add_import_command,
                    {"import", "omni", folder.file("run.csv"), "-o", folder.file("o.rlog")});
    ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
    const host_sim::Log log = host_sim::load_log(folder.file("o.rlog"));
    ASSERT_EQ(log.steps.size(), 6U);
    EXPECT_EQ(log.steps[5].inputs.tach_count[0], 200);
    EXPECT_EQ(log.steps[5].inputs.tach_count[1], 200);
    ASSERT_TRUE(log.steps[5].truth.has_value());
    EXPECT_NEAR(log.steps[5].truth->position_mm, 5 * 1.8373, 1e-9);
}

TEST(ImportCommand, RefusesBadRecordingsWithOneLineAndWritesNothing) {
    const TestFolder folder("import_bad");
    write_text(folder.file("a_imu.csv"), imu_text() + "0.31,0,0\n");
    write_text(folder.file("a_pro.csv"), pro_text());
    Outcome outcome =
        run_command(add_import_command, {"import", "borealtc", folder.file("a_imu.csv"),
                                         folder.file("a_pro.csv"), "-o", folder.file("a.rlog")});
    EXPECT_EQ(outcome.exit_code, 3);
    EXPECT_TRUE(outcome.err.starts_with(folder.file("a_imu.csv") + ":33: ")) << outcome.err;
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1);
    EXPECT_FALSE(std::filesystem::exists(folder.file("a.rlog")));
    outcome = run_command(add_import_command,
                          {"import", "omni", folder.file("none.csv"), "-o", folder.file("a.rlog")});
    EXPECT_EQ(outcome.exit_code, 3);
    EXPECT_TRUE(outcome.err.starts_with(folder.file("none.csv"))) << outcome.err;
}

TEST(ImportCommand, UsageErrors) {
    EXPECT_EQ(run_command(add_import_command, {"import"}).exit_code, 2);
    EXPECT_EQ(run_command(add_import_command, {"import", "omni", "a.csv"}).exit_code, 2);
    EXPECT_EQ(run_command(add_import_command, {"import", "omni", "a.csv", "-o", "a.txt"}).exit_code,
              2);
    EXPECT_EQ(
        run_command(add_import_command, {"import", "borealtc", "a.csv", "-o", "a.csv"}).exit_code,
        2);
}

}  // namespace
