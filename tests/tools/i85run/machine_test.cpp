// machine_test.cpp - traps cost nothing, protected memory keeps its bytes, both ways to run agree.
#include "tools/i85run/machine.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <initializer_list>

namespace {

using host_sim::InstructionSet;
using host_sim::StepRecord;
using i85run::Machine;
using i85run::Stop;

void load(Machine& machine, uint16_t address, std::initializer_list<uint8_t> bytes) {
    std::ranges::copy(bytes, machine.memory.bytes.begin() + address);
}

TEST(I85runMachine, StopsInFrontOfATrapWithoutCountingIt) {
    Machine machine;
    load(machine, 0, {0x00, 0xC3, 0x00, 0x20});  // NOP (4 T); JMP 2000h (10 T)
    machine.add_trap(0x2000);
    EXPECT_EQ(machine.run(1000), Stop::trap);
    EXPECT_EQ(machine.cpu.pc, 0x2000);
    EXPECT_EQ(machine.cpu.instructions, 2u);
    EXPECT_EQ(machine.cpu.t, 14u);
    EXPECT_EQ(machine.run(1000), Stop::trap) << "and stays there";
    StepRecord record;
    EXPECT_EQ(machine.step(record), Stop::trap);
    EXPECT_EQ(machine.cpu.t, 14u);
}

TEST(I85runMachine, ATrapIsSeenBeforeTheTimeLimit) {
    Machine machine;
    load(machine, 0, {0x00, 0xC3, 0x00, 0x20});
    machine.add_trap(0x2000);
    EXPECT_EQ(machine.run(14), Stop::trap);
}

TEST(I85runMachine, AHltElsewhereIsAHlt) {
    Machine machine;
    load(machine, 0, {0x00, 0x76});  // NOP (4 T); HLT (5 T)
    machine.add_trap(0x2000);
    EXPECT_EQ(machine.run(1000), Stop::halted);
    EXPECT_EQ(machine.cpu.t, 9u);
    EXPECT_EQ(machine.cpu.instructions, 2u);
}

TEST(I85runMachine, AnOverwrittenTrapIsPlainMemory) {
    Machine machine;
    // MVI A,0 (7); STA 2000h (13): NOP over the trap; JMP 2000h (10); there NOP (4), HLT (5)
    load(machine, 0, {0x3E, 0x00, 0x32, 0x00, 0x20, 0xC3, 0x00, 0x20});
    machine.add_trap(0x2000);
    load(machine, 0x2001, {0x76});
    EXPECT_EQ(machine.run(1000), Stop::halted);
    EXPECT_EQ(machine.cpu.t, 39u);
}

TEST(I85runMachine, ExecuteInsteadChargesTheReplacementAndRestoresTheByte) {
    Machine machine;
    machine.add_trap(0x0005);
    load(machine, 0x3000, {0x34, 0x12});
    machine.cpu.pc = 0x0005;
    machine.cpu.sp = 0x3000;
    StepRecord record;
    machine.execute_instead(0xC9, record);  // RET: 10 T
    EXPECT_EQ(machine.cpu.pc, 0x1234);
    EXPECT_EQ(machine.cpu.sp, 0x3002);
    EXPECT_EQ(machine.cpu.t, 10u);
    EXPECT_EQ(machine.cpu.instructions, 1u);
    EXPECT_EQ(machine.memory.bytes[5], 0x76);
    EXPECT_EQ(record.opcode(), 0xC9);
}

// MVI A,55h (7 T); STA nn (13); STA nn (13); HLT (5): 38 T
void load_two_stores(Machine& machine, uint16_t first, uint16_t second) {
    const auto low = [](uint16_t word) { return static_cast<uint8_t>(word); };
    const auto high = [](uint16_t word) { return static_cast<uint8_t>(word >> 8); };
    load(machine, 0,
         {0x3E, 0x55, 0x32, low(first), high(first), 0x32, low(second), high(second), 0x76});
}

TEST(I85runMachine, ProtectedBytesStayAndTheWriteIsNoted) {
    Machine machine;
    load_two_stores(machine, 0x1234, 0x12FF);  // one page: the range ends between the two
    machine.protect({0x1000, 0x1280}, false);
    EXPECT_EQ(machine.run(1000), Stop::halted);
    EXPECT_EQ(machine.cpu.t, 38u);
    EXPECT_EQ(machine.memory.bytes[0x1234], 0x00);
    EXPECT_EQ(machine.memory.bytes[0x12FF], 0x55);
    EXPECT_EQ(machine.rom_write_count(), 1u);
    ASSERT_TRUE(machine.first_rom_write());
    EXPECT_EQ(machine.first_rom_write()->pc, 2);
    EXPECT_EQ(machine.first_rom_write()->t, 20u);
    EXPECT_EQ(machine.first_rom_write()->address, 0x1234);
    EXPECT_EQ(machine.first_rom_write()->value, 0x55);
}

TEST(I85runMachine, BothEndsOfTheRangeAreProtected) {
    Machine machine;
    load_two_stores(machine, 0x1000, 0xFFFF);
    machine.protect({0x1000, 0xFFFF}, false);
    EXPECT_EQ(machine.run(1000), Stop::halted);
    EXPECT_EQ(machine.rom_write_count(), 2u);
    EXPECT_EQ(machine.first_rom_write()->address, 0x1000);
}

TEST(I85runMachine, StrictStopsBehindTheFirstWrite) {
    for (const bool observed : {false, true}) {
        Machine machine;
        load_two_stores(machine, 0x1234, 0x1235);
        machine.protect({0x1000, 0x1FFF}, true);
        StepRecord record;
        Stop stop = Stop::time_limit;
        while (observed && stop == Stop::time_limit) stop = machine.step(record);
        if (!observed) stop = machine.run(1000);
        EXPECT_EQ(stop, Stop::rom_write);
        EXPECT_EQ(machine.cpu.pc, 5);
        EXPECT_EQ(machine.rom_write_count(), 1u);
    }
}

TEST(I85runMachine, DocumentedSetStopsAtAnUndocumentedInstruction) {
    for (const bool observed : {false, true}) {
        Machine machine(InstructionSet::documented);
        load(machine, 0, {0x00, 0x08});  // NOP; DSUB
        StepRecord record;
        Stop stop = Stop::time_limit;
        while (observed && stop == Stop::time_limit) stop = machine.step(record);
        if (!observed) stop = machine.run(1000);
        EXPECT_EQ(stop, Stop::undefined_instruction);
        EXPECT_EQ(machine.cpu.pc, 1);
        EXPECT_EQ(machine.cpu.instructions, 1u);
    }
}

TEST(I85runMachine, StepsAndRunReachTheSameState) {
    // LXI SP,4000h; LXI B,1234h; loop: PUSH B; POP H; INX B; EI; DI; MOV A,B; ORA C; JNZ loop; HLT
    const auto fill = [](Machine& machine) {
        load(machine, 0,
             {0x31, 0x00, 0x40, 0x01, 0x34, 0xF2, 0xC5, 0xE1, 0x03, 0xFB, 0xF3, 0x78, 0xB1, 0xC2,
              0x06, 0x00, 0x76});
        machine.protect({0x0000, 0x00FF}, false);
    };
    Machine fast, stepped;
    fill(fast);
    fill(stepped);
    EXPECT_EQ(fast.run(100'000'000), Stop::halted);
    StepRecord record;
    Stop stop = Stop::time_limit;
    while (stop == Stop::time_limit) stop = stepped.step(record);
    EXPECT_EQ(stop, Stop::halted);
    EXPECT_EQ(fast.cpu, stepped.cpu);
    EXPECT_EQ(fast.memory, stepped.memory);
}

}  // namespace
