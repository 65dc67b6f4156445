// flat_machine_test.cpp - why runs end, and whole programs whose totals are worked out by hand.
#include "host_sim/cpu/flat_machine.hpp"

#include <gtest/gtest.h>

#include <initializer_list>

namespace {

using host_sim::CpuState;
using host_sim::FlatMachine;
using host_sim::InstructionSet;
using host_sim::RunEnd;
using host_sim::StepRecord;

constexpr uint64_t kForever = UINT64_MAX;

/// Both ways to run.
class Runs : public testing::TestWithParam<bool> {
protected:
    void code(std::initializer_list<int> bytes, uint16_t address = 0) {
        for (const int byte : bytes) machine_.memory.bytes[address++] = static_cast<uint8_t>(byte);
    }
    RunEnd run(uint64_t until_t) {
        return GetParam() ? machine_.run(until_t) : machine_.run_reference(until_t);
    }
    FlatMachine machine_;
};
INSTANTIATE_TEST_SUITE_P(Interpreters, Runs, testing::Bool(),
                         [](const auto& which) { return which.param ? "Fast" : "Reference"; });

TEST_P(Runs, EndWithTheTime) {
    EXPECT_EQ(run(10), RunEnd::time_limit);
    EXPECT_EQ(machine_.cpu.t, 12U) << "whole instructions, NOPs here";
    EXPECT_EQ(run(12), RunEnd::time_limit);
    EXPECT_EQ(machine_.cpu.t, 12U) << "nothing is left to do";
}

TEST_P(Runs, EndWithHalt) {
    code({0x00, 0x76});
    EXPECT_EQ(run(1000), RunEnd::halted);
    EXPECT_EQ(machine_.cpu.t, 9U);
    EXPECT_EQ(machine_.cpu.pc, 2);
    const CpuState before = machine_.cpu;
    EXPECT_EQ(run(2000), RunEnd::halted);
    EXPECT_EQ(machine_.cpu, before) << "time stands still";
}

TEST_P(Runs, EndWithHaltAlsoAtTheLastMoment) {
    code({0x76});
    EXPECT_EQ(run(5), RunEnd::halted);
    EXPECT_EQ(machine_.cpu.t, 5U);
}

TEST_P(Runs, EndBeforeAnInstructionOutsideTheSet) {
    machine_ = FlatMachine(InstructionSet::documented);
    code({0x00, 0x00, 0x10});
    for (int i = 0; i < 2; ++i) {
        EXPECT_EQ(run(1000), RunEnd::undefined_instruction);
        EXPECT_EQ(machine_.cpu.pc, 2);
        EXPECT_EQ(machine_.cpu.t, 8U);
        EXPECT_EQ(machine_.cpu.instructions, 2U);
    }
}

TEST_P(Runs, ReadTheOpenBusFromPorts) {
    code({0xDB, 0x12, 0x76});
    run(kForever);
    EXPECT_EQ(machine_.cpu.a, 0xFF);
}

// MVI B,n; DCR B; JNZ: 7 + n (4 + 10) - 3 T-states, 1 + 2 n instructions; HLT 5.
TEST_P(Runs, CountADelayLoop) {
    for (int n = 1; n <= 256; ++n) {
        machine_ = FlatMachine();
        code({0x06, n & 0xFF, 0x05, 0xC2, 0x02, 0x00, 0x76});
        EXPECT_EQ(run(kForever), RunEnd::halted);
        EXPECT_EQ(machine_.cpu.t, 7U + 14U * static_cast<unsigned>(n) - 3 + 5);
        EXPECT_EQ(machine_.cpu.instructions, 1U + 2U * static_cast<unsigned>(n) + 1);
    }
}

// Hanoi with seven disks, counted by recursion: 2^7 - 1 moves.
//   0000 LXI SP,8000H  MVI A,7  CALL 0010H  HLT
//   0010 ORA A  RZ  DCR A  PUSH PSW  CALL 0010H  INX D  POP PSW  CALL 0010H  INR A  RET
// The routine returns with A as it was. With n = 0: ORA 4, RZ taken 12. Else ORA 4, RZ not taken 6,
// DCR 4, PUSH 12, CALL 18, INX 6, POP 10, CALL 18, INR 4, RET 10 = 92 T-states and 10 instructions.
// 127 calls with n > 0 and 128 with n = 0; LXI 10, MVI 7, CALL 18, HLT 5.
TEST_P(Runs, CountARecursion) {
    code({0x31, 0x00, 0x80, 0x3E, 0x07, 0xCD, 0x10, 0x00, 0x76});
    code({0xB7, 0xC8, 0x3D, 0xF5, 0xCD, 0x10, 0x00, 0x13, 0xF1, 0xCD, 0x10, 0x00, 0x3C, 0xC9},
         0x0010);
    EXPECT_EQ(run(kForever), RunEnd::halted);
    EXPECT_EQ(machine_.cpu.de(), 127);
    EXPECT_EQ(machine_.cpu.a, 7);
    EXPECT_EQ(machine_.cpu.sp, 0x8000);
    EXPECT_EQ(machine_.cpu.t, 10U + 7 + 18 + 5 + 127 * 92 + 128 * 16);
    EXPECT_EQ(machine_.cpu.instructions, 4U + 127 * 10 + 128 * 2);
}

// Moves 1000 bytes: LXI H, D, B (30); MOV A,M STAX D INX H INX D DCX B MOV A,B ORA C JNZ
// (7 + 7 + 6 + 6 + 6 + 4 + 4 + 10 = 50 a turn, 47 the last); HLT 5.
TEST_P(Runs, CountABlockMove) {
    code({0x21, 0x00, 0x10, 0x11, 0x00, 0x20, 0x01, 0xE8, 0x03, 0x7E,
          0x12, 0x23, 0x13, 0x0B, 0x78, 0xB1, 0xC2, 0x09, 0x00, 0x76});
    for (unsigned i = 0; i < 1000; ++i) {
        machine_.memory.bytes[0x1000 + i] = static_cast<uint8_t>(i * 7 + 1);
    }
    EXPECT_EQ(run(kForever), RunEnd::halted);
    for (unsigned i = 0; i < 1000; ++i) {
        ASSERT_EQ(machine_.memory.bytes[0x2000 + i], static_cast<uint8_t>(i * 7 + 1)) << i;
    }
    EXPECT_EQ(machine_.memory.bytes[0x2000 + 1000], 0);
    EXPECT_EQ(machine_.cpu.t, 30U + 50 * 1000 - 3 + 5);
    EXPECT_EQ(machine_.cpu.instructions, 3U + 8 * 1000 + 1);
}

// A program that writes the operand of its next instruction, and then that instruction's opcode.
TEST_P(Runs, ExecuteWhatHasJustBeenWritten) {
    code({0x3E, 0x42, 0x32, 0x06, 0x00, 0x06, 0x00,    // MVI A,42H; STA 6; MVI B,0 -> 42H
          0x3E, 0x04, 0x32, 0x0C, 0x00, 0x00, 0x76});  // MVI A,4; STA 0CH; NOP -> INR B; HLT
    EXPECT_EQ(run(kForever), RunEnd::halted);
    EXPECT_EQ(machine_.cpu.b, 0x43);
}

TEST_P(Runs, WrapAroundTheEndOfMemory) {
    machine_.cpu.pc = 0xFFFE;
    code({0x00, 0x3E}, 0xFFFE);  // NOP; MVI A,
    code({0x5A, 0x76});          // 5AH; HLT
    EXPECT_EQ(run(kForever), RunEnd::halted);
    EXPECT_EQ(machine_.cpu.a, 0x5A);
    EXPECT_EQ(machine_.cpu.pc, 0x0002);
}

TEST(Step, DoesNothingInHaltAndOutsideTheSet) {
    FlatMachine machine(InstructionSet::documented);
    machine.memory.bytes = {0x76, 0x08};
    StepRecord record;
    EXPECT_EQ(machine.step(record), RunEnd::halted) << "HLT has been executed";
    EXPECT_EQ(machine.cpu.t, 5U);
    CpuState before = machine.cpu;
    EXPECT_EQ(machine.step(record), RunEnd::halted);
    EXPECT_EQ(machine.cpu, before);
    machine.cpu.halted = false;
    before = machine.cpu;
    EXPECT_EQ(machine.step(record), RunEnd::undefined_instruction);
    EXPECT_EQ(machine.cpu, before);
}

TEST(Step, RecordsOneInstruction) {
    FlatMachine machine;
    machine.memory.bytes = {0x06, 0x12};
    StepRecord record;
    EXPECT_EQ(machine.step(record), RunEnd::time_limit);
    EXPECT_EQ(record.opcode(), 0x06);
    EXPECT_EQ(record.access_count, 2);
    EXPECT_EQ(record.t_end, 7U);
    machine.step(record);  // the same record again, for a NOP
    EXPECT_EQ(record.access_count, 1);
    EXPECT_EQ(record.t_begin, 7U);
    EXPECT_EQ(record.t_end, 11U);
}

// A machine is plain state: a copy is a snapshot.
TEST(FlatMachine, CopiesAreSnapshots) {
    FlatMachine machine;
    machine.memory.bytes = {0x3C, 0x32, 0x00, 0x40, 0xC3, 0x00, 0x00};  // INR A; STA; JMP 0
    machine.run(1000);
    FlatMachine copy = machine;
    machine.run(3000);
    EXPECT_NE(copy.cpu, machine.cpu);
    EXPECT_NE(copy.memory, machine.memory);
    copy.run(3000);
    EXPECT_EQ(copy.cpu, machine.cpu);
    EXPECT_EQ(copy.memory, machine.memory);
}

}  // namespace
