// loops_test.cpp - loops in loops, loops at the beginning, loops with two entries.
#include "tools/bounds/loops.hpp"

#include <gtest/gtest.h>

#include "tests/tools/bounds/sample_program.hpp"
#include "tools/budget/budget_error.hpp"

namespace {

using bounds_test::Sample;
using rover_bounds::Loop;

std::vector<Loop> loops_of(const Sample& sample) {
    return find_loops(read_code(sample.source(), {0}).at(0), sample.symbols);
}

TEST(Loops, AnInnerLoopIsEnteredFromTheOuterOne) {
    const Sample sample(
        "f: MVI B,2\nouter: MVI C,3\ninner: DCR C\n JNZ inner\n DCR B\n JNZ outer\n RET\n",
        {{"f", "f"}});
    const auto loops = loops_of(sample);
    ASSERT_EQ(loops.size(), 2U);
    EXPECT_EQ(loops[0].address, sample.at("outer"));
    EXPECT_EQ(loops[0].entries.size(), 1U);
    EXPECT_EQ(loops[0].turns.size(), 1U);
    EXPECT_EQ(loops[1].address, sample.at("inner"));
    EXPECT_EQ(loops[1].entries.size(), 1U);
    EXPECT_EQ(loops[1].turns.size(), 1U);
    EXPECT_GT(loops[0].blocks.size(), loops[1].blocks.size());
}

TEST(Loops, OneAtTheFirstInstructionIsEnteredWithTheFunction) {
    const auto loops = loops_of(Sample("f: DCR B\n JNZ f\n RET\n", {{"f", "f"}}));
    ASSERT_EQ(loops.size(), 1U);
    EXPECT_TRUE(loops[0].entered_with_procedure);
    EXPECT_TRUE(loops[0].entries.empty());
}

TEST(Loops, TwoLoopsBehindOneAnotherAreTwo) {
    EXPECT_EQ(
        loops_of(Sample("f: NOP\none: DCR B\n JNZ one\ntwo: DCR C\n JNZ two\n RET\n", {{"f", "f"}}))
            .size(),
        2U);
}

TEST(Loops, OneWithTwoEntriesIsRefusedWithItsLine) {
    const Sample sample("f: JZ middle\nloop: NOP\nmiddle: DCR B\n JNZ loop\n RET\n", {{"f", "f"}});
    try {
        (void)loops_of(sample);
        FAIL();
    } catch (const rover_budget::BudgetError& error) {
        EXPECT_STREQ(error.what(),
                     "a.cpp:1: the loop in f is entered at more than one place; write it as for, "
                     "while or do");
    }
}

}  // namespace
