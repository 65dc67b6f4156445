// command_errors_test.cpp - a command's work becomes an exit code and at most one line.
#include "tools/rover85/command_errors.hpp"

#include <gtest/gtest.h>

#include <stdexcept>

#include "tests/tools/rover85/command_line.hpp"

namespace {

TEST(CommandErrors, AnExitCodePassesThroughInSilence) {
    const rover85_test::Capture err(std::cerr);
    for (const int code : {kExitPass, kExitDifference, kExitUsage, kExitBadInput}) {
        EXPECT_EQ(guarded([code] { return code; }), code);
    }
    EXPECT_EQ(err.text(), "");
}

TEST(CommandErrors, AnExceptionIsBadInputAndOneLine) {
    const rover85_test::Capture err(std::cerr);
    EXPECT_EQ(guarded([]() -> int { throw std::runtime_error("a.csv:3: no number; fix it"); }), 3);
    EXPECT_EQ(err.text(), "rover85: a.csv:3: no number; fix it\n");
}

}  // namespace
