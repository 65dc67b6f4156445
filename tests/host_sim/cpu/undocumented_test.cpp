// undocumented_test.cpp - the ten instructions that Intel left out, case by case, by hand.
// Sources      W. Dehnhardt, V. Sorensen, "Unspecified 8085 op codes enhance programming",
//              Electronics, January 1979: effect, cycles, states, flags. K. Shirriff's die analysis
//              for V and K. Where cores that follow silicon disagree, the case says so.
// Flags        S Z K A(uxiliary carry) P V C, in the order of the flag byte.
#include <gtest/gtest.h>

#include "instruction_cases.hpp"

namespace {

using cpu_test::expect;

constexpr int kDsub = 0x08, kArhl = 0x10, kRdel = 0x18, kLdhi = 0x28, kLdsi = 0x38, kRstv = 0xCB,
              kShlx = 0xD9, kJnk = 0xDD, kLhlx = 0xED, kJk = 0xFD;

// HL - BC. CY, V and K are settled; S, P and AC (of the high byte) and Z (of all 16 bits) are the
// project's choice.
TEST(Dsub, SubtractsBcFromHl) {
    expect({kDsub}, {.bc = 0x1234, .hl = 0x5678, .flags = "C"},
           {.bc = 0x1234, .hl = 0x4444, .flags = "AP"});
    expect({kDsub}, {.bc = 0x0001, .hl = 0x0000, .flags = ""},
           {.bc = 0x0001, .hl = 0xFFFF, .flags = "SKPC"});
    expect({kDsub}, {.bc = 0x0001, .hl = 0x8000, .flags = ""},
           {.bc = 0x0001, .hl = 0x7FFF, .flags = "KV"});  // -32768 - 1: signed less, overflow
    expect({kDsub}, {.bc = 0xFFFF, .hl = 0x7FFF, .flags = ""},
           {.bc = 0xFFFF, .hl = 0x8000, .flags = "SAVC"});
    expect({kDsub}, {.bc = 0xABCD, .hl = 0xABCD, .flags = "SC"},
           {.bc = 0xABCD, .hl = 0x0000, .flags = "ZAP"});
    expect({kDsub}, {.bc = 0x00FF, .hl = 0x01FF, .flags = ""},
           {.bc = 0x00FF, .hl = 0x0100, .flags = "A"});
}

// Arithmetic shift: the sign stays, CY is the bit that left, no other flag.
TEST(Arhl, ShiftsHlRight) {
    expect({kArhl}, {.hl = 0x8003, .flags = "SZKAPV"}, {.hl = 0xC001, .flags = "SZKAPVC"});
    expect({kArhl}, {.hl = 0x4002, .flags = "C"}, {.hl = 0x2001, .flags = ""});
    expect({kArhl}, {.hl = 0xFFFF, .flags = ""}, {.hl = 0xFFFF, .flags = "C"});
    expect({kArhl}, {.hl = 0x0100, .flags = ""}, {.hl = 0x0080, .flags = ""});
}

// Rotate through CY; V tells that the sign has changed. The other flags, K too, stay.
TEST(Rdel, RotatesDeLeftThroughCarry) {
    expect({kRdel}, {.de = 0x8000, .flags = "SK"}, {.de = 0x0000, .flags = "SKVC"});
    expect({kRdel}, {.de = 0x4000, .flags = "C"}, {.de = 0x8001, .flags = "V"});
    expect({kRdel}, {.de = 0xC000, .flags = "ZAPVC"}, {.de = 0x8001, .flags = "ZAPC"});
    expect({kRdel}, {.de = 0x00FF, .flags = "V"}, {.de = 0x01FE, .flags = ""});
    expect({kRdel}, {.de = 0x4000, .flags = "K"}, {.de = 0x8000, .flags = "KV"});
}

TEST(Ldhi, AddsTheUnsignedByteToHl) {
    expect({kLdhi, 0xFF}, {.hl = 0x1234, .flags = "SZKAPVC"},
           {.de = 0x1333, .hl = 0x1234, .flags = "SZKAPVC"});
    expect({kLdhi, 0x10}, {.de = 0x5555, .hl = 0xFFF8, .flags = ""},
           {.de = 0x0008, .hl = 0xFFF8, .flags = ""});
}

TEST(Ldsi, AddsTheUnsignedByteToSp) {
    expect({kLdsi, 0xFF}, {.sp = 0x7F01, .flags = "SZKAPVC"},
           {.de = 0x8000, .sp = 0x7F01, .flags = "SZKAPVC"});
    expect({kLdsi, 0x10}, {.de = 0x5555, .sp = 0xFFF8, .flags = ""},
           {.de = 0x0008, .sp = 0xFFF8, .flags = ""});
}

// RST 40H if V. Interrupts stay as they are.
TEST(Rstv, CallsOnOverflow) {
    expect({kRstv}, {.flags = "SZKAPVC"}, {.sp = 0x7FFE, .pc = 0x0040, .flags = "SZKAPVC"});
    expect({kRstv}, {.flags = "SZKAPC"}, {.flags = "SZKAPC"});
}

TEST(Rstv, LeavesTheInterruptEnableAlone) {
    host_sim::FlatMachine machine;
    machine.cpu.t = 1000;
    machine.cpu.f = host_sim::flag::kV;
    machine.cpu.interrupt_enable = true;
    machine.memory.bytes[0] = kRstv;
    machine.run(1001);
    EXPECT_TRUE(machine.cpu.interrupt_enable);
    EXPECT_EQ(machine.cpu.pc, 0x0040);
    EXPECT_EQ(machine.memory.bytes[machine.cpu.sp], 1);
}

TEST(ShlxLhlx, MoveHlToAndFromWhereDePoints) {
    for (const bool fast : {false, true}) {
        host_sim::FlatMachine machine;
        machine.cpu.t = 1000;
        machine.cpu.h = 0x12, machine.cpu.l = 0x34;
        machine.cpu.d = machine.cpu.e = 0xFF;  // the second byte is at 0000H, behind FFFFH
        machine.cpu.pc = 0x0100;
        machine.cpu.f = 0xD7;
        machine.memory.bytes[0x0100] = kShlx;
        machine.memory.bytes[0x0101] = 0x21;  // LXI H
        machine.memory.bytes[0x0104] = kLhlx;
        const auto run_to = [&](uint64_t t) { fast ? machine.run(t) : machine.run_reference(t); };
        run_to(1001);
        EXPECT_EQ(machine.cpu.t, 1010U);
        EXPECT_EQ(machine.memory.bytes[0xFFFF], 0x34);
        EXPECT_EQ(machine.memory.bytes[0x0000], 0x12);
        run_to(1011);
        EXPECT_EQ(machine.cpu.hl(), 0x0000);
        run_to(1021);
        EXPECT_EQ(machine.cpu.hl(), 0x1234);
        EXPECT_EQ(machine.cpu.t, 1030U);
        EXPECT_EQ(machine.cpu.f, 0xD7);
    }
}

TEST(JumpsOnK, LookAtK) {
    expect({kJk, 0x34, 0x12}, {.flags = "K"}, {.pc = 0x1234, .flags = "K"});
    expect({kJk, 0x34, 0x12}, {.flags = "SZAPVC"}, {.flags = "SZAPVC"});
    expect({kJnk, 0x34, 0x12}, {.flags = "SZAPVC"}, {.pc = 0x1234, .flags = "SZAPVC"});
    expect({kJnk, 0x34, 0x12}, {.flags = "K"}, {.flags = "K"});
}

/// A, then `first`, then JK over an STC: CY afterwards tells that the jump was not taken.
bool jumps_on_k_after(int first, int a, int b, bool fast) {
    host_sim::FlatMachine machine;
    machine.cpu.t = 1000;
    machine.cpu.a = static_cast<uint8_t>(a), machine.cpu.b = static_cast<uint8_t>(b);
    machine.memory.bytes[0] = static_cast<uint8_t>(first);
    machine.memory.bytes[1] = kJk;
    machine.memory.bytes[2] = 0x80;
    const uint64_t end = machine.cpu.t + 4 + 7;
    fast ? machine.run(end) : machine.run_reference(end);
    return machine.cpu.pc == 0x80;
}

// What K is good for: behind CMP it is the signed "less than", for all operands.
TEST(JumpsOnK, IsSignedLessBehindCompare) {
    for (int a = -128; a < 128; ++a) {
        for (int b = -128; b < 128; ++b) {
            for (const bool fast : {false, true}) {
                ASSERT_EQ(jumps_on_k_after(0xB8, a, b, fast), a < b) << a << " " << b;
            }
        }
    }
}

// ... and behind DCX the end of a 16-bit loop: BC = n makes n + 1 turns.
TEST(JumpsOnK, EndsALoopBehindDcx) {
    for (const int count : {0, 1, 255, 256, 1000}) {
        for (const bool fast : {false, true}) {
            host_sim::FlatMachine machine;
            machine.cpu.t = 1000;
            machine.cpu.b = static_cast<uint8_t>(count >> 8);
            machine.cpu.c = static_cast<uint8_t>(count);
            machine.memory.bytes = {0x13, 0x0B, kJnk, 0x00, 0x00, 0x76};  // INX D; DCX B; JNK; HLT
            fast ? machine.run(UINT64_MAX) : machine.run_reference(UINT64_MAX);
            EXPECT_EQ(machine.cpu.de(), count + 1);
            EXPECT_EQ(machine.cpu.bc(), 0xFFFF);
            // Turns of 6 + 6 + 10 T-states, the last of 6 + 6 + 7, HLT 5.
            EXPECT_EQ(machine.cpu.t - 1000, 22U * static_cast<unsigned>(count) + 19 + 5);
        }
    }
}

}  // namespace
