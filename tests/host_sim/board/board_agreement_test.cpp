// The three ways to run a board agree bit for bit, and a snapshot continues as the original does,
// taken anywhere: in a handler, a conversion, a character, an EEPROM page write, a reset pulse.
#include <gtest/gtest.h>

#include <cstdint>
#include <iostream>
#include <random>
#include <string>
#include <vector>

#include "tests/host_sim/board/board_program.hpp"

namespace {

using host_sim::Board;
using host_sim::BoardState;
using host_sim::StepRecord;
using host_sim::Stimulus;

// Everything at once: tick with watchdog edges, characters in and out by interrupt, conversions,
// laser gate, motors, an EEPROM byte from a routine in RAM every 256 loops, EI/DI/HLT/RIM.
constexpr const char* kEverything = R"(
        ORG  0
        JMP  START
        ORG  24H
        JMP  TRAP
        ORG  2CH
        JMP  SENDI
        ORG  34H
        JMP  RECEIVE
        ORG  3CH
        JMP  TICK
        ORG  100H
START:  LXI  SP,TOP
        LXI  H,ROUTINE
        LXI  D,8800H
        MVI  B,ROUTEND-ROUTINE
COPY:   MOV  A,M
        STAX D
        INX  H
        INX  D
        DCR  B
        JNZ  COPY
        MVI  A,34H
        OUT  TIMERC
        MVI  A,10H
        OUT  TIMER0
        MVI  A,27H
        OUT  TIMER0
        MVI  A,56H
        OUT  TIMERC
        MVI  A,10
        OUT  TIMER1
        MVI  A,4EH
        OUT  UCTL
        MVI  A,25H
        OUT  UCTL
        MVI  A,82H
        OUT  PPIA+3
        MVI  A,93H
        OUT  PPIB+3
        MVI  A,18H
        SIM
        EI
MAIN:   LXI  H,8010H
        MOV  A,M
        OUT  PPIA
        OUT  MOTOR+3
        OUT  ADC
        MVI  B,20
SPIN:   IN   PPIA+1
        ANI  40H
        JZ   READY
        DCR  B
        JNZ  SPIN
READY:  IN   ADC
        STA  8020H
        IN   ADC+1
        STA  8021H
        IN   PPIB+1
        STA  8022H
        RIM
        STA  8023H
        IN   PPIB
        MVI  A,20H
        OUT  PPIB+2
        LDA  8010H
        ANI  0FH
        OUT  PPIA+2
        INR  M
        JNZ  NOBURN
        DI
        CALL 8800H
        EI
NOBURN: MOV  A,M
        ANI  0FH
        JNZ  MAIN
        EI
        HLT
        JMP  MAIN
TICK:   PUSH PSW
        LDA  8000H
        INR  A
        STA  8000H
        RRC
        ANI  80H
        ORI  40H
        SIM
        POP  PSW
        EI
        RET
SENDI:  PUSH PSW
        LDA  8001H
        INR  A
        STA  8001H
        OUT  UDATA
        POP  PSW
        EI
        RET
RECEIVE: PUSH PSW
        PUSH H
        IN   UCTL
        LXI  H,8003H
        ORA  M
        MOV  M,A
        IN   UDATA
        STA  8002H
        POP  H
        POP  PSW
        EI
        RET
TRAP:   PUSH PSW
        RIM
        STA  8004H
        RIM
        STA  8005H
        POP  PSW
        RET
ROUTINE: MVI A,0AAH
        STA  5555H
        MVI  A,55H
        STA  2AAAH
        MVI  A,0A0H
        STA  5555H
        LDA  8000H
        STA  0700H
        MOV  C,A
POLL:   LDA  0700H
        XRA  C
        JNZ  POLL-ROUTINE+8800H
        RET
ROUTEND: NOP
)";

constexpr uint64_t kEndT = 6'000'000;  // two seconds

void prepare(Board& board, uint64_t seed) {
    board_test::program(board, board_test::assemble_program(kEverything));
    std::mt19937_64 random(seed);
    const auto pick = [&](uint64_t limit) { return random() % limit; };
    for (int i = 0; i < 400; ++i) {
        const uint64_t t = pick(kEndT);
        const auto value = static_cast<int32_t>(pick(256));
        switch (pick(7)) {
            case 0:
                board.schedule({t, Stimulus::Kind::serial_byte, 0, value});
                break;
            case 1:
                board.schedule({t, Stimulus::Kind::undervoltage, 0, value & 1});
                break;
            case 2:
                board.schedule({t, Stimulus::Kind::bumper, 0, value & 1});
                break;
            case 3:
                board.schedule({t, Stimulus::Kind::detectors, 0, value});
                break;
            case 4:
                board.schedule({t, Stimulus::Kind::service, 0, value & 1});
                break;
            case 5:
                board.schedule({t, Stimulus::Kind::tach_pulse, static_cast<uint8_t>(pick(6)), 0});
                break;
            default:
                board.schedule({t, Stimulus::Kind::sensor, static_cast<uint8_t>(pick(16)),
                                static_cast<int32_t>(pick(10'000'000)) - 5'000'000});
        }
    }
    if (seed % 3 == 0) board.schedule({pick(kEndT), Stimulus::Kind::reset_button, 0, 0});
}

void step_to(Board& board, uint64_t until_t) {
    StepRecord record;
    while (board.state.cpu.t < until_t) board.step(record, until_t);
}

class BoardAgreement : public testing::TestWithParam<uint64_t> {};

TEST_P(BoardAgreement, FastPlainAndRecordedRunsReachTheSameStates) {
    Board fast;
    Board plain;
    Board stepped;
    for (Board* board : {&fast, &plain, &stepped}) prepare(*board, GetParam());
    std::mt19937_64 random(GetParam() ^ 0x8085);
    uint64_t t = 0;
    while (t < kEndT) {
        t += 1 + random() % (random() % 4 == 0 ? 50 : 200'000);
        fast.run(t);
        plain.run_reference(t);
        step_to(stepped, t);
        ASSERT_TRUE(fast.state == plain.state) << "seed " << GetParam() << ", T " << t;
        ASSERT_TRUE(fast.state == stepped.state) << "seed " << GetParam() << ", T " << t;
    }
    // The run was worth comparing.
    EXPECT_GT(fast.state.eeprom.cycle_count, 0U);
    EXPECT_GT(fast.state.analog.adc.conversion_count, 100U);
    EXPECT_GT(fast.state.usart.transmitted.size(), 100U);
    EXPECT_NE(fast.state.memory.bytes[0x8002], 0);
}

TEST_P(BoardAgreement, SnapshotContinuesLikeTheOriginal) {
    Board board;
    prepare(board, GetParam());
    std::mt19937_64 random(GetParam() ^ 0x7575);
    std::vector<BoardState> snapshots;
    uint64_t t = 0;
    while (t < kEndT / 4) {
        t += 1 + random() % 60'000;
        board.run(t);
        snapshots.push_back(board.state);
    }
    board.run(kEndT / 2);
    for (const BoardState& snapshot : snapshots) {
        Board restored;
        restored.state = snapshot;
        EXPECT_TRUE(restored.state == snapshot);
        restored.run(kEndT / 2);
        ASSERT_TRUE(restored.state == board.state)
            << "seed " << GetParam() << ", snapshot at T " << snapshot.cpu.t;
    }
}

INSTANTIATE_TEST_SUITE_P(Seeds, BoardAgreement, testing::Range(uint64_t{0}, uint64_t{6}));

}  // namespace
