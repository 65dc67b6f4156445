#include "tests/toolchain/csmith/process.hpp"

#include <gtest/gtest.h>

#include <csignal>
#include <fstream>
#include <stdexcept>

namespace csmith_test {
namespace {

using End = Ran::End;

TEST(RunProgram, GivesStatusAndBothOutputs) {
    const Ran good = run_program({"sh", "-c", "echo out; echo err >&2"}, 5);
    EXPECT_EQ(good.end, End::finished);
    EXPECT_EQ(good.text, "out\nerr\n");
    const Ran bad = run_program({"sh", "-c", "exit 3"}, 5);
    EXPECT_EQ(bad.end, End::failed);
    EXPECT_EQ(bad.status, 3);
}

TEST(RunProgram, OfNoProgramIsStatus127) {
    const Ran ran = run_program({"no-such-program-in-the-path"}, 5);
    EXPECT_EQ(ran.end, End::failed);
    EXPECT_EQ(ran.status, 127);
}

TEST(RunProgram, RunsInTheFolder) {
    const WorkFolder folder;
    std::ofstream(folder.path() / "here") << "yes";
    EXPECT_EQ(run_program({"cat", "here"}, 5, folder.path()).text, "yes");
}

TEST(RunProgram, EndsAnEndlessLoop) {
    const Ran ran = run_program({"sh", "-c", "while :; do :; done"}, 1);
    EXPECT_EQ(ran.end, End::out_of_time);
}

TEST(RunApart, KeepsWhatWasSaidBeforeACrash) {
    const Ran ran = run_apart(
        [](const Say& say) {
            say("half");
            std::raise(SIGILL);
            say("way");
        },
        5);
    EXPECT_EQ(ran.end, End::crashed);
    EXPECT_EQ(ran.status, SIGILL);
    EXPECT_EQ(ran.text, "half");
}

TEST(RunApart, GivesTheTextOfAnException) {
    const Ran ran = run_apart([](const Say&) { throw std::runtime_error("why"); }, 5);
    EXPECT_EQ(ran.end, End::failed);
    EXPECT_EQ(ran.text, "why");
}

TEST(RunApart, LeavesThisProcessAlone) {
    int changed = 0;
    const Ran ran = run_apart([&](const Say&) { changed = 1; }, 5);
    EXPECT_EQ(ran.end, End::finished);
    EXPECT_EQ(changed, 0);
}

TEST(WorkFolder, GoesAwayWithItsObject) {
    std::filesystem::path path;
    {
        const WorkFolder folder;
        path = folder.path();
        std::ofstream(path / "file") << "x";
        EXPECT_TRUE(std::filesystem::exists(path / "file"));
    }
    EXPECT_FALSE(std::filesystem::exists(path));
}

}  // namespace
}  // namespace csmith_test
