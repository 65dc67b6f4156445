// i82c54_program_test.cpp - 82C54 against its data sheet: programming, latches, read-back, clocks.
// Source       Intel 82C54 data sheet (231244): "Programming" to "Read-Back Command",
//              figures 7 to 14.
// Times        CLK period 1 T unless said: what is written at T-state t is loaded at t + 1.
#include "host_sim/chips/i82c54.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <utility>

#include "tests/host_sim/chips/i82c54_fixture.hpp"

namespace {

using namespace host_sim::chips_test;
using host_sim::chips::kNever;
using host_sim::chips::kOpenBus;
using testing::ElementsAre;

// -- Programming, latches, status ----------------------------------------------------------------

TEST(I82c54Programming, OutputTakesItsModesInitialLevelAtOnce) {
    for (unsigned mode = 0; mode < 8; ++mode) {
        I82c54 timer;
        timer.write(I82c54::kControlAddress, control(1, kLsb, mode), 5);
        EXPECT_EQ(timer.output(1), mode != 0) << mode;
    }
}

TEST(I82c54Programming, ZeroIsTheLargestCount) {
    I82c54 binary = timer_in_mode(0, kBoth);
    write_two(binary, 0, 0, 20);
    EXPECT_THAT(edges_until(binary, 100'000), ElementsAre(std::pair{20ULL + 65'537, true}));
    I82c54 bcd;
    bcd.set_periodic_clock(0, 1);
    bcd.write(I82c54::kControlAddress, control(0, kBoth, 0, kBcd), 10);
    write_two(bcd, 0, 0, 20);
    EXPECT_THAT(edges_until(bcd, 100'000), ElementsAre(std::pair{20ULL + 10'001, true}));
}

TEST(I82c54Programming, BcdCountsInDecimal) {
    I82c54 timer;
    timer.set_periodic_clock(0, 1);
    timer.write(I82c54::kControlAddress, control(0, kBoth, 0, kBcd), 10);
    write_two(timer, 0, 0x1000, 20);
    EXPECT_EQ(read_two(timer, 0, 21), 0x1000);
    EXPECT_EQ(read_two(timer, 0, 22), 0x0999);
    EXPECT_EQ(read_two(timer, 0, 1021), 0x0000);
    EXPECT_EQ(read_two(timer, 0, 1022), 0x9999);
    EXPECT_EQ(timer.illegal_count_count, 0U);
    write_two(timer, 0, 0x000A, 1100);
    EXPECT_EQ(timer.illegal_count_count, 1U);
}

TEST(I82c54Programming, OneByteCountsClearTheOtherByte) {
    I82c54 timer = timer_in_mode(0, kMsb);
    timer.write(0, 2, 20);
    EXPECT_THAT(edges_until(timer, 10'000), ElementsAre(std::pair{20ULL + 513, true}));
}

TEST(I82c54Programming, ReadsAndWritesOfTwoBytesMayInterleave) {
    I82c54 timer = timer_in_mode(2, kBoth);
    write_two(timer, 0, 0x1234, 20);
    EXPECT_EQ(timer.read(0, 21), 0x34);
    timer.write(0, 0x78, 21);
    EXPECT_EQ(timer.read(0, 21), 0x12);
    timer.write(0, 0x56, 21);
    EXPECT_EQ(timer.output_period_t(0), 0x5678U);
}

TEST(I82c54Programming, CountersAreIndependent) {
    I82c54 timer;
    for (unsigned counter = 0; counter < 3; ++counter) {
        timer.set_periodic_clock(counter, counter + 1);
        timer.write(I82c54::kControlAddress, control(counter, kLsb, 0), 6);
        timer.write(static_cast<uint16_t>(counter), 10, 6);
    }
    // Pulses at multiples of 1, 2 and 3 after T-state 6; the eleventh ends the count.
    timer.advance(6 + 11 - 1);
    EXPECT_FALSE(timer.output(0));
    timer.advance(6 + 11);
    EXPECT_TRUE(timer.output(0));
    EXPECT_EQ(timer.next_event_t(), 6U + 22);
    timer.advance(6 + 22);
    EXPECT_TRUE(timer.output(1));
    EXPECT_EQ(timer.next_event_t(), 6U + 33);
    EXPECT_FALSE(timer.output(2));
}

TEST(I82c54Clock, PhaseSetsThePulses) {
    I82c54 timer;
    timer.advance(1003);
    timer.set_periodic_clock(0, 10, 7);
    timer.write(I82c54::kControlAddress, control(0, kLsb, 0), 1004);
    timer.write(0, 1, 1006);  // loaded at 1007, expired at 1017
    EXPECT_THAT(edges_until(timer, 2000), ElementsAre(std::pair{1017ULL, true}));
}

TEST(I82c54Clock, ManyPulsesAtOnceAreAsManyOneByOne) {
    for (const unsigned mode : {0u, 2u, 3u, 4u}) {
        for (const unsigned pulses : {1u, 2u, 7u, 400u, 65536u, 70000u}) {
            I82c54 one, many;
            for (I82c54* timer : {&one, &many}) {
                timer->set_external_clock(1);
                timer->write(3, static_cast<uint8_t>(0x70 | mode << 1), 10);
                timer->write(1, 100, 11);
                timer->write(1, 1, 12);  // 356
            }
            for (unsigned i = 0; i < pulses; ++i) one.clock_pulse(1, 20);
            many.clock_pulses(1, pulses, 20);
            EXPECT_TRUE(one == many) << "mode " << mode << ", " << pulses << " pulses";
        }
    }
}

TEST(I82c54Clock, ExternalPulsesAreCountedOneByOne) {
    I82c54 timer;
    timer.write(I82c54::kControlAddress, control(2, kBoth, 0), 10);
    write_two(timer, 2, 0, 10);
    timer.clock_pulse(2, 20);  // loads
    for (uint64_t t = 21; t < 321; ++t) {
        timer.clock_pulse(2, t);
    }
    EXPECT_EQ(timer.next_event_t(), kNever);
    EXPECT_EQ(read_two(timer, 2, 400), 0x10000 - 300);
}

TEST(I82c54Latch, HoldsTheCountUntilItIsRead) {
    I82c54 timer = timer_in_mode(2, kBoth);
    write_two(timer, 0, 0x1000, 20);
    timer.write(I82c54::kControlAddress, 0x00, 21);
    timer.write(I82c54::kControlAddress, 0x00, 25);  // ignored (figure 12 and text)
    EXPECT_EQ(read_two(timer, 0, 100), 0x1000);
    EXPECT_EQ(timer.lost_latch_count, 1U);
    EXPECT_EQ(timer.live_read_count, 0U);
    EXPECT_EQ(read_two(timer, 0, 121), 0x1000 - 100);  // live again
    timer.write(I82c54::kControlAddress, 0x00, 130);
    timer.write(I82c54::kControlAddress, control(0, kBoth, 2), 140);
    write_two(timer, 0, 0x2000, 140);
    EXPECT_EQ(read_two(timer, 0, 141), 0x2000) << "reprogramming drops the latched count";
}

TEST(I82c54Latch, LiveReadOfTwoBytesTearsAtACarry) {
    I82c54 timer = timer_in_mode(2, kBoth);
    write_two(timer, 0, 0x1001, 20);
    EXPECT_EQ(timer.read(0, 22), 0x00);  // of 1000h
    EXPECT_EQ(timer.read(0, 23), 0x0F);  // of 0FFFh: together 0F00h, 255 off
    EXPECT_EQ(timer.live_read_count, 2U);
}

TEST(I82c54ReadBack, StatusComesBeforeTheCount) {
    I82c54 timer = timer_in_mode(3, kBoth);
    write_two(timer, 0, 100, 20);
    timer.write(I82c54::kControlAddress, 0xC2, 25);  // count and status of counter 0
    EXPECT_EQ(timer.read(0, 90), kStatusOutput | kBoth | 3 << 1);
    EXPECT_EQ(read_two(timer, 0, 90), 100 - 2 * 4);
    EXPECT_EQ(read_two(timer, 0, 91), 100 - 2 * 20);  // second half cycle began at 71
}

TEST(I82c54ReadBack, LatchesSeveralCountersAtOnceAndIgnoresRepeats) {
    I82c54 timer;
    for (unsigned counter = 0; counter < 3; ++counter) {
        timer.set_periodic_clock(counter, 1);
        timer.write(I82c54::kControlAddress, control(counter, kLsb, 4), 10);
        timer.write(static_cast<uint16_t>(counter), 200, 10);
    }
    timer.write(I82c54::kControlAddress, 0xDC, 21);  // counts of counters 1 and 2
    timer.write(I82c54::kControlAddress, 0xDE, 31);  // counts of all: only counter 0 is new
    EXPECT_EQ(timer.read(0, 50), 200 - 20);
    EXPECT_EQ(timer.read(1, 50), 200 - 10);
    EXPECT_EQ(timer.read(2, 50), 200 - 10);
    EXPECT_EQ(timer.lost_latch_count, 2U);
}

TEST(I82c54ReadBack, RepeatedStatusLatchKeepsTheFirst) {
    I82c54 timer = timer_in_mode(0);
    timer.write(I82c54::kControlAddress, 0xE2, 15);
    timer.write(0, 1, 16);
    timer.advance(30);
    timer.write(I82c54::kControlAddress, 0xE2, 30);
    EXPECT_EQ(timer.read(0, 31), kStatusNull | kLsb);
    EXPECT_EQ(status_of(timer), kStatusOutput | kLsb);
}

TEST(I82c54ReadBack, NullCountFollowsFigure13) {
    I82c54 timer = timer_in_mode(2, kBoth);
    EXPECT_EQ(status_of(timer) & kStatusNull, kStatusNull) << "control word sets it";
    write_two(timer, 0, 10, 20);
    EXPECT_EQ(status_of(timer) & kStatusNull, kStatusNull) << "count written, not loaded";
    timer.advance(21);
    EXPECT_EQ(status_of(timer) & kStatusNull, 0) << "loaded";
    timer.write(0, 12, 22);
    EXPECT_EQ(status_of(timer) & kStatusNull, 0) << "the second byte sets it";
    timer.write(0, 0, 22);
    EXPECT_EQ(status_of(timer) & kStatusNull, kStatusNull);
    timer.advance(30);
    EXPECT_EQ(status_of(timer) & kStatusNull, kStatusNull);
    timer.advance(31);  // the cycle of 10 that began at 21 is over
    EXPECT_EQ(status_of(timer) & kStatusNull, 0);
}

TEST(I82c54ReadBack, StatusShowsTheControlWordAsWritten) {
    I82c54 timer;
    timer.write(I82c54::kControlAddress, 0xBF, 5);  // counter 2, both bytes, mode X11, BCD
    EXPECT_EQ(status_of(timer, 2), kStatusOutput | kStatusNull | 0x3F);
}

// -- Undefined things, marked --------------------------------------------------------------------

TEST(I82c54Undefined, CounterDoesNothingBeforeItsControlWord) {
    I82c54 timer;
    timer.set_periodic_clock(0, 1);
    timer.write(0, 5, 10);
    EXPECT_EQ(edges_until(timer, 1000), Edges{});
    EXPECT_FALSE(timer.output(0));
    EXPECT_EQ(timer.read(0, 1000), 0xA5);
    EXPECT_EQ(timer.unprogrammed_access_count, 2U);
    EXPECT_EQ(timer.read(I82c54::kControlAddress, 1000), kOpenBus);  // "no-operation, 3-state"
}

TEST(I82c54Undefined, CountBeforeItsLoadReadsThePattern) {
    I82c54 timer = timer_in_mode(1, kBoth);
    write_two(timer, 0, 7, 20);
    EXPECT_EQ(read_two(timer, 0, 30), I82c54::kUndefinedCount);
    EXPECT_EQ(timer.undefined_read_count, 2U);
}

// With the status in the same command software sees the null count bit and drops the count.
TEST(I82c54Undefined, CountWithItsStatusIsNoMistake) {
    I82c54 timer = timer_in_mode(1, kBoth);
    write_two(timer, 0, 7, 20);
    timer.write(I82c54::kControlAddress, 0xC2, 30);
    EXPECT_EQ(timer.read(0, 31) & 0x40, 0x40);
    EXPECT_EQ(read_two(timer, 0, 32), I82c54::kUndefinedCount);
    EXPECT_EQ(timer.undefined_read_count, 0U);
}

TEST(I82c54Undefined, ResetIsPowerUpAndKeepsTheWires) {
    I82c54 timer = timer_in_mode(2);
    timer.set_gate(0, false, 15);
    timer.write(0, 5, 20);
    timer.reset();
    EXPECT_EQ(timer.next_event_t(), kNever);
    EXPECT_FALSE(timer.output(0));
    timer.write(I82c54::kControlAddress, control(0, kLsb, 4), 30);
    timer.write(0, 5, 30);
    EXPECT_EQ(edges_until(timer, 100), Edges{}) << "the gate is still low";
    timer.set_gate(0, true, 100);
    EXPECT_EQ(timer.next_event_t(), 105U) << "the clock still runs";
}

TEST(I82c54Properties, TellOfCountersAndMistakes) {
    I82c54 timer = timer_in_mode(3);
    timer.write(0, 1, 20);
    const auto list = timer.properties();
    ASSERT_EQ(list.size(), 8U);
    EXPECT_THAT(list[0].value, testing::HasSubstr("mode 3 binary LSB"));
    EXPECT_EQ(list[1].value, "not programmed");
    EXPECT_EQ(list[6].name, "illegal counts");
    EXPECT_EQ(list[6].value, "1");
}

}  // namespace
