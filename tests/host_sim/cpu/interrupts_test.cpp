// interrupts_test.cpp - which interrupt is accepted when: acceptance, priority, sampling, pins.
// Data sheet   Intel 8085AH (1987): pin description, "Interrupt and Serial I/O", table "Interrupt
//              Priority, Restart Address, and Sensitivity", sampling in the next-to-last T-state.
// Manual       Intel MCS-80/85 Family User's Manual: interrupts, HALT, RST, CALL, machine cycles.
#include "host_sim/cpu/interrupts.hpp"

#include <gtest/gtest.h>

#include <random>
#include <string>

#include "interrupt_bench.hpp"

namespace {

using namespace cpu_test;

// -- Acceptance ----------------------------------------------------------------------------------

// Data sheet: table of vectors; Manual: machine cycles: a 6-T bus idle (or INTA) cycle and two 3-T
// writes. The address pushed is that of the instruction not executed; any acceptance clears IE.
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

// Manual: RST n: "control is transferred to the instruction whose address is eight times n". INTA
// does not advance PC, so the pushed address is that of the instruction not executed.
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

// Manual: INTA of a CALL: two more INTA cycles read the address; 6 + 3 + 3 + 3 + 3 T-states.
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

// The data sheet speaks of RST and CALL only. Any other byte is executed as it stands, without
// moving PC for it; a conditional CALL reads its address from memory.
TEST(Acceptance, IntrExecutesAnyOtherByteInPlace) {
    for (const int opcode : {kNop, kInrA, kEi}) {
        SCOPED_TRACE(opcode);
        Bench bench;
        bench.acknowledge_bytes = {static_cast<uint8_t>(opcode)};
        bench.raise(Pin::intr);
        EXPECT_EQ(bench.step().kind, Kind::intr);
        EXPECT_EQ(bench.elapsed(), 4U);
        EXPECT_EQ(bench.cpu.pc, kCode);
        EXPECT_EQ(bench.cpu.a, opcode == kInrA ? 1 : 0);
        EXPECT_EQ(bench.cpu.interrupt_enable, opcode == kEi);
        EXPECT_EQ(bench.cpu.instructions, 0U);
    }
}

// -- Priority ------------------------------------------------------------------------------------

// Data sheet: priority column: of every pair the one further up is taken, the other stays pending.
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

// Manual: "the priority ... does not take into account the priority of a routine that was started
// by a higher priority interrupt. RST 5.5 can interrupt an RST 7.5 routine" once IE is set again.
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

// Data sheet: interrupts are sampled in the next-to-last T-state of an instruction: a level that is
// there from the beginning of T-state x is seen at the end of an instruction at x + 2, not at x
// + 1.
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
