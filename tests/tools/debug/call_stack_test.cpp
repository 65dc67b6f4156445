// call_stack_test.cpp - the shadow stack on hand-made steps.
#include "tools/debug/call_stack.hpp"

#include <gtest/gtest.h>

namespace debug_console {
namespace {

using host_sim::BoardState;
using host_sim::StepRecord;
using toolchain::isa::Flow;

StepRecord step(uint8_t opcode, uint16_t pc, uint16_t sp, uint16_t next_pc, uint16_t next_sp) {
    StepRecord record;
    record.pc = pc;
    record.sp = sp;
    record.next_pc = next_pc;
    record.next_sp = next_sp;
    record.access_count = 1;
    record.accesses[0].value = opcode;
    return record;
}

TEST(CallStack, CallsAndReturnsPair) {
    CallStack calls;
    calls.follow(step(0xCD, 0x100, 0, 0x200, 0xFFFE));       // CALL with SP at 0: it wraps
    calls.follow(step(0xC5, 0x200, 0xFFFE, 0x201, 0xFFFC));  // PUSH B
    calls.follow(step(0xC7 | 1 << 3, 0x201, 0xFFFC, 0x0008, 0xFFFA));  // RST 1
    ASSERT_EQ(calls.frames().size(), 2u);
    EXPECT_EQ(calls.frames()[0], (Frame{Frame::Kind::call, false, 0x100, 0x200, 0xFFFE, 0x103}));
    EXPECT_EQ(calls.frames()[1],
              (Frame{Frame::Kind::restart, false, 0x201, 0x0008, 0xFFFA, 0x202}));
    calls.follow(step(0xC9, 0x0008, 0xFFFA, 0x202, 0xFFFC));  // RET
    EXPECT_EQ(calls.frames().size(), 1u);
    calls.follow(step(0xC1, 0x202, 0xFFFC, 0x203, 0xFFFE));  // POP B
    EXPECT_EQ(calls.frames().size(), 1u) << "the return address is still there";
    calls.follow(step(0xC9, 0x203, 0xFFFE, 0x103, 0));
    EXPECT_TRUE(calls.frames().empty());
}

TEST(CallStack, InterruptsAreFramesAndPushesAreNot) {
    CallStack calls;
    StepRecord taken = step(0, 0x150, 0x9000, 0x3C, 0x8FFE);
    taken.kind = StepRecord::Kind::rst75;
    calls.follow(taken);
    calls.follow(step(0xF5, 0x3C, 0x8FFE, 0x3D, 0x8FFC));  // PUSH PSW
    ASSERT_EQ(calls.frames().size(), 1u);
    EXPECT_EQ(calls.frames()[0], (Frame{Frame::Kind::rst75, false, 0x150, 0x3C, 0x8FFE, 0x150}));
}

TEST(CallStack, DroppedReturnAddressesEndTheirFrames) {
    CallStack calls;
    calls.follow(step(0xCD, 0x100, 0x9000, 0x200, 0x8FFE));
    calls.follow(step(0xCD, 0x200, 0x8FFE, 0x300, 0x8FFC));
    calls.follow(step(0x31, 0x300, 0x8FFC, 0x303, 0x9000));  // LXI SP,9000H
    EXPECT_TRUE(calls.frames().empty());
}

TEST(CallStack, ARunawayRecursionKeepsTheNewest) {
    CallStack calls;
    for (unsigned i = 0; i < 600; ++i) {
        const auto sp = static_cast<uint16_t>(0xF000 - 2 * i);
        calls.follow(
            step(0xCD, static_cast<uint16_t>(i), sp, 0x200, static_cast<uint16_t>(sp - 2)));
    }
    EXPECT_EQ(calls.frames().size(), CallStack::kDepthMax);
    EXPECT_EQ(calls.frames().back().from, 599);
}

TEST(CallStack, MemoryIsSearchedWhereNobodyLooked) {
    BoardState state;
    state.cpu.sp = 0xFFF8;
    auto& bytes = state.memory.bytes;
    const auto put = [&bytes](uint16_t at, std::initializer_list<uint8_t> list) {
        std::copy(list.begin(), list.end(), bytes.begin() + at);
    };
    put(0x0100, {0xCD, 0x00, 0x02});        // CALL 0200H
    put(0x0200, {0xC4, 0x00, 0x03});        // CNZ 0300H
    put(0xFFF8, {0x34, 0x12, 0x03, 0x02});  // data 1234H, return to 0203H
    put(0xFFFC, {0x03, 0x01, 0x00, 0x00});  // return to 0103H
    CallStack calls;
    EXPECT_TRUE(calls.backtrace(state).empty()) << "observed since the reset: nothing was called";
    calls.forget();
    const auto guesses = calls.backtrace(state);
    ASSERT_EQ(guesses.size(), 2u);
    EXPECT_EQ(guesses[0], (Frame{Frame::Kind::call, true, 0x200, 0x300, 0xFFFA, 0x203}));
    EXPECT_EQ(guesses[1], (Frame{Frame::Kind::call, true, 0x100, 0x200, 0xFFFC, 0x103}));
    calls.follow(step(0xCD, 0x300, 0xFFF8, 0x400, 0xFFF6));
    EXPECT_EQ(calls.backtrace(state).size(), 3u) << "observed ones first";
    EXPECT_FALSE(calls.backtrace(state)[0].guessed);
    calls.clear();
    EXPECT_TRUE(calls.backtrace(state).empty());
}

TEST(CallStack, AboveWrapsWithTheStack) {
    EXPECT_TRUE(above(0x0000, 0xFFFE));
    EXPECT_FALSE(above(0xFFFE, 0x0000));
    EXPECT_FALSE(above(0x1234, 0x1234));
}

TEST(CallStack, FlowIsOfInstructionsOnly) {
    StepRecord record = step(0xC9, 0, 0, 0, 0);
    EXPECT_EQ(flow_of(record), Flow::ret);
    record.kind = StepRecord::Kind::trap;
    EXPECT_EQ(flow_of(record), Flow::next);
}

}  // namespace
}  // namespace debug_console
