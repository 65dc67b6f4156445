// Runs of the board: how they end, reset, watchdog, power, EEPROM, events from outside.
#include "host_sim/board/board.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

#include "tests/host_sim/board/board_program.hpp"

namespace {

using board_test::assemble_program;
using host_sim::Board;
using host_sim::BoardOptions;
using host_sim::InstructionSet;
using host_sim::MemoryMap;
using host_sim::RunEnd;
using host_sim::StepRecord;
using host_sim::Stimulus;
using host_sim::Violation;

// From the board's page: 3.072 MHz; quiet time 0.5 s, pulse 20 ms.
constexpr uint64_t kWatchdogT = 1'536'000;
constexpr uint64_t kWatchdogPulseT = 61'440;

void load(Board& board, const std::string& source) {
    board_test::program(board, assemble_program(source));
}

TEST(Board, StartsAtZeroWithErasedMemoryAndZeroedRam) {
    Board board;
    EXPECT_EQ(board.state.cpu.pc, 0);
    EXPECT_EQ(board.state.cpu.t, 0U);
    EXPECT_EQ(board.state.memory.bytes[0x7FFF], 0xFF);
    EXPECT_EQ(board.state.memory.bytes[0x8000], 0x00);
    EXPECT_EQ(board.state.reset_count, 1U);
    EXPECT_TRUE(board.state.eeprom.write_protected);
}

TEST(Board, ProgramTooLongIsRefused) {
    Board board;
    EXPECT_THROW(board.program(std::vector<uint8_t>(32769)), std::length_error);
    EXPECT_THROW(board.program(std::vector<uint8_t>(2), 0x7FFF), std::length_error);
}

TEST(Board, AWheelTurnsBothWaysByAnyNumberOfPulses) {
    Board board;
    load(board, "MVI A,34H\n OUT 17H\n XRA A\n OUT 14H\n OUT 14H\n HLT");
    board.run(1000);
    board.turn_wheel(0, 1001);  // the first pulse loads the count
    EXPECT_EQ(board.state.timers[1].counters[0].value, 65536U - 1000);
    EXPECT_EQ(board.state.ppis[0].port_level(host_sim::chips::I82c55a::Port::b) & 1, 1);
    board.turn_wheel(0, 0);
    EXPECT_EQ(board.state.ppis[0].port_level(host_sim::chips::I82c55a::Port::b) & 1, 1);
    board.turn_wheel(0, -200);
    EXPECT_EQ(board.state.timers[1].counters[0].value, 65536U - 1200) << "it counts either way";
    EXPECT_EQ(board.state.ppis[0].port_level(host_sim::chips::I82c55a::Port::b) & 1, 0);
}

TEST(Board, ReplayedInputsReachTheChips) {
    Board board;
    board.replay_sensor(3, 1607);
    EXPECT_EQ(board.state.analog.sources[3].sum_q4, 1607);
    board.replay_sensor(3, hal::kAdcAbsent);
    using Kind = host_sim::chips::AnalogInput::Source::Kind;
    EXPECT_EQ(board.state.analog.sources[3].kind, Kind::silent);
    board.replay_range_scan(77, 0x03, {10, 20});
    EXPECT_EQ(board.state.range.scan_counter, 77);
    EXPECT_EQ(board.state.range.scan_q1_mm[1], 20);
    board.set_range_connected(false);
    EXPECT_FALSE(board.state.range.connected);
}

TEST(Board, RunEndsAtTheFirstBoundaryBehindTheLimit) {
    Board board;
    load(board, "LOOP: JMP LOOP");
    EXPECT_EQ(board.run(25), RunEnd::time_limit);
    EXPECT_EQ(board.state.cpu.t, 30U);
    EXPECT_EQ(board.state.cpu.instructions, 3U);
    EXPECT_EQ(board.run(30), RunEnd::time_limit);
    EXPECT_EQ(board.state.cpu.t, 30U);
}

TEST(Board, HaltWithInterruptsDisabledEndsTheRunIfAskedFor) {
    BoardOptions options;
    options.stop_at_halt = true;
    Board board(options);
    load(board, "MVI A,5\n HLT");
    EXPECT_EQ(board.run(1000), RunEnd::halted);
    EXPECT_EQ(board.state.cpu.t, 12U);
    Board patient;
    load(patient, "MVI A,5\n HLT");
    EXPECT_EQ(patient.run(1000), RunEnd::time_limit);
    EXPECT_EQ(patient.state.cpu.t, 1000U);
}

TEST(Board, UndocumentedInstructionStopsADocumentedBoard) {
    BoardOptions options;
    options.instruction_set = InstructionSet::documented;
    Board board(options);
    load(board, "NOP\n LXI H,1234H\n DSUB\n NOP");
    EXPECT_EQ(board.run(1000), RunEnd::undefined_instruction);
    EXPECT_EQ(board.state.cpu.pc, 4);
    EXPECT_EQ(board.state.cpu.t, 14U);
    EXPECT_EQ(board.state.memory.bytes[4], 0x08);
}

TEST(Board, ViolationStopsBehindItsInstructionWithPcAndTime) {
    BoardOptions options;
    options.stop_at_violation = true;
    options.memory_map = MemoryMap{0x7FFF, 0x8000, 0x87FF};
    Board board(options);
    load(board, "LXI H,8800H\n MVI M,5AH\n JMP 0");
    EXPECT_EQ(board.run(10'000), RunEnd::violation);
    // LXI 10 T; the write cycle of MVI M (10 T) ends with it.
    const Violation expected{Violation::Kind::unmapped_write, 3, 0x8800, 0x5A, 20};
    EXPECT_EQ(board.state.last_violation, expected);
    EXPECT_EQ(board.state.cpu.pc, 5);
    EXPECT_EQ(board.run(20), RunEnd::time_limit);  // reported once
}

TEST(Board, QuietWatchdogHoldsTheBoardInResetAndStartsItAnew) {
    Board board;
    load(board, "MVI A,55H\n OUT MOTOR\n LXI H,8000H\n INR M\n LOOP: JMP LOOP");
    board.run(kWatchdogT - 10);
    EXPECT_EQ(board.state.motors.duty(0), 0x55);
    EXPECT_EQ(board.state.reset_count, 1U);
    board.run(kWatchdogT + 20);
    EXPECT_EQ(board.state.motors.duty(0), 0);
    EXPECT_EQ(board.state.reset_count, 2U);
    const uint64_t instructions = board.state.cpu.instructions;
    board.run(kWatchdogT + kWatchdogPulseT);
    EXPECT_EQ(board.state.cpu.instructions, instructions);
    EXPECT_EQ(board.state.cpu.t, kWatchdogT + kWatchdogPulseT);
    board.run(kWatchdogT + kWatchdogPulseT + 100);
    EXPECT_EQ(board.state.memory.bytes[0x8000], 2);
    EXPECT_EQ(board.state.motors.duty(0), 0x55);
}

TEST(Board, SodEdgesKeepTheWatchdogQuiet) {
    Board board;
    load(board, R"(
LOOP:   MVI  A,0C0H
        SIM
        LXI  B,50000
WAIT1:  DCX  B
        MOV  A,B
        ORA  C
        JNZ  WAIT1
        MVI  A,40H
        SIM
        JMP  LOOP
)");
    board.run(10 * kWatchdogT);
    EXPECT_EQ(board.state.reset_count, 1U);
    EXPECT_EQ(board.state.watchdog.fired_count, 0U);
}

TEST(Board, ResetButtonStartsAnew) {
    Board board;
    load(board, "LXI H,8000H\n INR M\n EI\n HLT");
    board.schedule({5000, Stimulus::Kind::reset_button, 0, 0});
    board.run(5000 + kWatchdogPulseT - 10);
    EXPECT_EQ(board.state.memory.bytes[0x8000], 1) << "held as long as by the watchdog";
    board.run(6000 + kWatchdogPulseT);
    EXPECT_EQ(board.state.memory.bytes[0x8000], 2);
    EXPECT_EQ(board.state.reset_count, 2U);
}

TEST(Board, PowerCycleKeepsRamAndEepromOnly) {
    Board board;
    load(board, "MVI A,55H\n OUT MOTOR\n STA 9000H\n LXI B,1234H\n HLT");
    board.run(1000);
    board.power_cycle();
    EXPECT_EQ(board.state.memory.bytes[0x9000], 0x55);
    EXPECT_EQ(board.state.memory.bytes[0], 0x3E);
    EXPECT_EQ(board.state.motors.duty(0), 0);
    EXPECT_EQ(board.state.cpu.pc, 0);
    EXPECT_EQ(board.state.cpu.bc(), 0);
    EXPECT_FALSE(board.state.cpu.halted);
    EXPECT_GE(board.state.cpu.t, 1000U);  // time goes on
}

// A routine in RAM unlocks the EEPROM, writes one byte and polls bit 7 until it reads true.
constexpr const char* kEepromWriter = R"(
        ORG  0
        LXI  SP,TOP
        LXI  H,ROUTINE
        LXI  D,8000H
        MVI  B,ROUTEND-ROUTINE
COPY:   MOV  A,M
        STAX D
        INX  H
        INX  D
        DCR  B
        JNZ  COPY
        CALL 8000H
        LDA  0700H
        STA  9000H
        HLT
ROUTINE: MVI A,0AAH
        STA  5555H
        MVI  A,55H
        STA  2AAAH
        MVI  A,0A0H
        STA  5555H
        MVI  A,3CH
        STA  0700H
POLL:   LDA  0700H
        XRI  3CH
        JNZ  POLL-ROUTINE+8000H
        RET
ROUTEND: NOP
)";

TEST(Board, RoutineInRamProgramsTheEepromByDataPolling) {
    Board board;
    load(board, kEepromWriter);
    board.run(40'000);
    EXPECT_EQ(board.state.memory.bytes[0x9000], 0x3C);
    EXPECT_EQ(board.state.eeprom.contents[0x0700], 0x3C);
    EXPECT_EQ(board.state.violation_count, 0U);
    EXPECT_TRUE(board.state.cpu.halted);
}

TEST(Board, CodeThatRunsInTheEepromWhileItIsWrittenGetsPollingBytes) {
    Board board;
    load(board, R"(
        MVI  A,0AAH
        STA  5555H
        MVI  A,55H
        STA  2AAAH
        MVI  A,0A0H
        STA  5555H
        MVI  A,3CH
        STA  0700H
        MVI  A,77H
        STA  9000H
        HLT
)");
    board.run(20'000);
    EXPECT_NE(board.state.memory.bytes[0x9000], 0x77);  // lost: it fetched polling bytes
}

TEST(Board, StimuliHappenInTheOrderOfTheirTimes) {
    Board board;
    load(board, "EI\n LOOP: HLT\n JMP LOOP");
    board.schedule({300, Stimulus::Kind::detectors, 0, 3});
    board.schedule({100, Stimulus::Kind::detectors, 0, 1});
    board.schedule({200, Stimulus::Kind::detectors, 0, 2});
    for (const auto& [t, bits] : {std::pair{150, 1}, {250, 2}, {350, 3}}) {
        board.run(static_cast<uint64_t>(t));
        EXPECT_EQ(board.state.ppis[1].port_level(host_sim::chips::I82c55a::Port::b), bits);
    }
    board.schedule({50, Stimulus::Kind::detectors, 0, 9});  // late: at once
    EXPECT_EQ(board.state.ppis[1].port_level(host_sim::chips::I82c55a::Port::b), 9);
    EXPECT_TRUE(board.state.stimuli.empty());
}

TEST(Board, RangeScanAndSerialOutputReachTheOutside) {
    Board board;
    board.set_range_scan(0x01, {42, 0, 0, 0, 0, 0, 0, 0});
    EXPECT_EQ(board.state.range.scan_counter, 1);
    load(board, R"(
        MVI  A,56H
        OUT  TIMERC
        MVI  A,10
        OUT  TIMER1
        MVI  A,4EH
        OUT  UCTL
        MVI  A,21H
        OUT  UCTL
        MVI  A,'o'
        OUT  UDATA
WAIT:   IN   UCTL
        ANI  1
        JZ   WAIT
        MVI  A,'k'
        OUT  UDATA
        HLT
)");
    board.run(10'000);
    const auto sent = board.take_transmitted();
    ASSERT_EQ(sent.size(), 2U);
    EXPECT_EQ(sent[0].byte, 'o');
    EXPECT_EQ(sent[1].byte, 'k');
    EXPECT_EQ(sent[1].start_t, sent[0].end_t);  // back to back
    EXPECT_TRUE(board.take_transmitted().empty());
}

TEST(Board, SensorVoltageIsTheMiddleOfItsCode) {
    EXPECT_EQ(host_sim::sensor_uv_of_count(0), -5'000'000);
    EXPECT_EQ(host_sim::sensor_uv_of_count(2048), 0);
    EXPECT_EQ(host_sim::sensor_uv_of_count(4095), 4'997'558);
}

}  // namespace
