// recording_bus_test.cpp - order, address and T-state of every bus cycle, as a RecordingBus sees
// them, for each kind of instruction and for interrupts.
// Source       Intel MCS-80/85 Family User's Manual: machine cycles of the instruction set (cycles,
//              states, and what each cycle carries), and 8085AH data sheet, "Basic System Timing":
//              a fetch has 4 or 6 T-states, all else 3, and data is transferred by the end of T3.
//              The undocumented ones: Dehnhardt and Sorensen's table gives cycles and states.
// Notation     kind address[=value written or input]@T-state of its end, counted from the
//              instruction's begin. F fetch, O operand, R read, W write, I in, X out, A
//              acknowledge.
#include "host_sim/cpu/recording_bus.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "scripted_machine.hpp"

namespace {

using cpu_test::ScriptedMachine;
using host_sim::BusAccess;
using host_sim::Pin;
using host_sim::StepRecord;

/// BC 2010, DE 3010, HL 4010, SP 8000, A A1; flags and code by the case, at 0100.
struct Bench : ScriptedMachine {
    explicit Bench(std::initializer_list<int> code, int flags = 0) {
        cpu.a = 0xA1, cpu.f = static_cast<uint8_t>(flags);
        cpu.b = 0x20, cpu.d = 0x30, cpu.h = 0x40;
        cpu.c = cpu.e = cpu.l = 0x10;
        cpu.sp = 0x8000;
        cpu.pc = 0x0100;
        cpu.t = 1000;
        put(0x0100, code);
        put(0x2010, {0xB7, 0xB8});
        put(0x3010, {0xD7, 0xD8});
        put(0x4010, {0x57, 0x58});
        put(0x5678, {0x67, 0x68});
        put(0x8000, {0x99, 0x9A});
    }
};

std::string text(const StepRecord& record) {
    std::string result;
    for (unsigned i = 0; i < record.access_count; ++i) {
        const BusAccess& access = record.accesses[i];
        const bool with_value = access.kind == BusAccess::Kind::write ||
                                access.kind == BusAccess::Kind::out ||
                                access.kind == BusAccess::Kind::acknowledge;
        result +=
            fmt::format("{}{:04X}", "FORWIXA"[static_cast<unsigned>(access.kind)], access.address);
        if (with_value) result += fmt::format("={:02X}", access.value);
        result += fmt::format("@{} ", access.t - record.t_begin);
    }
    return result + fmt::format("T{}", record.t_end - record.t_begin);
}

std::string cycles(std::initializer_list<int> code, int flags = 0) {
    return text(Bench(code, flags).step());
}

constexpr int kZ = 0x40, kCy = 0x01, kK = 0x20, kV = 0x02;

TEST(BusCycles, OfOneFetch) {
    EXPECT_EQ(cycles({0x00}), "F0100@3 T4");  // NOP
    EXPECT_EQ(cycles({0x41}), "F0100@3 T4");  // MOV B,C
    EXPECT_EQ(cycles({0x80}), "F0100@3 T4");  // ADD B
    EXPECT_EQ(cycles({0x3C}), "F0100@3 T4");  // INR A
    EXPECT_EQ(cycles({0x07}), "F0100@3 T4");  // RLC
    EXPECT_EQ(cycles({0xEB}), "F0100@3 T4");  // XCHG
    EXPECT_EQ(cycles({0x20}), "F0100@3 T4");  // RIM
    EXPECT_EQ(cycles({0x30}), "F0100@3 T4");  // SIM
    EXPECT_EQ(cycles({0xFB}), "F0100@3 T4");  // EI
}

TEST(BusCycles, OfOneFetchOfSixTStates) {
    EXPECT_EQ(cycles({0x03}), "F0100@3 T6");  // INX B
    EXPECT_EQ(cycles({0x3B}), "F0100@3 T6");  // DCX SP
    EXPECT_EQ(cycles({0xE9}), "F0100@3 T6");  // PCHL
    EXPECT_EQ(cycles({0xF9}), "F0100@3 T6");  // SPHL
}

TEST(BusCycles, OfAFetchAndBusIdle) {
    EXPECT_EQ(cycles({0x76}), "F0100@3 T5");   // HLT
    EXPECT_EQ(cycles({0x09}), "F0100@3 T10");  // DAD B
    EXPECT_EQ(cycles({0x08}), "F0100@3 T10");  // DSUB
    EXPECT_EQ(cycles({0x10}), "F0100@3 T7");   // ARHL
    EXPECT_EQ(cycles({0x18}), "F0100@3 T10");  // RDEL
}

TEST(BusCycles, OfMemoryOperands) {
    EXPECT_EQ(cycles({0x46}), "F0100@3 R4010@7 T7");               // MOV B,M
    EXPECT_EQ(cycles({0x77}), "F0100@3 W4010=A1@7 T7");            // MOV M,A
    EXPECT_EQ(cycles({0x86}), "F0100@3 R4010@7 T7");               // ADD M
    EXPECT_EQ(cycles({0x0A}), "F0100@3 R2010@7 T7");               // LDAX B
    EXPECT_EQ(cycles({0x12}), "F0100@3 W3010=A1@7 T7");            // STAX D
    EXPECT_EQ(cycles({0x34}), "F0100@3 R4010@7 W4010=58@10 T10");  // INR M
    EXPECT_EQ(cycles({0x35}), "F0100@3 R4010@7 W4010=56@10 T10");  // DCR M
}

TEST(BusCycles, OfImmediateOperands) {
    EXPECT_EQ(cycles({0x06, 0x12}), "F0100@3 O0101@7 T7");                  // MVI B
    EXPECT_EQ(cycles({0x36, 0x12}), "F0100@3 O0101@7 W4010=12@10 T10");     // MVI M
    EXPECT_EQ(cycles({0xC6, 0x12}), "F0100@3 O0101@7 T7");                  // ADI
    EXPECT_EQ(cycles({0x21, 0x78, 0x56}), "F0100@3 O0101@7 O0102@10 T10");  // LXI H
    EXPECT_EQ(cycles({0xDB, 0x12}), "F0100@3 O0101@7 I0012@10 T10");        // IN
    EXPECT_EQ(cycles({0xD3, 0x12}), "F0100@3 O0101@7 X0012=A1@10 T10");     // OUT
    EXPECT_EQ(cycles({0x28, 0x12}), "F0100@3 O0101@7 T10");                 // LDHI
    EXPECT_EQ(cycles({0x38, 0x12}), "F0100@3 O0101@7 T10");                 // LDSI
}

TEST(BusCycles, OfDirectAddresses) {
    EXPECT_EQ(cycles({0x3A, 0x78, 0x56}), "F0100@3 O0101@7 O0102@10 R5678@13 T13");     // LDA
    EXPECT_EQ(cycles({0x32, 0x78, 0x56}), "F0100@3 O0101@7 O0102@10 W5678=A1@13 T13");  // STA
    EXPECT_EQ(cycles({0x2A, 0x78, 0x56}),
              "F0100@3 O0101@7 O0102@10 R5678@13 R5679@16 T16");  // LHLD
    EXPECT_EQ(cycles({0x22, 0x78, 0x56}),
              "F0100@3 O0101@7 O0102@10 W5678=10@13 W5679=40@16 T16");  // SHLD: L first
    EXPECT_EQ(cycles({0xD9}), "F0100@3 W3010=10@7 W3011=40@10 T10");    // SHLX
    EXPECT_EQ(cycles({0xED}), "F0100@3 R3010@7 R3011@10 T10");          // LHLX
}

// The high byte is pushed first, at SP - 1.
TEST(BusCycles, OfTheStack) {
    EXPECT_EQ(cycles({0xC5}), "F0100@3 W7FFF=20@9 W7FFE=10@12 T12");        // PUSH B
    EXPECT_EQ(cycles({0xF5}, 0x85), "F0100@3 W7FFF=A1@9 W7FFE=85@12 T12");  // PUSH PSW
    EXPECT_EQ(cycles({0xC1}), "F0100@3 R8000@7 R8001@10 T10");              // POP B
    EXPECT_EQ(cycles({0xE3}),
              "F0100@3 R8000@7 R8001@10 W8001=40@13 W8000=10@16 T16");  // XTHL
}

TEST(BusCycles, OfJumps) {
    EXPECT_EQ(cycles({0xC3, 0x78, 0x56}), "F0100@3 O0101@7 O0102@10 T10");      // JMP
    EXPECT_EQ(cycles({0xCA, 0x78, 0x56}, kZ), "F0100@3 O0101@7 O0102@10 T10");  // JZ taken
    EXPECT_EQ(cycles({0xCA, 0x78, 0x56}), "F0100@3 O0101@7 T7");  // not taken: low byte only
    EXPECT_EQ(cycles({0xFD, 0x78, 0x56}, kK), "F0100@3 O0101@7 O0102@10 T10");  // JK
    EXPECT_EQ(cycles({0xFD, 0x78, 0x56}), "F0100@3 O0101@7 T7");
    EXPECT_EQ(cycles({0xDD, 0x78, 0x56}), "F0100@3 O0101@7 O0102@10 T10");  // JNK
    EXPECT_EQ(cycles({0xDD, 0x78, 0x56}, kK), "F0100@3 O0101@7 T7");
}

TEST(BusCycles, OfCallsAndRestarts) {
    const std::string called = "F0100@3 O0101@9 O0102@12 W7FFF=01@15 W7FFE=03@18 T18";
    EXPECT_EQ(cycles({0xCD, 0x78, 0x56}), called);                        // CALL
    EXPECT_EQ(cycles({0xDC, 0x78, 0x56}, kCy), called);                   // CC taken
    EXPECT_EQ(cycles({0xDC, 0x78, 0x56}), "F0100@3 O0101@9 T9");          // not taken
    EXPECT_EQ(cycles({0xEF}), "F0100@3 W7FFF=01@9 W7FFE=01@12 T12");      // RST 5
    EXPECT_EQ(cycles({0xCB}, kV), "F0100@3 W7FFF=01@9 W7FFE=01@12 T12");  // RSTV
    EXPECT_EQ(cycles({0xCB}), "F0100@3 T6");
}

TEST(BusCycles, OfReturns) {
    EXPECT_EQ(cycles({0xC9}), "F0100@3 R8000@7 R8001@10 T10");      // RET
    EXPECT_EQ(cycles({0xC8}, kZ), "F0100@3 R8000@9 R8001@12 T12");  // RZ taken
    EXPECT_EQ(cycles({0xC8}), "F0100@3 T6");
}

// Sequential addresses wrap: the operand of an instruction at FFFF is at 0000, and so on.
TEST(BusCycles, WrapAroundTheAddressSpace) {
    Bench code_end({});
    code_end.cpu.pc = 0xFFFF;
    code_end.put(0xFFFF, {0xCD});
    code_end.put(0x0000, {0x78, 0x56});
    EXPECT_EQ(text(code_end.step()), "FFFFF@3 O0000@9 O0001@12 W7FFF=00@15 W7FFE=02@18 T18");

    Bench stack_end({0xE3});
    stack_end.cpu.sp = 0xFFFF;
    EXPECT_EQ(text(stack_end.step()), "F0100@3 RFFFF@7 R0000@10 W0000=40@13 WFFFF=10@16 T16");

    Bench stack_begin({0xC5});
    stack_begin.cpu.sp = 0x0001;
    EXPECT_EQ(text(stack_begin.step()), "F0100@3 W0000=20@9 WFFFF=10@12 T12");

    EXPECT_EQ(cycles({0x22, 0xFF, 0xFF}), "F0100@3 O0101@7 O0102@10 WFFFF=10@13 W0000=40@16 T16");
}

// A bus-idle cycle of 6 T-states (RST n.5, TRAP) or INTA, then the two writes.
TEST(BusCycles, OfInterrupts) {
    for (const Pin pin : {Pin::trap, Pin::rst75, Pin::rst65, Pin::rst55}) {
        Bench bench({0x00});
        bench.cpu.interrupt_enable = true;
        bench.cpu.masks = 0;
        host_sim::set_pin(bench.cpu, pin, true, 900);
        EXPECT_EQ(text(bench.step()), "W7FFF=01@9 W7FFE=00@12 T12");
    }
}

TEST(BusCycles, OfInterruptAcknowledge) {
    Bench restart({0x00});
    restart.acknowledge_bytes = {0xD7};
    restart.cpu.interrupt_enable = true;
    host_sim::set_pin(restart.cpu, Pin::intr, true, 900);
    EXPECT_EQ(text(restart.step()), "A0000=D7@3 W7FFF=01@9 W7FFE=00@12 T12");

    Bench call({0x00});
    call.acknowledge_bytes = {0xCD, 0x78, 0x56};
    call.cpu.interrupt_enable = true;
    host_sim::set_pin(call.cpu, Pin::intr, true, 900);
    EXPECT_EQ(text(call.step()), "A0000=CD@3 A0000=78@9 A0000=56@12 W7FFF=01@15 W7FFE=00@18 T18");
}

// -- The record around the cycles
// ------------------------------------------------------------------

TEST(StepRecord, TellsRegistersAndTimesOfAnInstruction) {
    Bench bench({0xCD, 0x78, 0x56});
    const StepRecord record = bench.step();
    EXPECT_EQ(record.kind, StepRecord::Kind::instruction);
    EXPECT_EQ(record.opcode(), 0xCD);
    EXPECT_EQ(record.pc, 0x0100);
    EXPECT_EQ(record.next_pc, 0x5678);
    EXPECT_EQ(record.sp, 0x8000);
    EXPECT_EQ(record.next_sp, 0x7FFE);
    EXPECT_EQ(record.t_begin, 1000U);
    EXPECT_EQ(record.t_end, 1018U);
}

TEST(StepRecord, HasTheReturnAddressOfAnInterrupt) {
    Bench bench({0x00});
    host_sim::set_pin(bench.cpu, Pin::trap, true, 900);
    const StepRecord record = bench.step();
    EXPECT_EQ(record.kind, StepRecord::Kind::trap);
    EXPECT_EQ(record.pc, 0x0100);
    EXPECT_EQ(record.next_pc, 0x0024);
}

TEST(StepRecord, NamesEveryInterrupt) {
    using host_sim::Interrupt;
    using host_sim::record_kind;
    EXPECT_EQ(record_kind(Interrupt::none), StepRecord::Kind::instruction);
    EXPECT_EQ(record_kind(Interrupt::trap), StepRecord::Kind::trap);
    EXPECT_EQ(record_kind(Interrupt::rst75), StepRecord::Kind::rst75);
    EXPECT_EQ(record_kind(Interrupt::rst65), StepRecord::Kind::rst65);
    EXPECT_EQ(record_kind(Interrupt::rst55), StepRecord::Kind::rst55);
    EXPECT_EQ(record_kind(Interrupt::intr), StepRecord::Kind::intr);
}

}  // namespace
