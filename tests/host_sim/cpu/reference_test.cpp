// reference_test.cpp - the parts that the reference interpreter is put together from: machine
// cycles with their time and order, and the switch that refuses. What instructions do is
// vectors_test's. Source       Intel 8085AH data sheet, "Basic System Timing": 3 T-states a cycle
// behind the fetch.
#include "host_sim/cpu/reference.hpp"

#include <gtest/gtest.h>

#include "host_sim/cpu/flat_bus.hpp"
#include "host_sim/cpu/flat_memory.hpp"
#include "host_sim/cpu/reference_operations.hpp"
#include "host_sim/cpu/reference_table.hpp"

namespace {

using host_sim::CpuState;
using host_sim::FlatBus;
using host_sim::InstructionSet;

struct Bench {
    CpuState cpu;
    host_sim::FlatMemory memory = host_sim::all_ram();
    FlatBus bus{memory};
    host_sim::reference::Operations<FlatBus> operations{cpu, bus, 100};
};

TEST(ReferenceOperations, EveryMachineCycleTakesThreeTStates) {
    Bench bench;
    bench.memory.bytes = {0x34, 0x12};
    EXPECT_EQ(bench.operations.operand_word(), 0x1234) << "low byte first";
    EXPECT_EQ(bench.cpu.pc, 2);
    EXPECT_EQ(bench.operations.t, 106U);
    bench.operations.store(0x4000, 0x5A);
    EXPECT_EQ(bench.operations.load(0x4000), 0x5A);
    EXPECT_EQ(bench.operations.t, 112U);
}

TEST(ReferenceOperations, WordsAndStackWrapAround) {
    Bench bench;
    bench.operations.store_word(0xFFFF, 0x78, 0x56);
    EXPECT_EQ(bench.memory.bytes[0xFFFF], 0x78);
    EXPECT_EQ(bench.memory.bytes[0x0000], 0x56);
    EXPECT_EQ(bench.operations.load_word(0xFFFF), 0x5678);
    bench.cpu.sp = 0x0001;
    bench.operations.push(0x12, 0x34);
    EXPECT_EQ(bench.cpu.sp, 0xFFFF);
    EXPECT_EQ(bench.memory.bytes[0x0000], 0x12);
    EXPECT_EQ(bench.operations.pop(), 0x1234);
    EXPECT_EQ(bench.cpu.sp, 0x0001);
}

TEST(ReferenceTable, RefusesTheTenWithNothingChanged) {
    for (const uint8_t opcode :
         {uint8_t{0x08}, uint8_t{0x10}, uint8_t{0x18}, uint8_t{0x28}, uint8_t{0x38}, uint8_t{0xCB},
          uint8_t{0xD9}, uint8_t{0xDD}, uint8_t{0xED}, uint8_t{0xFD}}) {
        Bench bench;
        bench.cpu.f = 0xF7;
        const CpuState before = bench.cpu;
        EXPECT_FALSE(
            host_sim::reference::dispatch(bench.operations, opcode, InstructionSet::documented));
        EXPECT_EQ(bench.cpu, before);
        EXPECT_EQ(bench.operations.t, 100U);
        EXPECT_TRUE(host_sim::reference::dispatch(bench.operations, opcode, InstructionSet::all));
    }
}

// Whether it is executed or not, time and count tell: a refused instruction never happened.
TEST(Reference, CountsWhatItExecutes) {
    Bench bench;
    bench.memory.bytes = {0x00, 0x08};
    host_sim::Reference<FlatBus> reference(bench.cpu, bench.bus, InstructionSet::documented);
    EXPECT_TRUE(reference.execute());
    EXPECT_EQ(bench.cpu.t, 4U);
    EXPECT_EQ(bench.cpu.instructions, 1U);
    const CpuState before = bench.cpu;
    EXPECT_FALSE(reference.execute());
    EXPECT_EQ(bench.cpu, before);
}

}  // namespace
