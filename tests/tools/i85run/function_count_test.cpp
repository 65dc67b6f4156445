// function_count_test.cpp - T-states of calls, by hand from the table of the 8085's instructions.
#include "tools/i85run/function_count.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <initializer_list>

#include "tools/i85run/machine.hpp"

namespace {

using i85run::FunctionCount;
using i85run::Machine;
using i85run::Stop;

class I85runFunctionCount : public testing::Test {
protected:
    void load(uint16_t address, std::initializer_list<uint8_t> bytes) {
        std::ranges::copy(bytes, machine_.memory.bytes.begin() + address);
    }

    FunctionCount run(uint16_t function) {
        FunctionCount count(function);
        host_sim::StepRecord record;
        Stop stop = Stop::time_limit;
        while (stop == Stop::time_limit && machine_.cpu.t < 10'000) {
            stop = machine_.step(record);
            count.observe(record);
        }
        EXPECT_EQ(stop, Stop::halted);
        return count;
    }

    Machine machine_;
};

TEST_F(I85runFunctionCount, FromTheFirstInstructionToTheEndOfRet) {
    load(0x0000, {0xCD, 0x00, 0x01, 0xCD, 0x00, 0x01, 0x76});  // CALL 0100h twice; HLT
    load(0x0100, {0x00, 0xC9});                                // NOP (4); RET (10)
    const FunctionCount count = run(0x0100);
    EXPECT_EQ(count.calls(), 2u);
    EXPECT_EQ(count.t_states(), 28u);
    EXPECT_EQ(count.worst_t_states(), 14u);
    EXPECT_EQ(count.mean_t_states(), 14.0);
    EXPECT_FALSE(count.active());
}

TEST_F(I85runFunctionCount, CalleesCountButTheirReturnsDoNotEndTheCall) {
    load(0x0000, {0xCD, 0x00, 0x01, 0x76});
    load(0x0100, {0xCD, 0x00, 0x02, 0x00, 0xC9});  // CALL (18); NOP (4); RET (10)
    load(0x0200, {0xC9});                          // RET (10)
    EXPECT_EQ(run(0x0100).t_states(), 42u);
}

TEST_F(I85runFunctionCount, ConditionalReturnsCountWhenTaken) {
    load(0x0000, {0xAF, 0xCD, 0x00, 0x01, 0x76});  // XRA A: zero flag; CALL; HLT
    load(0x0100, {0xC0, 0xC8});                    // RNZ not taken (6); RZ taken (12)
    const FunctionCount count = run(0x0100);
    EXPECT_EQ(count.calls(), 1u);
    EXPECT_EQ(count.t_states(), 18u);
}

TEST_F(I85runFunctionCount, WorstAndMeanDiffer) {
    load(0x0000, {0xAF, 0xCD, 0x00, 0x01, 0x3C, 0xCD, 0x00, 0x01, 0x76});  // zero, then INR A
    load(0x0100, {0xC8, 0x00, 0xC9});  // RZ: 12; else 6, NOP 4, RET 10: 20
    const FunctionCount count = run(0x0100);
    EXPECT_EQ(count.calls(), 2u);
    EXPECT_EQ(count.worst_t_states(), 20u);
    EXPECT_EQ(count.mean_t_states(), 16.0);
}

TEST_F(I85runFunctionCount, ATailJumpCountsToTheOthersReturn) {
    load(0x0000, {0xCD, 0x00, 0x01, 0x76});
    load(0x0100, {0xC3, 0x00, 0x02});  // JMP (10)
    load(0x0200, {0x00, 0xC9});        // NOP (4); RET (10)
    EXPECT_EQ(run(0x0100).t_states(), 24u);
    EXPECT_EQ(run(0x0200).calls(), 0u) << "the machine has halted: nothing more happens";
}

TEST_F(I85runFunctionCount, AJumpTargetReachedByJumpIsACall) {
    load(0x0000, {0xCD, 0x00, 0x01, 0x76});
    load(0x0100, {0xC3, 0x00, 0x02});
    load(0x0200, {0x00, 0xC9});
    EXPECT_EQ(run(0x0200).t_states(), 14u);
}

TEST_F(I85runFunctionCount, ALoopToTheFirstInstructionIsOneCall) {
    load(0x0000, {0x06, 0x03, 0xCD, 0x00, 0x01, 0x76});  // MVI B,3; CALL; HLT
    load(0x0100, {0x05, 0xC2, 0x00, 0x01, 0xC9});        // DCR B (4); JNZ (10, last 7); RET (10)
    const FunctionCount count = run(0x0100);
    EXPECT_EQ(count.calls(), 1u);
    EXPECT_EQ(count.t_states(), 3u * 4 + 2 * 10 + 7 + 10);
}

TEST_F(I85runFunctionCount, RecursionIsPartOfTheOutermostCall) {
    load(0x0000, {0x06, 0x02, 0xCD, 0x00, 0x01, 0x76});
    // DCR B (4); CNZ self (18 taken, 9 not); RET (10): 4 + 18 + (4 + 9 + 10) + 10
    load(0x0100, {0x05, 0xC4, 0x00, 0x01, 0xC9});
    const FunctionCount count = run(0x0100);
    EXPECT_EQ(count.calls(), 1u);
    EXPECT_EQ(count.t_states(), 55u);
}

TEST_F(I85runFunctionCount, ReturnByPchlEndsTheCall) {
    load(0x0000, {0xCD, 0x00, 0x01, 0x76});
    load(0x0100, {0xE1, 0x00, 0xE9});  // POP H (10); NOP (4); PCHL (6)
    const FunctionCount count = run(0x0100);
    EXPECT_EQ(count.calls(), 1u);
    EXPECT_EQ(count.t_states(), 20u);
}

TEST_F(I85runFunctionCount, TheStackMayWrapAroundTheEndOfMemory) {
    machine_.cpu.sp = 0x0000;  // the return address is at FFFEh; behind RET, SP is 0000h
    load(0x0000, {0xCD, 0x00, 0x01, 0x76});
    load(0x0100, {0xC9});
    EXPECT_EQ(run(0x0100).t_states(), 10u);
}

TEST_F(I85runFunctionCount, ACallThatDoesNotReturnIsNotCounted) {
    load(0x0000, {0xCD, 0x00, 0x01});
    load(0x0100, {0x76});
    const FunctionCount count = run(0x0100);
    EXPECT_EQ(count.calls(), 0u);
    EXPECT_EQ(count.t_states(), 0u);
    EXPECT_EQ(count.mean_t_states(), 0.0);
    EXPECT_TRUE(count.active());
}

}  // namespace
