// execution_trace_test.cpp - the lines of a trace, by hand.
#include "host_sim/trace/execution_trace.hpp"

#include <gtest/gtest.h>

#include <sstream>

#include "steps.hpp"

namespace {

using host_sim::BusAccess;
using host_sim::CpuState;
using host_sim::ExecutionTrace;
using host_sim::ExecutionTraceOptions;
using host_sim::StepRecord;
using host_sim::Symbols;
using trace_test::add_access;
using trace_test::instruction;

CpuState state() {
    CpuState cpu;
    cpu.a = 0x5A;
    cpu.f = host_sim::flag::kZero | host_sim::flag::kCarry;
    cpu.b = 0x12;
    cpu.c = 0x34;
    cpu.d = 0xAB;
    cpu.e = 0xCD;
    cpu.h = 0x80;
    cpu.l = 0x01;
    cpu.sp = 0x9000;
    return cpu;
}

std::string line_of(const StepRecord& step, const ExecutionTraceOptions& options = {}) {
    std::ostringstream out;
    ExecutionTrace trace(out, options);
    trace.observe(step, state());
    return out.str();
}

const std::string kRegisters = " A=5A .Z....C BC=1234 DE=ABCD HL=8001 SP=9000";

TEST(ExecutionTrace, AnInstructionIsOneLine) {
    StepRecord store = instruction(0x0100, {0x32, 0x01, 0x80}, 1234, 13);
    add_access(store, BusAccess::Kind::write, 0x8001, 0x5A);
    EXPECT_EQ(line_of(store),
              "        1234 0100                      32 01 80  STA 8001H           " + kRegisters +
                  " W 8001=5A\n");
}

TEST(ExecutionTrace, PortsAndReadsAreShown) {
    StepRecord in = instruction(0x0100, {0xDB, 0x08}, 0, 10);
    add_access(in, BusAccess::Kind::in, 0x08, 0x7F);
    EXPECT_TRUE(line_of(in).ends_with(kRegisters + " IN 08=7F\n"));
    StepRecord out = instruction(0x0100, {0xD3, 0x09}, 0, 10);
    add_access(out, BusAccess::Kind::out, 0x09, 0x5A);
    EXPECT_TRUE(line_of(out).ends_with(kRegisters + " OUT 09=5A\n"));
    StepRecord pop = instruction(0x0100, {0xC1}, 0, 10);
    add_access(pop, BusAccess::Kind::read, 0x9000, 0x34);
    add_access(pop, BusAccess::Kind::read, 0x9001, 0x12);
    EXPECT_TRUE(line_of(pop).ends_with(kRegisters + " R 9000=34 R 9001=12\n"));
}

TEST(ExecutionTrace, SymbolsNamePlacesAndOperands) {
    const Symbols symbols =
        host_sim::read_symbols("0100 0010 F main\n0200 0010 F drive\n", "a.sym");
    ExecutionTraceOptions options;
    options.symbols = &symbols;
    EXPECT_EQ(line_of(instruction(0x0103, {0xCD, 0x00, 0x02}, 7, 18), options),
              "           7 0103 main+3               CD 00 02  CALL drive          " + kRegisters +
                  "\n");
}

TEST(ExecutionTrace, AnOperandThatWasNotReadIsPeekedOrAQuestionMark) {
    // JNZ not taken reads only the low byte of its address.
    StepRecord jump = instruction(0x0100, {0xC2, 0x34}, 0, 7);
    jump.next_pc = 0x0103;
    EXPECT_NE(line_of(jump).find("C2 34     JNZ ?  "), std::string::npos) << line_of(jump);
    ExecutionTraceOptions options;
    options.peek = [](uint16_t address) {
        return static_cast<uint8_t>(address == 0x0102 ? 0x12 : 0);
    };
    EXPECT_NE(line_of(jump, options).find("C2 34 12  JNZ 1234H  "), std::string::npos);
}

TEST(ExecutionTrace, InterruptsAndHaltAreLinesOfTheirOwn) {
    StepRecord trap;
    trap.kind = StepRecord::Kind::trap;
    trap.pc = 0x0123;
    trap.next_pc = 0x0024;
    trap.t_end = 12;
    add_access(trap, BusAccess::Kind::write, 0x8FFF, 0x01);
    add_access(trap, BusAccess::Kind::write, 0x8FFE, 0x23);
    EXPECT_EQ(line_of(trap),
              "           0 0123                                -- TRAP to 0024     " + kRegisters +
                  " W 8FFF=01 W 8FFE=23\n");
    StepRecord intr;
    intr.kind = StepRecord::Kind::intr;
    intr.pc = 0x0123;
    intr.next_pc = 0x0038;
    add_access(intr, BusAccess::Kind::acknowledge, 0x0123, 0xFF);
    EXPECT_NE(line_of(intr).find("FF        -- INTR RST 7 to 0038"), std::string::npos);
    StepRecord halt;
    halt.kind = StepRecord::Kind::halt;
    halt.pc = 0x0124;
    halt.t_begin = 100;
    halt.t_end = 350;
    EXPECT_EQ(line_of(halt),
              "         100 0124                                -- halted for 250 T\n");
}

TEST(ExecutionTrace, RangesOfAddressesAndTimeSelect) {
    std::ostringstream out;
    ExecutionTraceOptions options;
    options.addresses = {0x0101, 0x0102};
    options.t_first = 8;
    options.t_last = 16;
    ExecutionTrace trace(out, options);
    for (unsigned i = 0; i < 8; ++i) {
        trace.observe(instruction(0x0100 + i % 4, {0x00}, i * 4, 4), state());
    }
    // T 0 4 8 12 16 20 24 28 at 0100 0101 0102 0103 0100 0101 0102 0103: only T 8 is in both.
    EXPECT_EQ(trace.line_count(), 1u);
    EXPECT_EQ(out.str().substr(0, 17), "           8 0102");
}

TEST(ExecutionTrace, UndocumentedOpcodesCanBeBytes) {
    ExecutionTraceOptions options;
    options.documented_only = true;
    EXPECT_NE(line_of(instruction(0, {0x08}, 0, 10)).find(" DSUB "), std::string::npos);
    EXPECT_NE(line_of(instruction(0, {0x08}, 0, 10), options).find(" DB 08H "), std::string::npos);
}

TEST(ExecutionTrace, AStreamThatTakesNoMoreIsAnError) {
    std::ostringstream out;
    ExecutionTrace trace(out, {});
    out.setstate(std::ios::badbit);
    EXPECT_THROW(trace.observe(instruction(0, {0x00}, 0, 4), state()), std::runtime_error);
}

}  // namespace
