// monitor_test.cpp - `rover85 monitor` and `rover85 board` as a user runs them: the flying image on
// a live board, its telemetry shown and recorded, ends by time, signal and kill.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <signal.h>

#include <algorithm>
#include <thread>

#include "host_sim/log/log_io.hpp"
#include "tests/system/program.hpp"

namespace {

using host_sim::Log;
using system_test::Folder;
using system_test::Outcome;
using system_test::Process;
using system_test::read_bytes;
using system_test::rover85;
using system_test::write_bytes;
using testing::HasSubstr;
using testing::StartsWith;

const std::string kImage = ROVER_IMAGE;

// The same course: what came over the link, live, is what the simulation has in its log.
TEST(Monitor, ABoardThatDrivesLiveSaysWhatItSaysInSimulate) {
    const Folder folder;
    const std::vector<std::string> course = {"--seed", "5", "--ramp", "0", "--length", "0.5"};
    std::vector<std::string> live = {"monitor", "--board",  "--seconds",
                                     "6.5",     "--record", folder / "live.rlog"};
    std::vector<std::string> fast = {"simulate",     "--target", "board",
                                     "--no-profile", "--out",    folder / "fast"};
    live.insert(live.end(), course.begin(), course.end());
    fast.insert(fast.end(), course.begin(), course.end());
    const Outcome run = rover85(live);
    ASSERT_EQ(run.exit_code, 0) << run.err;
    ASSERT_EQ(rover85(fast).exit_code, 0);
    EXPECT_THAT(run.out, StartsWith("step 0 0.0 s: position 0.000 m"));
    EXPECT_THAT(run.out, HasSubstr("\nidentity: rover85 "));
    EXPECT_THAT(run.out, HasSubstr("restart frame, cold start; faults: no checkpoint;"));
    EXPECT_THAT(run.out, HasSubstr(" 0 steps missing, 0 frames refused, 0 stray bytes, "));
    Log log = host_sim::load_log(folder / "live.rlog");
    Log expected = host_sim::load_log(folder / "fast/traverse.rlog");
    ASSERT_GE(log.steps.size(), 40u);
    ASSERT_GE(expected.steps.size(), log.steps.size());
    expected.steps.resize(log.steps.size());
    for (Log* each : {&log, &expected}) {
        for (host_sim::LogStep& step : each->steps) {
            step.inputs = {};
            step.commands.reset();
        }
    }
    EXPECT_EQ(system_test::first_difference(log, expected), "");
    EXPECT_GT(log.steps.back().estimates->odometer_q4_mm, 16 * 30);
}

TEST(Monitor, TheCourseEndsIt) {
    const Outcome run = rover85({"monitor", "--board", "--ramp", "0", "--length", "0.1",
                                 "--advance", "constant", "--mean", "6"});
    EXPECT_EQ(run.exit_code, 0) << run.err;
    EXPECT_THAT(run.out, testing::EndsWith("The course is over.\n"));
}

/// A board with the image, its link a name in the test's folder.
class MonitorAtBoard : public testing::Test {
protected:
    void SetUp() override { ASSERT_TRUE(board.says("Ctrl-C ends it\n")); }

    Folder folder;
    Process board{{"board", kImage, "--link", folder / "link", "--eeprom", folder / "eeprom.bin"}};
};

TEST_F(MonitorAtBoard, CtrlCEndsBothWithASummaryAndExitCode0) {
    {
        Process monitor({"monitor", "--port", folder / "link", "--wait", "10", "--record",
                         folder / "drive.csv"});
        ASSERT_TRUE(monitor.says("step 12 "));
        monitor.signal(SIGINT);
        const Outcome run = monitor.wait();
        EXPECT_EQ(run.exit_code, 0) << run.err;
        EXPECT_THAT(run.out, HasSubstr(" telemetry frames, 0 steps missing, 0 frames refused, 0 "));
        EXPECT_THAT(run.out, HasSubstr("recorded: "));
        const Log log = host_sim::load_log(folder / "drive.csv");
        EXPECT_FALSE(log.unverified);
        EXPECT_GE(log.steps.size(), 10u);
        EXPECT_THAT(log.head.image_identity, StartsWith("rover85 "));
    }
    EXPECT_TRUE(std::filesystem::is_symlink(folder / "link"));
    board.signal(SIGTERM);
    const Outcome run = board.wait();
    EXPECT_EQ(run.exit_code, 0) << run.err;
    EXPECT_THAT(run.out, HasSubstr(", 1 resets, 0 violations; "));
    EXPECT_FALSE(std::filesystem::exists(std::filesystem::symlink_status(folder / "link")));
    EXPECT_EQ(read_bytes(folder / "eeprom.bin").size(), 32768u);
}

TEST_F(MonitorAtBoard, AKilledRecordingReadsAndAnotherMonitorCanFollow) {
    for (const std::string name : {"killed.rlog", "killed.csv"}) {
        Process monitor(
            {"monitor", "--port", folder / "link", "--wait", "10", "--record", folder / name});
        ASSERT_TRUE(monitor.says("status: "));
        ASSERT_TRUE(monitor.says("step 4"));
        monitor.signal(SIGKILL);
        EXPECT_EQ(monitor.wait().exit_code, -1);
        EXPECT_GE(host_sim::load_log(folder / name).steps.size(), 1u) << name;
    }
    const Outcome recovered =
        rover85({"recover", folder / "killed.rlog", "-o", folder / "whole.rlog"});
    EXPECT_EQ(recovered.exit_code, 0) << recovered.err;
    EXPECT_THAT(recovered.out, HasSubstr(" 0 bytes dropped"));
    std::filesystem::create_directories(folder / "drive");
    std::filesystem::copy_file(folder / "killed.rlog", folder / "drive/traverse.rlog");
    EXPECT_EQ(rover85({"report", folder / "drive"}).exit_code, 0);
    EXPECT_EQ(rover85({"replay", folder / "killed.csv", "--out", folder / "again"}).exit_code, 0);
}

TEST_F(MonitorAtBoard, ASecondMonitorIsRefused) {
    Process first({"monitor", "--port", folder / "link", "--wait", "10"});
    ASSERT_TRUE(first.says("step "));
    const Outcome second = rover85({"monitor", "--port", folder / "link"});
    EXPECT_EQ(second.exit_code, 3);
    EXPECT_THAT(second.err, HasSubstr("is in use by another program; "));
    first.signal(SIGHUP);
    EXPECT_EQ(first.wait().exit_code, 0);
}

TEST_F(MonitorAtBoard, ABoardThatGoesAwayEndsTheMonitorWithItsReason) {
    Process monitor({"monitor", "--port", folder / "link", "--wait", "10"});
    ASSERT_TRUE(monitor.says("step "));
    board.signal(SIGINT);
    EXPECT_EQ(board.wait().exit_code, 0);
    const Outcome run = monitor.wait();
    EXPECT_EQ(run.exit_code, 3);
    EXPECT_THAT(run.err, HasSubstr("/link: is gone: unplugged, or the simulated board has ended"));
    EXPECT_THAT(run.out, HasSubstr(" telemetry frames, "));
}

// The file wins over the image; a byte of it is the proof.
TEST(BoardCommand, TheEepromComesFromItsFileWhenThereIsOne) {
    const Folder folder;
    const std::string file = folder / "eeprom.bin";
    const Outcome first = rover85({"board", kImage, "--eeprom", file, "--seconds", "0.2"});
    EXPECT_EQ(first.exit_code, 0) << first.err;
    std::string content = read_bytes(file);
    ASSERT_EQ(content.size(), 32768u);
    content[0] = '\x76';  // HLT: nothing is sent
    write_bytes(file, content);
    const Outcome again = rover85({"board", "--eeprom", file, "--seconds", "1.5"});
    EXPECT_EQ(again.exit_code, 0) << again.err;
    EXPECT_THAT(again.out, StartsWith("board with " + file + ", serial port /dev/pts/"));
    EXPECT_THAT(again.out, HasSubstr(" 0 characters received, 0 sent, "));
    EXPECT_EQ(read_bytes(file), content);
}

void expect_refused(const Outcome& run, int exit_code, const std::string& word) {
    EXPECT_EQ(run.exit_code, exit_code) << run.out << run.err;
    EXPECT_EQ(run.out, "");
    EXPECT_EQ(std::ranges::count(run.err, '\n'), 1) << run.err;
    EXPECT_THAT(run.err, HasSubstr(word));
}

TEST(BoardCommand, WhatCannotBeUsedIsRefused) {
    const Folder folder;
    expect_refused(rover85({"board"}), 3, "nothing to run; name an image");
    expect_refused(rover85({"board", "--eeprom", folder / "none.bin"}), 3,
                   "does not exist yet; name an image to begin with");
    expect_refused(rover85({"board", folder / "none.hex"}), 3, "none.hex");
    write_bytes(folder / "short.bin", "1234");
    expect_refused(rover85({"board", "--eeprom", folder / "short.bin"}), 3,
                   "has 4 bytes, the EEPROM 32768; ");
    expect_refused(rover85({"board", kImage, "--link", folder / "short.bin"}), 3,
                   "cannot be made (File exists); choose another --link");
}

TEST(Monitor, WhatCannotBeUsedIsRefused) {
    const Folder folder;
    expect_refused(rover85({"monitor"}), 2, "Give --port PATH or --board");
    expect_refused(rover85({"monitor", "--port", "x", "--seed", "3"}), 2, "--seed needs --board");
    expect_refused(rover85({"monitor", "--port", "/dev/ttyNone7"}), 3,
                   "/dev/ttyNone7: cannot be opened: No such file");
    expect_refused(rover85({"monitor", "--board", "--image", "none.hex"}), 3,
                   "there is no such image");
    expect_refused(rover85({"monitor", "--board", "--record", folder / "no/such/a.rlog"}), 3,
                   "cannot be written");
    expect_refused(rover85({"monitor", "--board", "--terrain", "moon"}), 3, "--terrain moon");
    EXPECT_EQ(rover85({"monitor", "--board", "--record", "a.txt"}).exit_code, 2);
    EXPECT_EQ(rover85({"monitor", "--board", "--port", "x"}).exit_code, 2);
}

// HLT at address 0 with interrupts disabled: nothing is ever sent.
TEST(Monitor, WithoutTelemetryItSaysWhatToCheck) {
    const Folder folder;
    std::string blank(32768, '\x00');
    blank[0] = '\x76';
    write_bytes(folder / "eeprom.bin", blank);
    const Process board({"board", "--eeprom", folder / "eeprom.bin", "--link", folder / "link"});
    ASSERT_TRUE(board.says("Ctrl-C ends it\n"));
    expect_refused(rover85({"monitor", "--port", folder / "link", "--wait", "0.5"}), 3,
                   "no telemetry within 0.5 s, not a single byte; check that the rover has power");
}

}  // namespace
