// drive_output_test.cpp - four files and the summary; a folder that cannot be is refused.
#include "tools/rover85/drive_output.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <stdexcept>

#include "host_sim/log/log_io.hpp"
#include "tests/tools/rover85/command_line.hpp"

namespace {

host_sim::Log two_steps() {
    host_sim::Log log;
    log.steps.resize(2);
    log.steps[1].time_ms = 100;
    return log;
}

TEST(DriveOutput, WritesFourFilesAndPrintsWhereTheReportIs) {
    const rover85_test::TestFolder folder("drive_output");
    const std::string out = folder.file("new/folder");
    const rover85_test::Capture text(std::cout);
    write_drive_output(two_steps(), {out, "Title", "rover85 test", std::nullopt});
    for (const char* file : {"report.html", "traverse.csv", "summary.json", "traverse.rlog"}) {
        EXPECT_TRUE(std::filesystem::exists(out + "/" + file)) << file;
    }
    EXPECT_EQ(host_sim::load_log(out + "/traverse.rlog").steps.size(), 2u);
    EXPECT_EQ(host_sim::load_log(out + "/traverse.csv").steps.size(), 2u);
    EXPECT_TRUE(text.text().ends_with("Report: " + out + "/report.html\n")) << text.text();
}

TEST(DriveOutput, KeepsWhatTheBoardCostAndForgetsItWithTheNextDrive) {
    const rover85_test::TestFolder folder("drive_output_machine");
    const std::string out = folder.file("out");
    const rover85_test::Capture text(std::cout);
    const report::Machine machine{"an image", {1, 2}, {3, 4}, {{"ROM", 1, 2, "bytes"}}};
    write_drive_output(two_steps(), {out, "Title", "", std::nullopt, machine});
    EXPECT_EQ(read_machine(out), machine);
    write_drive_output(two_steps(), {out, "Title", "", std::nullopt});
    EXPECT_EQ(read_machine(out), std::nullopt);
}

TEST(DriveOutput, AFileInThePlaceOfTheFolderIsNamed) {
    const rover85_test::TestFolder folder("drive_output_refused");
    std::ofstream(folder.file("taken")) << "in the way";
    try {
        write_drive_output(two_steps(), {folder.file("taken"), "Title", "", std::nullopt});
        FAIL() << "not refused";
    } catch (const std::runtime_error& error) {
        EXPECT_NE(std::string(error.what()).find(folder.file("taken")), std::string::npos);
        EXPECT_NE(std::string(error.what()).find("choose another --out"), std::string::npos);
    }
}

}  // namespace
