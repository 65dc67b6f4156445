// interrupts_test.cpp - acceptance of interrupts, case by case.
// Sources      [DS] Intel 8085AH data sheet (1987): pin description, "Interrupt and Serial I/O",
//              table "Interrupt Priority, Restart Address, and Sensitivity", figures "TRAP and
//              RESET IN circuit" and "RIM", A.C. characteristics (sampling in the next-to-last
//              T-state). [UM] Intel MCS-80/85 Family User's Manual, chapters 2 (interrupts, HALT
//              state) and 5 (EI, DI, HLT, RIM, SIM, RST).
#include "host_sim/cpu/interrupts.hpp"

#include <gtest/gtest.h>

#include <random>
#include <string>
#include <vector>

#include "scripted_machine.hpp"

namespace {

using cpu_test::PinEvent;
using cpu_test::ScriptedMachine;
using host_sim::Interrupt;
using host_sim::Pin;
using host_sim::StepRecord;
using Kind = StepRecord::Kind;

constexpr int kNop = 0x00, kSim = 0x30, kMviA = 0x3E, kHlt = 0x76, kRet = 0xC9, kDi = 0xF3,
              kEi = 0xFB, kLxiH = 0x21, kCallOpcode = 0xCD;
constexpr uint16_t kCode = 0x0100;
constexpr uint16_t kStack = 0x9000;
constexpr uint64_t kBegin = 1000;

/// Memory is full of NOPs (4 T). Interrupts are enabled and unmasked, all pins low.
struct Bench : ScriptedMachine {
    Bench() {
        cpu.pc = kCode;
        cpu.sp = kStack;
        cpu.t = kBegin;
        cpu.masks = 0;
        cpu.interrupt_enable = true;
    }
    void code(std::initializer_list<int> bytes) { put(kCode, bytes); }
    void drive(Pin pin, bool level, uint64_t t) { host_sim::set_pin(cpu, pin, level, t); }
    /// High long ago.
    void raise(Pin pin) { drive(pin, true, kBegin - 100); }
    /// High for long, and low again for long.
    void pulse(Pin pin) {
        drive(pin, true, kBegin - 100);
        drive(pin, false, kBegin - 50);
    }
    /// Executes `count` steps that must be instructions.
    void instructions(int count) {
        for (int i = 0; i < count; ++i) ASSERT_EQ(step().kind, Kind::instruction) << "step " << i;
    }
    [[nodiscard]] unsigned pushed() const {
        return memory.bytes[cpu.sp] | unsigned{memory.bytes[cpu.sp + 1U]} << 8;
    }
    [[nodiscard]] uint64_t elapsed() const { return cpu.t - kBegin; }
};

struct Source {
    Pin pin;
    Kind kind;
    Interrupt interrupt;
    uint16_t vector;
    uint8_t mask;
    const char* name;
};

// [DS] table "Interrupt Priority, Restart Address, and Sensitivity", highest first. INTR: RST 7
// from the open bus.
constexpr Source kSources[] = {
    {Pin::trap, Kind::trap, Interrupt::trap, 0x0024, 0, "TRAP"},
    {Pin::rst75, Kind::rst75, Interrupt::rst75, 0x003C, 4, "RST 7.5"},
    {Pin::rst65, Kind::rst65, Interrupt::rst65, 0x0034, 2, "RST 6.5"},
    {Pin::rst55, Kind::rst55, Interrupt::rst55, 0x002C, 1, "RST 5.5"},
    {Pin::intr, Kind::intr, Interrupt::intr, 0x0038, 0, "INTR"},
};
constexpr Pin kLevelPins[] = {Pin::rst65, Pin::rst55, Pin::intr};

// -- Acceptance ----------------------------------------------------------------------------------

// [DS] table of vectors; [UM] machine cycles: a 6-T bus idle (or INTA) cycle and two 3-T writes.
// The address pushed is that of the instruction not executed; any acceptance clears IE.
TEST(Acceptance, Takes12TStatesAndPushesTheReturnAddress) {
    for (const Source& source : kSources) {
        SCOPED_TRACE(source.name);
        Bench bench;
        bench.raise(source.pin);
        EXPECT_EQ(host_sim::pending_interrupt(bench.cpu), source.interrupt);
        const StepRecord record = bench.step();
        EXPECT_EQ(record.kind, source.kind);
        EXPECT_EQ(bench.elapsed(), 12U);
        EXPECT_EQ(bench.cpu.pc, source.vector);
        EXPECT_EQ(bench.cpu.sp, kStack - 2);
        EXPECT_EQ(bench.memory.bytes[kStack - 1], 0x01) << "high byte first, just below SP";
        EXPECT_EQ(bench.memory.bytes[kStack - 2], 0x00);
        EXPECT_FALSE(bench.cpu.interrupt_enable);
        EXPECT_EQ(bench.cpu.instructions, 0U) << "no instruction has been executed";
    }
}

TEST(Acceptance, VectorsAreThoseOfTheDataSheet) {
    EXPECT_EQ(host_sim::interrupt_vector(Interrupt::trap), 0x0024);
    EXPECT_EQ(host_sim::interrupt_vector(Interrupt::rst75), 0x003C);
    EXPECT_EQ(host_sim::interrupt_vector(Interrupt::rst65), 0x0034);
    EXPECT_EQ(host_sim::interrupt_vector(Interrupt::rst55), 0x002C);
    EXPECT_EQ(host_sim::interrupt_vector(Interrupt::none), 0x0000);
}

// [UM] RST n: "control is transferred to the instruction whose address is eight times n". INTA does
// not advance PC, so the pushed address is that of the instruction not executed.
TEST(Acceptance, IntrExecutesTheRestartThatIntaReads) {
    for (int n = 0; n < 8; ++n) {
        SCOPED_TRACE(n);
        Bench bench;
        bench.acknowledge_bytes = {static_cast<uint8_t>(0xC7 | n << 3)};
        bench.raise(Pin::intr);
        EXPECT_EQ(bench.step().kind, Kind::intr);
        EXPECT_EQ(bench.elapsed(), 12U);
        EXPECT_EQ(bench.cpu.pc, 8 * n);
        EXPECT_EQ(bench.pushed(), kCode);
    }
}

// [UM] INTA of a CALL: two more INTA cycles read the address; 6 + 3 + 3 + 3 + 3 T-states.
TEST(Acceptance, IntrExecutesTheCallThatIntaReads) {
    Bench bench;
    bench.acknowledge_bytes = {kCallOpcode, 0x34, 0x12};
    bench.raise(Pin::intr);
    const StepRecord record = bench.step();
    EXPECT_EQ(bench.elapsed(), 18U);
    EXPECT_EQ(bench.cpu.pc, 0x1234);
    EXPECT_EQ(bench.pushed(), kCode);
    EXPECT_EQ(record.access_count, 5);
    for (int i = 0; i < 3; ++i) {
        EXPECT_EQ(record.accesses[static_cast<unsigned>(i)].kind,
                  host_sim::BusAccess::Kind::acknowledge);
    }
}

// -- Priority ------------------------------------------------------------------------------------

// [DS] priority column: of every pair the one further up is taken, the other stays pending.
TEST(Priority, OfEveryPair) {
    for (const Source& high : kSources) {
        for (const Source* low = &high + 1; low != std::end(kSources); ++low) {
            SCOPED_TRACE(std::string(high.name) + " and " + low->name);
            Bench bench;
            bench.put(high.vector, {kNop, kEi, kNop, kNop});
            bench.raise(low->pin);
            bench.raise(high.pin);
            EXPECT_EQ(bench.step().kind, high.kind);
            bench.drive(high.pin, false, bench.cpu.t);
            bench.instructions(3);  // NOP: IE is clear; EI; the instruction in its shadow
            EXPECT_EQ(bench.step().kind, low->kind);
            EXPECT_EQ(bench.pushed(), high.vector + 3U);
        }
    }
}

// [UM] "the priority ... does not take into account the priority of a routine that was started by a
// higher priority interrupt. RST 5.5 can interrupt an RST 7.5 routine" once IE is set again.
TEST(Priority, DoesNotNest) {
    Bench bench;
    bench.put(0x003C, {kEi, kNop, kNop});
    bench.raise(Pin::rst75);
    EXPECT_EQ(bench.step().kind, Kind::rst75);
    bench.drive(Pin::rst55, true, bench.cpu.t);
    bench.instructions(2);
    EXPECT_EQ(bench.step().kind, Kind::rst55);
    EXPECT_EQ(bench.pushed(), 0x003EU);
    EXPECT_EQ(bench.cpu.sp, kStack - 4);
    EXPECT_EQ(bench.memory.bytes[kStack - 1], 0x01) << "the outer return address stays";
}

// -- Sampling ------------------------------------------------------------------------------------

// [DS] interrupts are sampled in the next-to-last T-state of an instruction: a level that is there
// from the beginning of T-state x is seen at the end of an instruction at x + 2, not at x + 1.
TEST(Sampling, ARiseIsSeenTwoTStatesLater) {
    for (const Source& source : kSources) {
        for (uint64_t lead = 0; lead < 6; ++lead) {
            SCOPED_TRACE(std::string(source.name) + " lead " + std::to_string(lead));
            Bench bench;
            bench.drive(source.pin, true, kBegin - lead);
            EXPECT_EQ(host_sim::pending_interrupt(bench.cpu),
                      lead >= 2 ? source.interrupt : Interrupt::none);
            EXPECT_EQ(bench.step().kind, lead >= 2 ? source.kind : Kind::instruction);
        }
    }
}

// The same for a fall, except where a latch remembers the edge.
TEST(Sampling, AFallIsSeenTwoTStatesLater) {
    for (const Source& source : kSources) {
        for (uint64_t lead = 0; lead < 6; ++lead) {
            SCOPED_TRACE(std::string(source.name) + " lead " + std::to_string(lead));
            Bench bench;
            bench.raise(source.pin);
            bench.drive(source.pin, false, kBegin - lead);
            const bool seen = lead < 2 || source.pin == Pin::rst75;
            EXPECT_EQ(host_sim::pending_interrupt(bench.cpu),
                      seen ? source.interrupt : Interrupt::none);
        }
    }
}

// Whatever the pins did, what counts is the level two T-states before the boundary. Levels change
// at random at every T-state (more than once, too); boundaries are everywhere.
TEST(Sampling, IsTheLevelTwoTStatesBackForAnyWaveform) {
    constexpr unsigned kSeed = 8085;
    std::mt19937 random(kSeed);
    for (const Pin pin : kLevelPins) {
        Bench bench;
        bool older = false;
        bool previous = false;
        for (uint64_t t = kBegin; t < kBegin + 20'000; ++t) {
            bool now = bench.cpu.pin(pin).level;
            for (unsigned changes = random() % 4; changes > 1; --changes) {
                now = (random() & 1) != 0;
                bench.drive(pin, now, t);
            }
            bench.cpu.t = t;
            ASSERT_EQ(host_sim::pending_interrupt(bench.cpu) != Interrupt::none, older)
                << "seed " << kSeed << " t " << t << " pin " << static_cast<int>(pin);
            older = previous;
            previous = now;
        }
    }
}

// TRAP: the same level, and by then an edge that no acceptance has used up yet.
TEST(Sampling, OfTrapNeedsAnUnusedEdgeAndTheLevelForAnyWaveform) {
    constexpr unsigned kSeed = 24;
    std::mt19937 random(kSeed);
    Bench bench;
    bool older = false;
    bool previous = false;
    bool edge = false;  // the flip-flop now, one and two T-states ago
    bool previous_edge = false;
    bool older_edge = false;
    int taken = 0;
    for (uint64_t t = kBegin; t < kBegin + 20'000; ++t) {
        bool now = bench.cpu.pin(Pin::trap).level;
        if (random() % 3 == 0) {
            now = !now;
            edge = edge || now;
            bench.drive(Pin::trap, now, t);
        }
        bench.cpu.t = t;
        ASSERT_EQ(host_sim::pending_interrupt(bench.cpu) == Interrupt::trap, older_edge && older)
            << "seed " << kSeed << " t " << t;
        if (older_edge && older && random() % 2 == 0) {
            bench.step();
            edge = previous_edge = false;
            ++taken;
        }
        older = previous;
        previous = now;
        older_edge = previous_edge;
        previous_edge = edge;
    }
    EXPECT_GT(taken, 1000);
}

// pins_settled() promises that time alone changes nothing any more, whichever order of pins.
TEST(Sampling, SettledPinsStaySettled) {
    Bench bench;
    EXPECT_TRUE(host_sim::pins_settled(bench.cpu));
    bench.drive(Pin::rst55, true, kBegin);
    bench.drive(Pin::rst65, true, kBegin - 1);  // another pin, heard of later
    EXPECT_FALSE(host_sim::pins_settled(bench.cpu));
    bench.cpu.t = kBegin + 1;
    EXPECT_FALSE(host_sim::pins_settled(bench.cpu));
    bench.cpu.t = kBegin + 2;
    EXPECT_TRUE(host_sim::pins_settled(bench.cpu));
    bench.cpu.ei_shadow = true;
    EXPECT_FALSE(host_sim::pins_settled(bench.cpu)) << "the shadow ends with an instruction";
}

// A rise during a long instruction is seen at its end, one in its last two T-states an instruction
// later. CALL: 18 T-states.
TEST(Sampling, WithinAnInstruction) {
    for (const uint64_t rise : {kBegin + 16, kBegin + 17}) {
        SCOPED_TRACE(rise);
        Bench bench;
        bench.code({kCallOpcode, 0x00, 0x20});
        bench.events = {{rise, Pin::rst55, true}};
        bench.instructions(1);
        EXPECT_EQ(bench.elapsed(), 18U);
        if (rise == kBegin + 17) bench.instructions(1);
        EXPECT_EQ(bench.step().kind, Kind::rst55);
        EXPECT_EQ(bench.pushed(), rise == kBegin + 16 ? 0x2000U : 0x2001U);
    }
}

// -- Enable, masks -------------------------------------------------------------------------------

// [DS] masks and IE stop all but TRAP; INTR has no mask.
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

// [DS] TRAP "is unaffected by any mask or interrupt enable".
TEST(Masks, TrapIgnoresAllOfThemTogether) {
    Bench bench;
    bench.cpu.interrupt_enable = false;
    bench.cpu.masks = 7;
    bench.raise(Pin::trap);
    EXPECT_EQ(bench.step().kind, Kind::trap);
}

// [UM] EI: "interrupts are enabled following the execution of the next instruction".
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

// [UM] DI: "the interrupt system is disabled immediately following the execution".
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

// Inferred from [DS]: TRAP does not look at IE, so the shadow does not delay it.
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

// [DS] RST 7.5 "is rising edge sensitive ... a pulse will set an internal flip-flop".
TEST(Rst75, RemembersAShortPulse) {
    Bench bench;
    bench.drive(Pin::rst75, true, kBegin - 3);
    bench.drive(Pin::rst75, false, kBegin - 2);
    EXPECT_EQ(bench.step().kind, Kind::rst75);
}

// [DS] "the status of the flip-flop ... is set even though masked"; it is taken when unmasked.
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

// [DS] SIM: "RST 7.5 flip-flop is reset when bit 4 is set", with MSE clear too.
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

// [DS] "high level until sampled": no latch, so a level that goes early was never there.
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

// [DS] figure "TRAP and RESET IN circuit": the edge sets a flip-flop, AND the level must be there.
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

// [DS] inputs are sampled throughout HALT, so that time to wake up counts in single T-states; the
// return address is that of the byte behind HLT.
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

// [DS] RESET IN: "sets the program counter to zero and resets the interrupt enable and HLDA
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

// [UM] power-on is a RESET: masked and disabled.
TEST(Reset, IsTheStateAfterPowerOn) {
    host_sim::CpuState after_reset;
    host_sim::reset(after_reset);
    EXPECT_EQ(after_reset, host_sim::CpuState{});
    EXPECT_EQ(after_reset.masks, 7);
}

// -- Pins ----------------------------------------------------------------------------------------

TEST(SetPin, IgnoresAnUnchangedLevel) {
    Bench bench;
    bench.raise(Pin::rst75);
    const host_sim::CpuState before = bench.cpu;
    bench.drive(Pin::rst75, true, kBegin);
    EXPECT_EQ(bench.cpu, before);
}

TEST(SetPin, ReachesOnlyItsPin) {
    for (unsigned which = 0; which < host_sim::kPinCount; ++which) {
        Bench bench;
        bench.drive(static_cast<Pin>(which), true, 7);
        for (unsigned other = 0; other < host_sim::kPinCount; ++other) {
            EXPECT_EQ(bench.cpu.pin(static_cast<Pin>(other)).level, other == which);
        }
    }
}

}  // namespace
