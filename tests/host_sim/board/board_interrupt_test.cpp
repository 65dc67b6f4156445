// Interrupt latency, handler entry and timer jitter on the board, in exact T-states.
// Sources: 8085AH data sheet (T-states; inputs sampled in the next-to-last T-state; 12 T to enter a
// restart), 82C54 data sheet, mode 2 (a count N written before CLK pulse 1 is loaded by it, OUT is
// low in the pulse N - 1 later and rises with the reload one pulse after that).
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "tests/host_sim/board/board_program.hpp"
#include "tests/support/trap_gate.hpp"

namespace {

using board_test::assemble_program;
using host_sim::Board;
using host_sim::StepRecord;
using host_sim::Stimulus;

// Timer A counter 0 in mode 2 with count 1000, RST 7.5 unmasked. T-states of the start: JMP 10,
// LXI 10, then three times MVI 7 and OUT 10: the second count byte is complete at 71. CLK pulse 72
// loads it, so OUT rises at 72 + 1000, 72 + 2000, ... MVI 7, SIM 4, EI 4: MAIN begins at 86.
constexpr const char* kTickStart = R"(
        ORG  0
        JMP  START
        ORG  24H
        RET
        ORG  3CH
        JMP  TICK
        ORG  100H
START:  LXI  SP,TOP
        MVI  A,34H
        OUT  TIMERC
        MVI  A,0E8H
        OUT  TIMER0
        MVI  A,03H
        OUT  TIMER0
        MVI  A,1BH
        SIM
        EI
)";
constexpr uint64_t kMainT = 86;
constexpr uint64_t kFirstEdgeT = 1072;
constexpr uint64_t kPeriodT = 1000;

/// Interrupts taken until `until_t`, as records.
std::vector<StepRecord> interrupts(Board& board, uint64_t until_t) {
    std::vector<StepRecord> taken;
    StepRecord record;
    while (board.state.cpu.t < until_t) {
        board.step(record, until_t);
        if (record.kind != StepRecord::Kind::instruction && record.kind != StepRecord::Kind::halt) {
            taken.push_back(record);
        }
    }
    return taken;
}

std::vector<StepRecord> interrupts_of(const std::string& source, uint64_t until_t) {
    Board board;
    board_test::program(board, assemble_program(source));
    return interrupts(board, until_t);
}

TEST(BoardInterrupt, JumpLoopMeetsEveryTickAtItsNextBoundary) {
    // The handler: JMP 10, EI 4, RET 10 behind 12 T of acceptance.
    const auto taken = interrupts_of(std::string(kTickStart) + R"(
MAIN:   JMP  MAIN
TICK:   EI
        RET
)",
                                     100'000);
    ASSERT_EQ(taken.size(), 99U);  // edges at 1072 ... 99072 are entered before 100,000
    uint64_t loop_t = kMainT;
    for (uint64_t tick = 0; tick < taken.size(); ++tick) {
        const uint64_t seen_t = kFirstEdgeT + tick * kPeriodT + 2;
        const uint64_t boundary_t = loop_t + (seen_t - loop_t + 9) / 10 * 10;
        EXPECT_EQ(taken[tick].kind, StepRecord::Kind::rst75);
        EXPECT_EQ(taken[tick].t_begin, boundary_t) << "tick " << tick;
        EXPECT_EQ(taken[tick].t_end, boundary_t + 12) << "tick " << tick;
        EXPECT_EQ(taken[tick].next_pc, 0x003C);
        loop_t = boundary_t + 12 + 10 + 4 + 10;
    }
    EXPECT_EQ(taken[0].t_begin, 1076U);  // by hand: 86 + 99 * 10
    EXPECT_EQ(taken[1].t_begin, 2082U);  // back in the loop at 1112; 1112 + 97 * 10
}

TEST(BoardInterrupt, HaltHasNoJitter) {
    const auto taken = interrupts_of(std::string(kTickStart) + R"(
MAIN:   HLT
        JMP  MAIN
TICK:   EI
        RET
)",
                                     50'000);
    ASSERT_EQ(taken.size(), 49U);
    for (uint64_t tick = 0; tick < taken.size(); ++tick) {
        EXPECT_EQ(taken[tick].t_begin, kFirstEdgeT + tick * kPeriodT + 2) << "tick " << tick;
        EXPECT_EQ(taken[tick].t_end - taken[tick].t_begin, 12U);
    }
}

TEST(BoardInterrupt, LatencyIsBoundedByTheLongestInstruction) {
    // The loop takes 18 + 10 + 6 + 16 + 16 + 10 + 10 = 86 T; 0 to 85 times 7 T in front of it bring
    // the edge to every one of its T-states. Seen 2 to 1 + 18 T later: 18 of CALL is the longest.
    uint64_t shortest = UINT64_MAX;
    uint64_t longest = 0;
    std::string delay;
    for (int count = 0; count < 86; ++count) {
        const auto taken = interrupts_of(std::string(kTickStart) + delay + R"(
MAIN:   CALL SUB
        JMP  MAIN
SUB:    DAD  B
        INX  H
        XTHL
        XTHL
        RET
TICK:   EI
        RET
)",
                                         kFirstEdgeT + 100);
        ASSERT_EQ(taken.size(), 1U);
        const uint64_t latency = taken[0].t_begin - kFirstEdgeT;
        shortest = std::min(shortest, latency);
        longest = std::max(longest, latency);
        delay += "        MVI  C,0\n";
    }
    EXPECT_EQ(shortest, 2U);
    EXPECT_EQ(longest, 19U);
}

TEST(BoardInterrupt, SecondTickWaitsWhileInterruptsAreDisabled) {
    // The handler spends 2,500 T with interrupts disabled: two edges pass, one is remembered.
    const auto taken = interrupts_of(std::string(kTickStart) + R"(
MAIN:   HLT
        JMP  MAIN
TICK:   LXI  B,104
WAIT:   DCX  B
        MOV  A,B
        ORA  C
        JNZ  WAIT
        EI
        RET
)",
                                     8'000);
    // Entry 1074 + 12, JMP 10, LXI 10, 104 * (6 + 4 + 4 + 10) - 3, EI 4, RET 10: RET ends at 3613.
    ASSERT_GE(taken.size(), 2U);
    EXPECT_EQ(taken[0].t_begin, 1074U);
    EXPECT_EQ(taken[1].t_begin, 1074U + 12 + 10 + 10 + 104 * 24 - 3 + 4 + 10);
    EXPECT_EQ(taken[1].pc, 0x0114);  // the JMP behind HLT at 0113
}

TEST(BoardInterrupt, UndervoltageTakesTheTrapAtOnceAndOnce) {
    Board board;
    board_test::program(board, assemble_program(std::string(kTickStart) + R"(
        DI
MAIN:   JMP  MAIN
TICK:   RET
)"));
    test_support::open_trap_gate(board.state);
    // MAIN begins at 90 behind DI; boundaries at 90 + 10 k. Low again, then a second rise.
    for (const auto& [t, level] : {std::pair{201, 1}, {500, 0}, {509, 1}, {700, 0}}) {
        board.schedule({static_cast<uint64_t>(t), Stimulus::Kind::undervoltage, 0, level});
    }
    const auto taken = interrupts(board, 1000);
    ASSERT_EQ(taken.size(), 2U);
    EXPECT_EQ(taken[0].kind, StepRecord::Kind::trap);
    EXPECT_EQ(taken[0].t_begin, 210U);
    EXPECT_EQ(taken[0].next_pc, 0x0024);
    // Back at 210 + 12 + 10 = 232; 509 is seen at 511 or later: 232 + 28 * 10.
    EXPECT_EQ(taken[1].t_begin, 512U);
}

TEST(BoardInterrupt, TheGateHoldsTrapBackUntilSoftwareOpensItAndResetClosesIt) {
    Board board;
    // The gate opens with the line active: the edge is the gate's.
    board_test::program(board, assemble_program(R"(
        LXI  SP,TOP
        MVI  A,93H
        OUT  27H
        MVI  B,100
WAIT:   DCR  B
        JNZ  WAIT
        MVI  A,0DH
        OUT  27H
        HLT
        ORG  24H
        HLT
)"));
    board.schedule({5, Stimulus::Kind::bumper, 0, 1});
    auto taken = interrupts(board, 1300);
    EXPECT_TRUE(taken.empty());
    taken = interrupts(board, 2000);
    ASSERT_EQ(taken.size(), 1U);
    EXPECT_EQ(taken[0].kind, StepRecord::Kind::trap);
    board.reset();
    EXPECT_FALSE(board.state.cpu.pin(host_sim::Pin::trap).level);
}

TEST(BoardInterrupt, HaltNoticesAPulseOfOneTState) {
    Board board;
    board_test::program(board, assemble_program("LXI SP,TOP\n HLT\n DS 32\n HLT"));
    test_support::open_trap_gate(board.state);
    board.schedule({1000, Stimulus::Kind::undervoltage, 0, 1});
    board.schedule({1001, Stimulus::Kind::undervoltage, 0, 0});
    const auto taken = interrupts(board, 2000);
    ASSERT_EQ(taken.size(), 1U);
    EXPECT_EQ(taken[0].kind, StepRecord::Kind::trap);
    EXPECT_EQ(taken[0].t_begin, 1002U);
}

// DI ends at 90, DS assembles to NOPs of 4 T. SIM looks at its third T-state, as RIM does.
uint8_t mask_register_behind(const std::string& delay) {
    Board board;
    board_test::program(board,
                        assemble_program(std::string(kTickStart) + "        DI\n" + delay + R"(
        SIM
        RIM
        STA  8000H
        HLT
TICK:   RET
)"));
    board.run(2000);
    return board.state.memory.bytes[0x8000];
}

TEST(BoardInterrupt, SimClearsAnEdgeThatCameBeforeItLooked) {
    constexpr uint8_t kPending75 = 0x40;
    // SIM from 1070 to 1074, the edge at 1072.
    EXPECT_EQ(mask_register_behind("        DS 245\n") & kPending75, 0);
    // SIM from 1068 to 1072: the edge comes as it ends.
    EXPECT_EQ(mask_register_behind("        DS 243\n        INX H\n") & kPending75, kPending75);
}

TEST(BoardInterrupt, ReceivedCharacterRaisesRst65) {
    Board board;
    board_test::program(board, assemble_program(R"(
        ORG  0
        JMP  START
        ORG  34H
        IN   UDATA
        STA  8000H
        HLT
        ORG  100H
START:  LXI  SP,TOP
        MVI  A,56H
        OUT  TIMERC
        MVI  A,10
        OUT  TIMER1
        MVI  A,4EH
        OUT  UCTL
        MVI  A,14H
        OUT  UCTL
        MVI  A,0DH
        SIM
        EI
        HLT
)"));
    board.schedule({10'000, Stimulus::Kind::serial_byte, 0, 0xA7});
    const auto taken = interrupts(board, 20'000);
    ASSERT_EQ(taken.size(), 1U);
    EXPECT_EQ(taken[0].kind, StepRecord::Kind::rst65);
    // Nine bits of 160 T and the middle of the stop bit; the data sheet allows 26 T for the flag.
    EXPECT_GE(taken[0].t_begin, 10'000U + 9 * 160);
    EXPECT_LE(taken[0].t_begin, 10'000U + 10 * 160 + 26);
    EXPECT_EQ(board.state.memory.bytes[0x8000], 0xA7);
}

TEST(BoardInterrupt, TransmitterReadyRaisesRst55AndTheCharacterLeaves) {
    Board board;
    board_test::program(board, assemble_program(R"(
        ORG  0
        JMP  START
        ORG  2CH
        MVI  A,'R'
        OUT  UDATA
        MVI  A,0FH
        SIM
        EI
        RET
        ORG  100H
START:  LXI  SP,TOP
        MVI  A,56H
        OUT  TIMERC
        MVI  A,10
        OUT  TIMER1
        MVI  A,4EH
        OUT  UCTL
        MVI  A,21H
        OUT  UCTL
        MVI  A,0EH
        SIM
        EI
MAIN:   JMP  MAIN
)"));
    const auto taken = interrupts(board, 20'000);
    ASSERT_EQ(taken.size(), 1U);
    EXPECT_EQ(taken[0].kind, StepRecord::Kind::rst55);
    const auto sent = board.take_transmitted();
    ASSERT_EQ(sent.size(), 1U);
    EXPECT_EQ(sent[0].byte, 'R');
    EXPECT_EQ(sent[0].end_t - sent[0].start_t, 1600U);
}

}  // namespace
