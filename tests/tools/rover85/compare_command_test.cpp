// compare_command_test.cpp - what `compare` refuses. What it compares:
// tests/system/compare_test.cpp.
#include "tools/rover85/compare_command.hpp"

#include <gtest/gtest.h>

#include "tests/tools/rover85/command_line.hpp"

namespace {

rover85_test::Outcome compare(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), "compare");
    return rover85_test::run_command(add_compare_command, std::move(arguments));
}

TEST(CompareArguments, ALogOrRandomLogsAndNotBoth) {
    EXPECT_EQ(compare({}).exit_code, 2);
    EXPECT_EQ(compare({"a.rlog", "--random", "3"}).exit_code, 2);
    EXPECT_EQ(compare({"a.rlog", "--steps", "3"}).exit_code, 2);
    EXPECT_EQ(compare({"--random", "0"}).exit_code, 2);
    EXPECT_EQ(compare({"--random", "2", "--seed", "-1"}).exit_code, 2);
}

TEST(CompareArguments, AnImageThatIsNotThereIsBadInput) {
    const auto run = compare({"a.rlog", "--image", "nowhere.hex"});
    EXPECT_EQ(run.exit_code, 3);
    EXPECT_NE(run.err.find("nowhere.hex: there is no such image; "), std::string::npos) << run.err;
}

}  // namespace
