// stack_bound_test.cpp - stack and disabled interrupts of small programs, by hand.
#include "tools/bounds/stack_bound.hpp"

#include <gtest/gtest.h>

#include "tests/tools/bounds/sample_program.hpp"
#include "tools/budget/budget_error.hpp"

namespace {

using bounds_test::kMainIsEndless;
using bounds_test::Sample;
using bounds_test::small_rover;
using rover_bounds::StackBound;

StackBound bound_of(const std::string& work) {
    return stack_bound(small_rover(work).flow(kMainIsEndless));
}

// main: its return address 2, that of wait or work 2. TRAP 2. Tick: 2 + PUSH PSW 2. Receive: 2 + 2,
// and TRAP on it 2. Transmit: 2.
TEST(StackBound, HandlersNestAsTheyCan) {
    const StackBound bound = bound_of("RET\n");
    ASSERT_EQ(bound.parts.size(), 5U);
    EXPECT_EQ(bound.parts[0].enabled, 4U);
    EXPECT_EQ(bound.parts[1].disabled, 2U);  // TRAP
    EXPECT_EQ(bound.parts[2].enabled, 4U);   // tick
    EXPECT_EQ(bound.parts[3].disabled, 4U);  // receive
    EXPECT_EQ(bound.parts[3].enabled, 0U);
    EXPECT_EQ(bound.with_interrupts, 4U + 4 + 4 + 2);
}

// The deepest place has interrupts disabled: only TRAP comes. 4 + 6 + 2 = 12 there; where they are
// enabled 4 and all handlers.
TEST(StackBound, WhereInterruptsAreDisabledOnlyTrapComes) {
    const StackBound bound =
        bound_of(" DI\n PUSH B\n PUSH D\n PUSH H\n POP H\n POP D\n POP B\n EI\n RET\n");
    EXPECT_EQ(bound.parts[0].disabled, 10U);
    EXPECT_EQ(bound.parts[0].enabled, 4U);
    EXPECT_EQ(bound.with_interrupts, 14U);
}

TEST(StackBound, OfTwoWaysTheDeeperOneCounts) {
    const StackBound bound = bound_of(" JZ out\n PUSH B\n PUSH D\n POP D\n POP B\nout: RET\n");
    EXPECT_EQ(bound.parts[0].enabled, 8U);
}

std::string error_of(const std::string& work) {
    try {
        (void)bound_of(work);
    } catch (const rover_budget::BudgetError& error) {
        return error.what();
    }
    return "accepted";
}

TEST(StackBound, WhatCannotBeFollowedIsRefused) {
    EXPECT_NE(error_of("SPHL\n RET\n").find("it sets SP"), std::string::npos);
    EXPECT_NE(error_of("POP B\n RET\n").find("it pops what it has not pushed"), std::string::npos);
    EXPECT_NE(error_of("PUSH B\n RET\n").find("it returns with bytes pushed"), std::string::npos);
    EXPECT_NE(error_of("CALL work\n RET\n").find("the function calls itself"), std::string::npos);
}

// TRAP: 12 + JMP 10 + RET 10. Tick: 12 + JMP 10 + PUSH 12 + EI 4 + NOP 4. Receive: 12 + 10 + 12 +
// 10 + 4 + RET 10. Transmit: 12 + 10 + 4 + 10. wait: DI 4 + EI 4 + HLT 5.
TEST(DisabledStretches, FromTheAcceptanceOrDiToTheInstructionBehindEi) {
    const Sample sample = small_rover(" DI\n JZ out\n NOP\nout: EI\n RET\n");
    const auto program = sample.flow(kMainIsEndless);
    const auto found = disabled_stretches(program);
    std::vector<uint32_t> t;
    for (const auto& stretch : found) t.push_back(stretch.t);
    // work: DI 4, JZ not taken 7 and NOP 4, EI 4, RET 10. wait is no part of the graph of the
    // step's work, but of its time: DI counts there as well.
    EXPECT_EQ(t, (std::vector<uint32_t>{32, 42, 58, 36, 13, 29}));
}

TEST(DisabledStretches, ALoopOrAReturnWithInterruptsDisabledIsRefused) {
    const auto error = [](const std::string& work, const std::string& table) -> std::string {
        try {
            (void)disabled_stretches(small_rover(work).flow(kMainIsEndless + table));
        } catch (const rover_budget::BudgetError& refused) {
            return refused.what();
        }
        return "accepted";
    };
    EXPECT_NE(error(" DI\nloop: DCR B\n JNZ loop\n EI\n RET\n", "turns,x::work()#1 3,why\n")
                  .find("a loop runs with interrupts disabled"),
              std::string::npos);
    EXPECT_NE(error(" DI\n RET\n", "").find("it returns with interrupts disabled"),
              std::string::npos);
}

}  // namespace
