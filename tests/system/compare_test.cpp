// compare_test.cpp - `rover85 compare`, and --target board, as a user runs them.
// Needs   the image beside the program.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "host_sim/log/log_io.hpp"
#include "tests/system/golden_courses.hpp"
#include "tests/system/program.hpp"

namespace {

using system_test::Folder;
using system_test::Outcome;
using system_test::rover85;

const std::string kImage = ROVER_IMAGE;

std::string golden(std::size_t index) {
    return system_test::golden_file(system_test::kGoldenCourses[index]).string();
}

TEST(CompareCommand, AnIdenticalLogIsExitCode0AndSaysHowMuchWasCompared) {
    const Outcome run = rover85({"compare", golden(4), "--image", kImage});
    EXPECT_EQ(run.exit_code, 0) << run.err;
    EXPECT_EQ(run.err, "");
    const std::size_t steps = host_sim::load_log(golden(4)).steps.size();
    EXPECT_NE(run.out.find("Identical: 1 log, " + std::to_string(steps) + " steps, " +
                           std::to_string(steps) + " telemetry frames, " +
                           std::to_string(50 * steps) + " bytes"),
              std::string::npos)
        << run.out;
    EXPECT_NE(run.out.find(" host\n"), std::string::npos) << run.out;
    EXPECT_NE(run.out.find(" board\n"), std::string::npos) << run.out;
}

TEST(CompareCommand, RandomLogsAreMadeFromTheirSeeds) {
    const Outcome run =
        rover85({"compare", "--random", "2", "--seed", "7", "--steps", "20", "--image", kImage});
    EXPECT_EQ(run.exit_code, 0) << run.err;
    EXPECT_EQ(run.out.find("Seeds 7 to 8.\nIdentical: 2 logs, 40 steps, 40 telemetry frames"), 0u)
        << run.out;
}

TEST(CompareCommand, WrongUseIsExitCode2AndBadInput3) {
    EXPECT_EQ(rover85({"compare"}).exit_code, 2);
    EXPECT_EQ(rover85({"compare", golden(0), "--random", "1"}).exit_code, 2);
    EXPECT_EQ(rover85({"compare", golden(0), "--seed", "1"}).exit_code, 2);
    const Outcome missing = rover85({"compare", "nowhere.rlog", "--image", kImage});
    EXPECT_EQ(missing.exit_code, 3);
    EXPECT_NE(missing.err.find("nowhere.rlog"), std::string::npos);
    const Outcome no_image = rover85({"compare", golden(0), "--image", "nowhere.hex"});
    EXPECT_EQ(no_image.exit_code, 3);
    EXPECT_NE(no_image.err.find("nowhere.hex: there is no such image"), std::string::npos);
}

// The symbols of the image beside a program that is none: it does not boot.
TEST(CompareCommand, ABoardThatDoesNotAnswerIsExitCode1WithTimeAndPlace) {
    const Folder folder;
    std::string symbols = kImage;
    symbols.replace(symbols.size() - 4, 4, ".sym");
    system_test::write_bytes(folder / "dead.sym", system_test::read_bytes(symbols));
    system_test::write_bytes(folder / "dead.hex",
                             ":03000000C30000"
                             "3A\n:00000001FF\n");  // JMP 0
    const Outcome run = rover85({"compare", golden(0), "--image", folder / "dead.hex"});
    EXPECT_EQ(run.exit_code, 1) << run.out;
    EXPECT_NE(run.err.find("dead.hex: "), std::string::npos) << run.err;
    EXPECT_NE(run.err.find("PC 0000H"), std::string::npos) << run.err;
    EXPECT_EQ(std::count(run.err.begin(), run.err.end(), '\n'), 1) << run.err;
}

TEST(TargetBoard, ReplayWritesTheSameTraverseOnBothTargets) {
    const Folder folder;
    for (const char* target : {"host", "board"}) {
        const Outcome run = rover85({"replay", golden(8), "--target", target, "--hold", "--image",
                                     kImage, "--out", folder / target});
        ASSERT_EQ(run.exit_code, 0) << run.err;
    }
    const auto host = host_sim::load_log(folder / "host/traverse.rlog");
    const auto board = host_sim::load_log(folder / "board/traverse.rlog");
    EXPECT_EQ(system_test::first_difference(host, board), "");
    EXPECT_TRUE(board.head.image_identity.ends_with(" board"));
}

TEST(TargetBoard, ASimulatedDriveWithAResetGoesOnFromItsCheckpoint) {
    const Folder folder;
    const Outcome run = rover85({"simulate", "--length", "0.2", "--ramp", "0", "--reset-at", "9.95",
                                 "--target", "board", "--image", kImage, "--out", folder / "out"});
    ASSERT_EQ(run.exit_code, 0) << run.err;
    const host_sim::Log log = host_sim::load_log(folder / "out/traverse.rlog");
    ASSERT_GT(log.steps.size(), 110u);
    const host_sim::LogStep& before = log.steps[99];
    const host_sim::LogStep& after = log.steps[100];
    EXPECT_EQ(after.restart, host_sim::Restart::warm);
    EXPECT_EQ(after.inputs.tick_count, 0);
    EXPECT_EQ(after.inputs.tach_count[0], 0);
    EXPECT_EQ(after.estimates->step_count, 0);
    EXPECT_EQ(log.steps[101].inputs.tick_count, 10);
    EXPECT_GT(before.estimates->odometer_q4_mm, 1000);
    EXPECT_EQ(after.estimates->odometer_q4_mm, before.estimates->odometer_q4_mm);
    const Outcome compared = rover85({"compare", folder / "out/traverse.rlog", "--image", kImage});
    EXPECT_EQ(compared.exit_code, 0) << compared.out << compared.err;
}

}  // namespace
