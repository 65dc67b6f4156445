// interrupt_inputs_test.cpp - each interrupt input by itself: masks, EI and DI, latches and levels,
// TRAP, waking from HALT, RESET.
// Data sheet   Intel 8085AH (1987): pin description, "Interrupt and Serial I/O", table "Interrupt
//              Priority, Restart Address, and Sensitivity", figure "TRAP and RESET IN circuit".
// Manual       Intel MCS-80/85 Family User's Manual: EI, DI, HLT, SIM, interrupts, HALT, RESET.
#include <gtest/gtest.h>

#include <string>

#include "interrupt_bench.hpp"

namespace {

using namespace cpu_test;

// -- Enable, masks -------------------------------------------------------------------------------

// Data sheet: masks and IE stop all but TRAP; INTR has no mask.
TEST(Masks, StopTheirInputOnly) {
    for (const Source& source : kSources) {
        for (unsigned masks = 0; masks < 8; ++masks) {
            SCOPED_TRACE(std::string(source.name) + " masks " + std::to_string(masks));
            Bench bench;
            bench.cpu.masks = static_cast<uint8_t>(masks);
            bench.raise(source.pin);
            EXPECT_EQ(bench.step().kind,
                      (masks & source.mask) != 0 ? Kind::instruction : source.kind);
        }
    }
}

TEST(Masks, InterruptEnableStopsAllButTrap) {
    for (const Source& source : kSources) {
        SCOPED_TRACE(source.name);
        Bench bench;
        bench.cpu.interrupt_enable = false;
        bench.raise(source.pin);
        EXPECT_EQ(bench.step().kind, source.pin == Pin::trap ? Kind::trap : Kind::instruction);
    }
}

// Data sheet: TRAP "is unaffected by any mask or interrupt enable".
TEST(Masks, TrapIgnoresAllOfThemTogether) {
    Bench bench;
    bench.cpu.interrupt_enable = false;
    bench.cpu.masks = 7;
    bench.raise(Pin::trap);
    EXPECT_EQ(bench.step().kind, Kind::trap);
}

// Manual: EI: "interrupts are enabled following the execution of the next instruction".
TEST(EnableInterrupts, ActsAfterOneMoreInstruction) {
    for (const Source& source : kSources) {
        if (source.pin == Pin::trap) continue;
        SCOPED_TRACE(source.name);
        Bench bench;
        bench.code({kEi, kLxiH, 0x34, 0x12});
        bench.cpu.interrupt_enable = false;
        bench.raise(source.pin);
        bench.instructions(2);
        EXPECT_EQ(bench.cpu.hl(), 0x1234);
        EXPECT_EQ(bench.step().kind, source.kind);
        EXPECT_EQ(bench.pushed(), kCode + 4U);
    }
}

// The reason for the shadow: EI; RET at the end of a handler does not grow the stack.
TEST(EnableInterrupts, LetsReturnHappenFirst) {
    Bench bench;
    bench.code({kEi, kRet});
    bench.put(kStack, {0x00, 0x30});
    bench.cpu.interrupt_enable = false;
    bench.raise(Pin::rst65);
    bench.instructions(2);
    EXPECT_EQ(bench.step().kind, Kind::rst65);
    EXPECT_EQ(bench.pushed(), 0x3000U);
    EXPECT_EQ(bench.cpu.sp, kStack);
}

// Each EI casts its own shadow, also when IE was already set.
TEST(EnableInterrupts, ChainsWhenRepeated) {
    Bench bench;
    bench.code({kEi, kEi, kEi, kNop});
    bench.cpu.interrupt_enable = false;
    bench.raise(Pin::intr);
    bench.instructions(4);
    EXPECT_EQ(bench.step().kind, Kind::intr);
    EXPECT_EQ(bench.pushed(), kCode + 4U);
}

TEST(EnableInterrupts, FollowedByHaltWakesWithTheAddressBehindHalt) {
    Bench bench;
    bench.code({kEi, kHlt});
    bench.cpu.interrupt_enable = false;
    bench.raise(Pin::rst55);
    bench.instructions(2);
    EXPECT_TRUE(bench.cpu.halted);
    EXPECT_EQ(bench.step().kind, Kind::rst55) << "at once";
    EXPECT_EQ(bench.elapsed(), 4U + 5U + 12U);
    EXPECT_EQ(bench.pushed(), kCode + 2U);
}

// Manual: DI: "the interrupt system is disabled immediately following the execution".
TEST(EnableInterrupts, FollowedByDisableNeverOpens) {
    Bench bench;
    bench.code({kEi, kDi, kNop, kNop});
    bench.cpu.interrupt_enable = false;
    bench.raise(Pin::rst75);
    bench.raise(Pin::intr);
    bench.instructions(10);
    EXPECT_FALSE(bench.cpu.interrupt_enable);
}

TEST(DisableInterrupts, ActsAtOnce) {
    Bench bench;
    bench.code({kDi});
    bench.drive(Pin::rst65, true, kBegin + 1);  // seen at the end of DI, were IE still set
    bench.instructions(10);
    EXPECT_EQ(bench.cpu.pc, kCode + 10);
}

// Inferred from Data sheet:: TRAP does not look at IE, so the shadow does not delay it.
TEST(EnableInterrupts, DoesNotDelayTrap) {
    Bench bench;
    bench.code({kEi, kNop});
    bench.cpu.interrupt_enable = false;
    bench.instructions(1);
    bench.drive(Pin::trap, true, kBegin);
    bench.raise(Pin::rst75);
    EXPECT_EQ(bench.step().kind, Kind::trap);
    EXPECT_EQ(bench.pushed(), kCode + 1U);
    EXPECT_FALSE(bench.cpu.ei_shadow) << "no EI stands before the handler";
    bench.instructions(5);  // acceptance has cleared IE, shadow or not
}

// -- RST 7.5 -------------------------------------------------------------------------------------

// Data sheet: RST 7.5 "is rising edge sensitive ... a pulse will set an internal flip-flop".
TEST(Rst75, RemembersAShortPulse) {
    Bench bench;
    bench.drive(Pin::rst75, true, kBegin - 3);
    bench.drive(Pin::rst75, false, kBegin - 2);
    EXPECT_EQ(bench.step().kind, Kind::rst75);
}

// An edge that finds the flip-flop set changes nothing: the request has long been there.
TEST(Rst75, IsSeenAtOnceWhenTheLatchHasBeenSetForLong) {
    Bench bench;
    bench.pulse(Pin::rst75);
    bench.drive(Pin::rst75, true, kBegin - 1);
    EXPECT_EQ(bench.step().kind, Kind::rst75);
}

// Data sheet: "the status of the flip-flop ... is set even though masked"; it is taken when
// unmasked.
TEST(Rst75, IsLatchedWhileMaskedAndDisabled) {
    Bench bench;
    bench.cpu.masks = 7;
    bench.cpu.interrupt_enable = false;
    bench.code({kMviA, 0x08, kSim, kEi, kNop});
    bench.pulse(Pin::rst75);
    bench.instructions(4);
    EXPECT_TRUE(bench.cpu.rst75_latch);
    EXPECT_EQ(bench.step().kind, Kind::rst75);
}

// Acceptance clears the latch; with the pin still high nothing happens until a new edge.
TEST(Rst75, NeedsANewEdgeAfterAcceptance) {
    Bench bench;
    bench.put(0x003C, {kEi, kNop, kNop, kNop, kNop});
    bench.raise(Pin::rst75);
    EXPECT_EQ(bench.step().kind, Kind::rst75);
    bench.instructions(3);
    bench.drive(Pin::rst75, false, bench.cpu.t);
    bench.drive(Pin::rst75, true, bench.cpu.t + 1);
    bench.instructions(1);
    EXPECT_EQ(bench.step().kind, Kind::rst75);
}

// Data sheet: SIM: "RST 7.5 flip-flop is reset when bit 4 is set", with MSE clear too.
TEST(Rst75, IsForgottenBySimWithBit4) {
    for (const int mask_set_enable : {0x00, 0x08}) {
        Bench bench;
        bench.cpu.interrupt_enable = false;
        bench.code({kMviA, 0x10 | mask_set_enable, kSim, kEi, kNop, kNop, kNop});
        bench.raise(Pin::rst75);
        bench.instructions(7);
        EXPECT_FALSE(bench.cpu.rst75_latch);
    }
}

TEST(Rst75, SurvivesSimWithoutBit4AndADropOfThePin) {
    Bench bench;
    bench.cpu.interrupt_enable = false;
    bench.code({kMviA, 0x0F, kSim, kMviA, 0x08, kSim, kEi, kNop});
    bench.pulse(Pin::rst75);
    bench.instructions(6);
    EXPECT_EQ(bench.step().kind, Kind::rst75);
}

// The other interrupts do not touch the latch.
TEST(Rst75, SurvivesTrap) {
    Bench bench;
    bench.put(0x0024, {kEi, kNop});
    bench.pulse(Pin::rst75);
    bench.raise(Pin::trap);
    EXPECT_EQ(bench.step().kind, Kind::trap);
    bench.instructions(2);
    EXPECT_EQ(bench.step().kind, Kind::rst75);
}

// -- RST 6.5, RST 5.5, INTR ----------------------------------------------------------------------

// Data sheet: "high level until sampled": no latch, so a level that goes early was never there.
TEST(LevelInputs, AreForgottenWhenTheyFallBeforeSampling) {
    for (const Pin pin : kLevelPins) {
        Bench bench;
        bench.code({kCallOpcode, 0x00, 0x20});  // the only boundaries are at 0 and 18
        bench.events = {{kBegin + 3, pin, true}, {kBegin + 12, pin, false}};
        bench.instructions(10);
    }
}

// A level that stays is taken again as soon as IE is set: the device must let go.
TEST(LevelInputs, AreTakenAgainWhileHigh) {
    for (const Source& source : kSources) {
        if (source.pin == Pin::trap || source.pin == Pin::rst75) continue;
        SCOPED_TRACE(source.name);
        Bench bench;
        bench.put(source.vector, {kEi, kNop, kNop});
        bench.raise(source.pin);
        EXPECT_EQ(bench.step().kind, source.kind);
        bench.instructions(2);
        EXPECT_EQ(bench.step().kind, source.kind);
        EXPECT_EQ(bench.pushed(), source.vector + 2U);
    }
}

TEST(LevelInputs, OfAMaskedPinDoNotWait) {
    Bench bench;
    bench.cpu.masks = 3;
    bench.raise(Pin::rst65);
    bench.raise(Pin::rst55);
    bench.instructions(2);
    bench.drive(Pin::rst65, false, bench.cpu.t);
    bench.drive(Pin::rst55, false, bench.cpu.t);
    bench.instructions(2);
    bench.cpu.masks = 0;
    bench.instructions(5);
}

// -- TRAP ----------------------------------------------------------------------------------------

// Data sheet: figure "TRAP and RESET IN circuit": the edge sets a flip-flop, AND the level must be
// there.
TEST(Trap, IsForgottenWhenItFallsBeforeAcceptance) {
    Bench bench;
    bench.pulse(Pin::trap);
    bench.instructions(10);
}

TEST(Trap, IsNotTakenAgainWhileHigh) {
    Bench bench;
    bench.raise(Pin::trap);
    EXPECT_EQ(bench.step().kind, Kind::trap);
    bench.instructions(20);
}

TEST(Trap, IsTakenAgainAfterFallingAndRising) {
    Bench bench;
    bench.raise(Pin::trap);
    EXPECT_EQ(bench.step().kind, Kind::trap);
    bench.drive(Pin::trap, false, bench.cpu.t);
    bench.instructions(3);
    bench.drive(Pin::trap, true, bench.cpu.t - 2);
    EXPECT_EQ(bench.step().kind, Kind::trap) << "IE has been clear all the time";
}

TEST(Trap, InterruptsEveryHandler) {
    for (const Source& source : kSources) {
        if (source.pin == Pin::trap) continue;
        SCOPED_TRACE(source.name);
        Bench bench;
        bench.raise(source.pin);
        EXPECT_EQ(bench.step().kind, source.kind);
        bench.drive(Pin::trap, true, bench.cpu.t - 2);
        EXPECT_EQ(bench.step().kind, Kind::trap);
        EXPECT_EQ(bench.pushed(), source.vector);
    }
}

// -- HALT ----------------------------------------------------------------------------------------

// Data sheet: inputs are sampled throughout HALT, so that time to wake up counts in single
// T-states; the return address is that of the byte behind HLT.
TEST(Halt, EndsTwoTStatesAfterTheRise) {
    for (const Source& source : kSources) {
        for (uint64_t wait = 0; wait < 7; ++wait) {
            SCOPED_TRACE(std::string(source.name) + " wait " + std::to_string(wait));
            Bench bench;
            bench.code({kHlt});
            bench.cpu.interrupt_enable = true;
            bench.instructions(1);
            EXPECT_EQ(bench.elapsed(), 5U);
            EXPECT_TRUE(bench.cpu.halted);
            bench.events = {{kBegin + 5 + wait, source.pin, true}};
            for (uint64_t i = 0; i < wait + 2; ++i) ASSERT_EQ(bench.step().kind, Kind::halt);
            EXPECT_EQ(bench.step().kind, source.kind);
            EXPECT_EQ(bench.elapsed(), 5 + wait + 2 + 12);
            EXPECT_EQ(bench.pushed(), kCode + 1U);
            EXPECT_FALSE(bench.cpu.halted);
        }
    }
}

TEST(Halt, GoesOnWhileNothingIsAccepted) {
    Bench bench;
    bench.code({kDi, kHlt});
    bench.raise(Pin::rst75);
    bench.raise(Pin::rst65);
    bench.raise(Pin::rst55);
    bench.raise(Pin::intr);
    bench.cpu.interrupt_enable = false;
    bench.instructions(2);
    for (int i = 0; i < 100; ++i) ASSERT_EQ(bench.step().kind, Kind::halt);
    EXPECT_EQ(bench.cpu.pc, kCode + 2);
    EXPECT_EQ(bench.cpu.instructions, 2U);
    bench.drive(Pin::trap, true, bench.cpu.t - 2);
    EXPECT_EQ(bench.step().kind, Kind::trap) << "only TRAP or RESET ends it";
}

// -- RESET ---------------------------------------------------------------------------------------

// Data sheet: RESET IN: "sets the program counter to zero and resets the interrupt enable and HLDA
// flip-flops"; masks set, RST 7.5 latch and TRAP flip-flop cleared, SOD low.
TEST(Reset, LeavesTheStateOfTheDataSheet) {
    Bench bench;
    bench.raise(Pin::rst75);
    bench.raise(Pin::trap);
    bench.cpu.halted = bench.cpu.ei_shadow = bench.cpu.sod = true;
    bench.cpu.trap_saved_valid = bench.cpu.trap_saved_enable = true;
    bench.cpu.a = 0x5A;
    bench.cpu.f = 0xD7;
    host_sim::reset(bench.cpu);
    EXPECT_EQ(bench.cpu.pc, 0);
    EXPECT_FALSE(bench.cpu.halted);
    EXPECT_FALSE(bench.cpu.interrupt_enable);
    EXPECT_FALSE(bench.cpu.ei_shadow);
    EXPECT_EQ(bench.cpu.masks, 7);
    EXPECT_FALSE(bench.cpu.rst75_latch);
    EXPECT_FALSE(bench.cpu.trap_latch);
    EXPECT_FALSE(bench.cpu.trap_saved_valid);
    EXPECT_FALSE(bench.cpu.sod);
    EXPECT_EQ(bench.cpu.a, 0x5A) << "registers are untouched";
    EXPECT_EQ(bench.cpu.f, 0xD7);
    EXPECT_EQ(bench.cpu.sp, kStack);
    EXPECT_EQ(bench.cpu.t, kBegin);
    EXPECT_TRUE(bench.cpu.pin(Pin::trap).level) << "whoever drives a pin still does";
    bench.instructions(5);  // TRAP is high, but its edge is gone
}

// Manual: power-on is a RESET: masked and disabled.
TEST(Reset, IsTheStateAfterPowerOn) {
    host_sim::CpuState after_reset;
    host_sim::reset(after_reset);
    EXPECT_EQ(after_reset, host_sim::CpuState{});
    EXPECT_EQ(after_reset.masks, 7);
}

}  // namespace
