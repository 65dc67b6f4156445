// rim_sim_test.cpp - RIM and SIM: every bit, its enable, and what neither touches.
// Data sheet   Intel 8085AH (1987), "Interrupt and Serial I/O".
// Manual       Intel MCS-80/85 Family User's Manual: RIM and SIM with the figures of the
// accumulator
//              after RIM and before SIM.
#include <gtest/gtest.h>

#include <string>

#include "scripted_machine.hpp"

namespace {

using cpu_test::Output;
using cpu_test::ScriptedMachine;
using host_sim::Pin;
using Kind = host_sim::StepRecord::Kind;

constexpr int kNop = 0x00, kRim = 0x20, kSim = 0x30, kDi = 0xF3, kEi = 0xFB;
constexpr uint16_t kCode = 0x0100;

struct Bench : ScriptedMachine {
    Bench() {
        cpu.pc = kCode;
        cpu.sp = 0x9000;
        cpu.t = 1000;
    }
    void drive(Pin pin, bool level) { host_sim::set_pin(cpu, pin, level, cpu.t - 10); }
    /// Executes one instruction and checks that it took 4 T-states and left the flags alone.
    void execute_one(int opcode) {
        put(cpu.pc, {opcode});
        const uint8_t flags = cpu.f;
        const uint64_t before = cpu.t;
        ASSERT_EQ(step().kind, Kind::instruction);
        EXPECT_EQ(cpu.t - before, 4U);
        EXPECT_EQ(cpu.f, flags);
    }
    int rim() {
        execute_one(kRim);
        return cpu.a;
    }
    void sim(int accumulator) {
        cpu.a = static_cast<uint8_t>(accumulator);
        execute_one(kSim);
        EXPECT_EQ(cpu.a, accumulator);
    }
};

// Manual: accumulator after RIM: SID I7.5 I6.5 I5.5 IE M7.5 M6.5 M5.5. The pending bits show latch
// and pins whether masked or not. All 256 states.
TEST(Rim, ShowsSerialInputPendingEnableAndMasks) {
    for (int state = 0; state < 256; ++state) {
        SCOPED_TRACE(state);
        Bench bench;
        bench.drive(Pin::sid, (state & 0x80) != 0);
        bench.drive(Pin::rst75, (state & 0x40) != 0);
        bench.drive(Pin::rst75, false);  // the latch, not the pin
        bench.drive(Pin::rst65, (state & 0x20) != 0);
        bench.drive(Pin::rst55, (state & 0x10) != 0);
        bench.cpu.interrupt_enable = (state & 0x08) != 0;
        bench.cpu.masks = static_cast<uint8_t>(state & 0x07);
        bench.cpu.a = static_cast<uint8_t>(~state);
        bench.cpu.f = static_cast<uint8_t>(state & 0xF7);
        for (int look = 0; look < 2; ++look) {  // the second time: looking changes nothing
            bench.cpu.ei_shadow = true;         // so that nothing is taken before
            EXPECT_EQ(bench.rim(), state);
        }
    }
}

// INTR and TRAP have no bit.
TEST(Rim, DoesNotShowIntrAndTrap) {
    Bench bench;
    bench.drive(Pin::intr, true);
    EXPECT_EQ(bench.rim(), 0x07);
    bench.drive(Pin::trap, true);
    EXPECT_EQ(bench.step().kind, Kind::trap);
    EXPECT_EQ(bench.rim(), 0x07);
}

// The pin of RST 7.5 alone is not shown once its latch is clear.
TEST(Rim, ShowsTheLatchOfRst75) {
    Bench bench;
    bench.drive(Pin::rst75, true);
    EXPECT_EQ(bench.rim(), 0x47);
    bench.sim(0x10);
    EXPECT_EQ(bench.rim(), 0x07);
}

// Pins are read as they are in the instruction's only machine cycle (its T3), later than the sample
// for interrupts: a level that rises with T3 is shown, one that rises with the end of T4 is not.
TEST(Rim, ReadsThePinsInItsThirdTState) {
    for (const uint64_t rise : {uint64_t{1002}, uint64_t{1004}}) {
        Bench bench;
        bench.events = {{rise, Pin::sid, true}, {rise, Pin::rst65, true}, {rise, Pin::rst55, true}};
        EXPECT_EQ(bench.rim(), rise == 1002 ? 0xB7 : 0x07);
        EXPECT_EQ(bench.rim(), 0xB7);
    }
}

// Manual: IE as EI and DI set it.
TEST(Rim, ShowsTheEnableFlipFlop) {
    Bench bench;
    bench.execute_one(kEi);
    bench.execute_one(kNop);
    EXPECT_EQ(bench.rim(), 0x0F);
    bench.execute_one(kDi);
    EXPECT_EQ(bench.rim(), 0x07);
}

// Data sheet: "the first RIM instruction following a TRAP" shows IE as it was before; all later
// ones the current one.
TEST(RimAfterTrap, ShowsTheEnableBeforeTheTrapOnce) {
    for (const bool enabled : {false, true}) {
        Bench bench;
        bench.cpu.interrupt_enable = enabled;
        bench.drive(Pin::trap, true);
        ASSERT_EQ(bench.step().kind, Kind::trap);
        EXPECT_EQ(bench.rim(), enabled ? 0x0F : 0x07);
        EXPECT_EQ(bench.rim(), 0x07);
        EXPECT_FALSE(bench.cpu.interrupt_enable) << "reading does not restore it";
    }
}

// Whatever stands between: the first RIM shows the old one even if the current one has changed.
TEST(RimAfterTrap, ShowsTheOldEnableAlsoBehindEnableInterrupts) {
    Bench bench;
    bench.drive(Pin::trap, true);
    ASSERT_EQ(bench.step().kind, Kind::trap);
    bench.execute_one(kEi);
    EXPECT_EQ(bench.rim(), 0x07);
    EXPECT_EQ(bench.rim(), 0x0F);
}

// A second TRAP saves anew: IE is clear since the first.
TEST(RimAfterTrap, ShowsTheEnableBeforeTheLatestTrap) {
    Bench bench;
    bench.cpu.interrupt_enable = true;
    bench.drive(Pin::trap, true);
    ASSERT_EQ(bench.step().kind, Kind::trap);
    bench.drive(Pin::trap, false);
    bench.execute_one(kNop);
    bench.execute_one(kNop);
    bench.execute_one(kNop);
    bench.drive(Pin::trap, true);
    ASSERT_EQ(bench.step().kind, Kind::trap);
    EXPECT_EQ(bench.rim(), 0x07);
}

// Manual: "a RIM following INTR or RST 5.5-7.5 will provide current interrupt enable status,
// revealing that interrupts are disabled".
TEST(RimAfterOtherInterrupts, ShowsThemDisabled) {
    for (const Pin pin : {Pin::rst75, Pin::rst65, Pin::rst55, Pin::intr}) {
        Bench bench;
        bench.cpu.interrupt_enable = true;
        bench.cpu.masks = 0;
        bench.drive(pin, true);
        ASSERT_NE(bench.step().kind, Kind::instruction);
        EXPECT_EQ(bench.rim() & 0x08, 0);
    }
}

// Manual: accumulator before SIM: SOD SOE - R7.5 MSE M7.5 M6.5 M5.5. All 256 accumulators from all
// 32 states of masks, SOD and latch.
TEST(Sim, LoadsWhatItsEnableBitsSay) {
    for (int accumulator = 0; accumulator < 256; ++accumulator) {
        for (int state = 0; state < 32; ++state) {
            SCOPED_TRACE("accumulator " + std::to_string(accumulator) + " state " +
                         std::to_string(state));
            Bench bench;
            bench.cpu.masks = static_cast<uint8_t>(state & 7);
            bench.cpu.sod = (state & 8) != 0;
            bench.cpu.rst75_latch = (state & 16) != 0;
            bench.cpu.f = 0xD7;
            bench.sim(accumulator);
            const bool mask_set_enable = (accumulator & 0x08) != 0;
            const bool serial_enable = (accumulator & 0x40) != 0;
            const bool reset_rst75 = (accumulator & 0x10) != 0;
            EXPECT_EQ(bench.cpu.masks, mask_set_enable ? accumulator & 7 : state & 7);
            EXPECT_EQ(bench.cpu.sod, serial_enable ? (accumulator & 0x80) != 0 : (state & 8) != 0);
            EXPECT_EQ(bench.cpu.rst75_latch, !reset_rst75 && (state & 16) != 0);
            EXPECT_FALSE(bench.cpu.interrupt_enable) << "SIM does not touch IE";
        }
    }
}

// The pin is driven when, and only when, SOE is set, at the end of the instruction.
TEST(Sim, DrivesSodOnlyWithItsEnable) {
    Bench bench;
    bench.sim(0x80);
    EXPECT_TRUE(bench.outputs.empty());
    bench.sim(0xC0);
    bench.sim(0x40);
    const std::vector<Output> expected{{Output::kSerial, 1, 1008}, {Output::kSerial, 0, 1012}};
    EXPECT_EQ(bench.outputs, expected);
}

// SOD is an output and SID an input: neither shows in the other.
TEST(Sim, LeavesSerialInputAlone) {
    Bench bench;
    bench.sim(0xC0);
    EXPECT_EQ(bench.rim() & 0x80, 0);
    bench.drive(Pin::sid, true);
    bench.sim(0x40);
    EXPECT_EQ(bench.rim() & 0x80, 0x80);
}

// Masks read back through RIM, all eight.
TEST(Sim, MasksReadBack) {
    for (int masks = 0; masks < 8; ++masks) {
        Bench bench;
        bench.sim(0x08 | masks);
        EXPECT_EQ(bench.rim(), masks);
    }
}

}  // namespace
