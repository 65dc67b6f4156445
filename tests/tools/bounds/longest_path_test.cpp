// longest_path_test.cpp - longest paths against sums by hand.
#include "tools/bounds/longest_path.hpp"

#include <gtest/gtest.h>

#include "tests/tools/bounds/sample_program.hpp"
#include "tools/budget/budget_error.hpp"

namespace {

using bounds_test::kLoopWork;
using bounds_test::kLoopWorkT;
using bounds_test::kMainIsEndless;
using bounds_test::Sample;
using bounds_test::small_rover;
using rover_bounds::longest_path;
using rover_bounds::longest_step;

constexpr uint64_t kStepT = 18 + 18 + 10;  // two calls and a jump; waiting does not count

TEST(LongestPath, ALoopRunsAsOftenAsItsBoundSays) {
    Sample sample = small_rover(kLoopWork);
    sample.note("loop", "loop 3");
    const auto program = sample.flow(kMainIsEndless);
    const auto path = longest_path(program, sample.at("work"));
    ASSERT_TRUE(path);
    EXPECT_EQ(path->t, kLoopWorkT);
    EXPECT_EQ(longest_step(program).t, kStepT + kLoopWorkT);
}

TEST(LongestPath, OfABranchTheLongerWayCounts) {
    // ORA 4, JZ 7 or 10, NOP 4 on the way that is not taken, RET 10
    const Sample sample = small_rover(" ORA A\n JZ out\n NOP\nout: RET\n");
    EXPECT_EQ(longest_path(sample.flow(kMainIsEndless), sample.at("work"))->t, 4U + 7 + 4 + 10);
}

TEST(LongestPath, NestedLoopsMultiply) {
    Sample sample = small_rover(
        " MVI B,2\nouter: MVI C,3\ninner: DCR C\n JNZ inner\n DCR B\n JNZ outer\n RET\n");
    sample.note("outer", "loop 2").note("inner", "loop 3");
    // inner: 3 * 4 + 2 * 10 + 7 = 39; outer: 2 * (7 + 39 + 4) + 10 + 7
    EXPECT_EQ(longest_path(sample.flow(kMainIsEndless), sample.at("work"))->t,
              7U + 2 * (7 + 39 + 4) + 10 + 7 + 10);
}

TEST(LongestPath, WhatNeverEndsHasNone) {
    const Sample sample = small_rover("RET\n");
    EXPECT_FALSE(longest_path(sample.flow(kMainIsEndless), sample.at("main")));
}

/// A step of two calls of a function with a loop. Of `work`: 18 + 18 + 10, twice MVI 7 and RET 10,
/// and turns_t() for the turns of both calls.
Sample two_calls() {
    Sample sample(
        "reset: JMP main\nmain: CALL wait\n CALL work\n JMP main\nwait: RET\n"
        "work: CALL part\n CALL part\n RET\npart: MVI B,9\nloop: DCR B\n JNZ loop\n RET\n",
        {{"reset", "__reset"},
         {"main", "main"},
         {"wait", "x::rover_wait()"},
         {"work", "x::work()"},
         {"part", "x::part()"}});
    sample.note("loop", "loop 9");
    return sample;
}
constexpr uint64_t kTwoCallsT = 2 * 18 + 10 + 2 * (7 + 10);
/// DCR 4 and JNZ 10 a turn, but 7 in the last one.
constexpr uint64_t turns_t(uint64_t turns) {
    return 14 * turns - 3;
}

TEST(LongestPath, AFactLimitsTheSumOverAllCalls) {
    const Sample sample = two_calls();
    EXPECT_EQ(longest_path(sample.flow(kMainIsEndless), sample.at("work"))->t,
              kTwoCallsT + 2 * turns_t(9));
    const auto limited = sample.flow(kMainIsEndless + "fact,x::part()#1 <= 11,why\n");
    EXPECT_EQ(longest_path(limited, sample.at("work"))->t, kTwoCallsT + turns_t(9) + turns_t(2));
}

TEST(LongestPath, AFactThatContradictsTheCodeIsRefused) {
    const Sample sample = two_calls();
    const auto program = sample.flow(kMainIsEndless + "fact,x::part() <= 1,it is called twice\n");
    try {
        (void)longest_path(program, sample.at("work"));
        FAIL();
    } catch (const rover_budget::BudgetError& error) {
        EXPECT_STREQ(error.what(),
                     "flow.csv: no way through x::work() agrees with all its facts; correct the "
                     "fact that contradicts the code");
    }
    EXPECT_THROW((void)longest_step(program), rover_budget::BudgetError);
}

TEST(LongestPath, BelowAFunctionOfAFactTheFactSaysNothing) {
    const Sample sample = two_calls();
    const auto program =
        sample.flow(kMainIsEndless + "fact,x::part()#1 <= 5 x::work(),five for each\n");
    EXPECT_EQ(longest_path(program, sample.at("part"))->t, 17 + turns_t(9));
    EXPECT_EQ(longest_path(program, sample.at("work"))->t, kTwoCallsT + turns_t(4) + turns_t(1));
}

TEST(LongestPath, StatedTimesCountForEachCall) {
    Sample sample = two_calls();
    sample.note("part", "t 50 to 70");
    const auto path = longest_path(sample.flow(kMainIsEndless), sample.at("work"));
    EXPECT_EQ(path->t, 18U + 70 + 18 + 70 + 10);
    EXPECT_EQ(path->by.at(sample.at("part")).calls, 2);
}

}  // namespace
