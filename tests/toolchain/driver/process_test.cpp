// Programs that are run: what they say and how they end.
#include "toolchain/driver/process.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cerrno>
#include <chrono>
#include <csignal>

#include "toolchain/driver/work_folder.hpp"

namespace {

using toolchain::driver::Command;
using toolchain::driver::Outcome;
using toolchain::driver::run_all;

class RunAll : public testing::Test {
protected:
    Command shell(const std::string& script) {
        return {{"sh", "-c", script}, folder_.path() / std::to_string(count_++)};
    }
    Outcome run(const std::string& script) {
        const std::vector<Command> commands = {shell(script)};
        return run_all(commands, 1).at(0);
    }

private:
    toolchain::driver::WorkFolder folder_;
    int count_ = 0;
};

TEST_F(RunAll, KeepsBothOutputsAndTheExitCode) {
    const Outcome outcome = run("echo one; echo two >&2; exit 3");
    EXPECT_EQ(outcome.messages, "one\ntwo\n");
    EXPECT_EQ(outcome.exit_code, 3);
    EXPECT_FALSE(outcome.ok());
    EXPECT_TRUE(run("true").ok());
}

TEST_F(RunAll, GivesAnEmptyInput) {
    EXPECT_EQ(run("cat; echo end").messages, "end\n");
}

TEST_F(RunAll, TellsASignalFromAnExitCode) {
    const Outcome outcome = run("kill -SEGV $$");
    EXPECT_EQ(outcome.signal, SIGSEGV);
    EXPECT_FALSE(outcome.ok());
}

TEST_F(RunAll, TellsThatAProgramIsMissing) {
    const std::vector<Command> commands = {{{"no-such-program-here"}, "/dev/null"}};
    const Outcome outcome = run_all(commands, 1).at(0);
    EXPECT_EQ(outcome.start_error, ENOENT);
    EXPECT_FALSE(outcome.ok());
}

TEST_F(RunAll, PassesArgumentsAsTheyAre) {
    Command command = shell("");
    command.arguments = {"printf", "%s|", "a b", "$HOME", "'", ""};
    const std::vector<Command> commands = {command};
    EXPECT_EQ(run_all(commands, 1).at(0).messages, "a b|$HOME|'||");
}

TEST_F(RunAll, GivesOutcomesInTheOrderOfTheCommands) {
    const std::vector<Command> commands = {shell("sleep 0.2; echo first"), shell("echo second"),
                                           shell("echo third")};
    const auto outcomes = run_all(commands, 2);
    ASSERT_EQ(outcomes.size(), 3U);
    EXPECT_EQ(outcomes[0].messages, "first\n");
    EXPECT_EQ(outcomes[1].messages, "second\n");
    EXPECT_EQ(outcomes[2].messages, "third\n");
}

// Each of the two waits for the other one's file, so one after the other would never end.
TEST_F(RunAll, RunsSeveralAtATime) {
    const toolchain::driver::WorkFolder meeting;
    const auto meet = [&](const std::string& mine, const std::string& other) {
        return shell("cd " + meeting.path().string() + "; touch " + mine +
                     "; for i in $(seq 400); do test -e " + other +
                     " && exit 0; sleep 0.05; done; exit 1");
    };
    const std::vector<Command> commands = {meet("a", "b"), meet("b", "a")};
    for (const Outcome& outcome : run_all(commands, 2)) EXPECT_TRUE(outcome.ok());
}

}  // namespace
