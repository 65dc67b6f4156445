// i82c54_test.cpp - 82C54 against its data sheet: counts and output edges of every mode, latches.
// Source       Intel 82C54 data sheet (231244): "Mode Definitions" and figures 15 to 20
// (waveforms),
//              figures 7 to 14 (programming, latches, null count), figure 21 (gate operations).
// Times        CLK period 1 T unless said: what is written at T-state t is loaded at t + 1.
#include "host_sim/chips/i82c54.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <initializer_list>
#include <utility>
#include <vector>

#include "tests/host_sim/chips/i82c54_reference.hpp"

namespace {

using host_sim::chips::I82c54;
using host_sim::chips::kNever;
using host_sim::chips::kOpenBus;
using testing::ElementsAre;

using Edges = std::vector<std::pair<uint64_t, bool>>;

constexpr uint8_t kLsb = 0x10;
constexpr uint8_t kMsb = 0x20;
constexpr uint8_t kBoth = 0x30;
constexpr uint8_t kBcd = 0x01;
constexpr uint8_t kStatusOutput = 0x80;
constexpr uint8_t kStatusNull = 0x40;

constexpr uint8_t control(unsigned counter, uint8_t access, unsigned mode, uint8_t bcd = 0) {
    return static_cast<uint8_t>(counter << 6 | access | mode << 1 | bcd);
}

/// A timer at T-state 10 whose counter 0 has its control word and runs from a clock of 1 T.
I82c54 timer_in_mode(unsigned mode, uint8_t access = kLsb) {
    I82c54 timer;
    timer.set_periodic_clock(0, 1);
    timer.write(I82c54::kControlAddress, control(0, access, mode), 10);
    return timer;
}

/// LSB of the count, read live at each of the next `size` T-states.
std::vector<int> counts(I82c54& timer, unsigned size) {
    std::vector<int> list;
    for (unsigned n = 0; n < size; ++n) {
        list.push_back(timer.read(0, timer.last_t + 1));
    }
    return list;
}

/// Output edges of counter 0 up to `end_t`, found from event to event.
Edges edges_until(I82c54& timer, uint64_t end_t) {
    Edges edges;
    bool level = timer.output(0);
    while (timer.next_event_t() <= end_t) {
        timer.advance(timer.next_event_t());
        if (timer.output(0) != level) {
            level = !level;
            edges.emplace_back(timer.last_t, level);
        }
    }
    timer.advance(end_t);
    EXPECT_EQ(timer.output(0), level) << "an edge that next_event_t() did not tell of";
    return edges;
}

uint8_t status_of(I82c54& timer, unsigned counter = 0) {
    timer.write(I82c54::kControlAddress, static_cast<uint8_t>(0xE0 | 2U << counter), timer.last_t);
    return timer.read(static_cast<uint16_t>(counter), timer.last_t);
}

uint16_t read_two(I82c54& timer, unsigned counter, uint64_t t) {
    const unsigned lsb = timer.read(static_cast<uint16_t>(counter), t);
    const unsigned msb = timer.read(static_cast<uint16_t>(counter), t);
    return static_cast<uint16_t>(msb << 8 | lsb);
}

void write_two(I82c54& timer, unsigned counter, unsigned count, uint64_t t) {
    timer.write(static_cast<uint16_t>(counter), static_cast<uint8_t>(count), t);
    timer.write(static_cast<uint16_t>(counter), static_cast<uint8_t>(count >> 8), t);
}

// -- Mode 0 --------------------------------------------------------------------------------------

TEST(I82c54Mode0, OutputRisesOneMoreClockThanTheCountAfterTheWrite) {
    I82c54 timer = timer_in_mode(0);
    EXPECT_FALSE(timer.output(0));
    timer.write(0, 4, 20);
    I82c54 copy = timer;
    EXPECT_THAT(edges_until(timer, 1'000'000), ElementsAre(std::pair{25ULL, true}));
    EXPECT_THAT(counts(copy, 7), ElementsAre(4, 3, 2, 1, 0, 0xFF, 0xFE));  // figure 15, first
}

TEST(I82c54Mode0, GateLowStopsTheCountOnly) {
    I82c54 timer = timer_in_mode(0);
    timer.write(0, 3, 20);
    EXPECT_THAT(counts(timer, 2), ElementsAre(3, 2));
    timer.set_gate(0, false, 22);
    EXPECT_THAT(counts(timer, 2), ElementsAre(2, 2));
    EXPECT_EQ(timer.next_event_t(), kNever);
    timer.set_gate(0, true, 24);
    EXPECT_THAT(edges_until(timer, 100), ElementsAre(std::pair{26ULL, true}));  // figure 15, second
}

TEST(I82c54Mode0, CountWrittenWhileGateIsLowIsLoadedAndRunsForItsValue) {
    I82c54 timer = timer_in_mode(0);
    timer.set_gate(0, false, 11);
    timer.write(0, 5, 20);
    EXPECT_THAT(counts(timer, 3), ElementsAre(5, 5, 5));
    timer.set_gate(0, true, 30);
    EXPECT_THAT(edges_until(timer, 100), ElementsAre(std::pair{35ULL, true}));
}

TEST(I82c54Mode0, NewCountIsLoadedOnTheNextClock) {
    I82c54 timer = timer_in_mode(0);
    timer.write(0, 3, 20);
    EXPECT_THAT(counts(timer, 3), ElementsAre(3, 2, 1));
    timer.write(0, 2, 23);
    EXPECT_THAT(counts(timer, 4), ElementsAre(2, 1, 0, 0xFF));  // figure 15, third
}

TEST(I82c54Mode0, NewCountSetsAnExpiredOutputLowAtOnce) {
    I82c54 timer = timer_in_mode(0);
    timer.write(0, 1, 20);
    timer.advance(30);
    EXPECT_TRUE(timer.output(0));
    timer.write(0, 1, 30);
    EXPECT_FALSE(timer.output(0));
    EXPECT_THAT(edges_until(timer, 100), ElementsAre(std::pair{32ULL, true}));
}

TEST(I82c54Mode0, FirstByteOfTwoStopsTheCountAndSetsOutputLow) {
    I82c54 timer = timer_in_mode(0, kBoth);
    write_two(timer, 0, 2, 20);
    timer.advance(50);
    EXPECT_TRUE(timer.output(0));
    timer.write(0, 0x04, 50);
    EXPECT_FALSE(timer.output(0));
    EXPECT_EQ(timer.next_event_t(), kNever);
    timer.write(0, 0x01, 60);
    EXPECT_THAT(edges_until(timer, 1000), ElementsAre(std::pair{60ULL + 0x104 + 1, true}));
}

// -- Mode 1 --------------------------------------------------------------------------------------

TEST(I82c54Mode1, TriggerStartsAPulseOfTheCount) {
    I82c54 timer = timer_in_mode(1);
    EXPECT_TRUE(timer.output(0));
    timer.set_gate(0, false, 11);
    timer.write(0, 3, 20);
    timer.advance(100);
    EXPECT_TRUE(timer.output(0)) << "armed, but not triggered";
    timer.set_gate(0, true, 100);
    I82c54 copy = timer;
    EXPECT_THAT(edges_until(timer, 1'000'000),
                ElementsAre(std::pair{101ULL, false}, std::pair{104ULL, true}));
    EXPECT_THAT(counts(copy, 5), ElementsAre(3, 2, 1, 0, 0xFF));  // figure 16, first
}

TEST(I82c54Mode1, IsRetriggerableAndIgnoresTheGateLevel) {
    I82c54 timer = timer_in_mode(1);
    timer.write(0, 3, 20);
    timer.set_gate(0, false, 30);
    timer.set_gate(0, true, 31);
    EXPECT_THAT(counts(timer, 3), ElementsAre(3, 2, 1));
    timer.set_gate(0, false, 34);
    timer.set_gate(0, true, 34);  // shorter than a clock: the edge flip-flop keeps it
    timer.set_gate(0, false, 34);
    EXPECT_THAT(counts(timer, 4), ElementsAre(3, 2, 1, 0));  // figure 16, second
    EXPECT_TRUE(timer.output(0));
}

TEST(I82c54Mode1, NewCountWaitsForTheNextTrigger) {
    I82c54 timer = timer_in_mode(1);
    timer.write(0, 2, 20);
    timer.set_gate(0, false, 30);
    timer.set_gate(0, true, 30);
    EXPECT_THAT(counts(timer, 2), ElementsAre(2, 1));
    timer.write(0, 4, 32);
    EXPECT_EQ(status_of(timer) & kStatusNull, kStatusNull);
    EXPECT_THAT(counts(timer, 3), ElementsAre(0, 0xFF, 0xFE));
    timer.set_gate(0, false, 35);
    timer.set_gate(0, true, 35);
    EXPECT_THAT(counts(timer, 2), ElementsAre(4, 3));  // figure 16, third
    EXPECT_EQ(status_of(timer) & kStatusNull, 0);
}

TEST(I82c54Mode1, TriggerWithoutACountStartsNothing) {
    I82c54 timer = timer_in_mode(1);
    timer.set_gate(0, false, 20);
    timer.set_gate(0, true, 20);
    timer.write(0, 3, 25);
    EXPECT_EQ(edges_until(timer, 100), Edges{});
}

// -- Mode 2 --------------------------------------------------------------------------------------

TEST(I82c54Mode2, OutputIsLowForOneClockInEveryCount) {
    I82c54 timer = timer_in_mode(2);
    EXPECT_TRUE(timer.output(0));
    timer.write(0, 3, 20);
    I82c54 copy = timer;
    EXPECT_THAT(
        edges_until(timer, 30),
        ElementsAre(std::pair{23ULL, false}, std::pair{24ULL, true}, std::pair{26ULL, false},
                    std::pair{27ULL, true}, std::pair{29ULL, false}, std::pair{30ULL, true}));
    EXPECT_THAT(counts(copy, 7), ElementsAre(3, 2, 1, 3, 2, 1, 3));  // figure 17, first
    EXPECT_EQ(copy.output_period_t(0), 3U);
}

TEST(I82c54Mode2, GateStopsAndItsEdgeReloads) {
    I82c54 timer = timer_in_mode(2);
    timer.write(0, 3, 20);
    EXPECT_THAT(counts(timer, 2), ElementsAre(3, 2));
    timer.set_gate(0, false, 22);
    EXPECT_THAT(counts(timer, 2), ElementsAre(2, 2));
    EXPECT_EQ(timer.output_period_t(0), 0U);
    timer.set_gate(0, true, 24);
    EXPECT_THAT(counts(timer, 4), ElementsAre(3, 2, 1, 3));  // figure 17, second
}

TEST(I82c54Mode2, GateLowDuringThePulseSetsOutputHighAtOnce) {
    I82c54 timer = timer_in_mode(2);
    timer.write(0, 3, 20);
    timer.advance(23);
    EXPECT_FALSE(timer.output(0));
    timer.set_gate(0, false, 23);
    EXPECT_TRUE(timer.output(0));
    timer.set_gate(0, true, 40);  // OUT goes low N clocks after the trigger
    EXPECT_THAT(edges_until(timer, 44),
                ElementsAre(std::pair{43ULL, false}, std::pair{44ULL, true}));
}

TEST(I82c54Mode2, NewCountWaitsForTheEndOfTheCycle) {
    I82c54 timer = timer_in_mode(2);
    timer.write(0, 4, 20);
    EXPECT_THAT(counts(timer, 2), ElementsAre(4, 3));
    timer.write(0, 5, 22);
    EXPECT_THAT(counts(timer, 8), ElementsAre(2, 1, 5, 4, 3, 2, 1, 5));  // figure 17, third
}

TEST(I82c54Mode2, NewCountComesEarlyWithATrigger) {
    I82c54 timer = timer_in_mode(2);
    timer.write(0, 9, 20);
    EXPECT_THAT(counts(timer, 2), ElementsAre(9, 8));
    timer.write(0, 3, 22);
    timer.set_gate(0, false, 22);
    timer.set_gate(0, true, 22);
    EXPECT_THAT(counts(timer, 4), ElementsAre(3, 2, 1, 3));
}

TEST(I82c54Mode2, HundredHertzTickOf3072KilohertzClock) {
    I82c54 timer = timer_in_mode(2, kBoth);
    write_two(timer, 0, 30'720, 20);
    // First low 30720 clocks after the write, then every 30720; 3072000 / 30720 = 100 per second.
    EXPECT_THAT(edges_until(timer, 20 + 61'441),
                ElementsAre(std::pair{30'740ULL, false}, std::pair{30'741ULL, true},
                            std::pair{61'460ULL, false}, std::pair{61'461ULL, true}));
    const uint64_t start_t = timer.last_t;
    EXPECT_EQ(edges_until(timer, start_t + 3'072'000).size(), 200U);
}

TEST(I82c54Mode2, CountOfOneIsIllegalAndKeepsOutputHigh) {
    I82c54 timer = timer_in_mode(2);
    timer.write(0, 1, 20);
    EXPECT_EQ(edges_until(timer, 1000), Edges{});
    EXPECT_EQ(timer.illegal_count_count, 1U);
    EXPECT_EQ(timer.output_period_t(0), 0U);
    timer.write(0, 3, 1000);  // loaded at 1001, low two clocks later
    EXPECT_THAT(edges_until(timer, 1003), ElementsAre(std::pair{1003ULL, false}));
}

// -- Mode 3 --------------------------------------------------------------------------------------

TEST(I82c54Mode3, EvenCountGivesTwoEqualHalves) {
    I82c54 timer = timer_in_mode(3);
    EXPECT_TRUE(timer.output(0));
    timer.write(0, 4, 20);
    I82c54 copy = timer;
    EXPECT_THAT(edges_until(timer, 29),
                ElementsAre(std::pair{23ULL, false}, std::pair{25ULL, true},
                            std::pair{27ULL, false}, std::pair{29ULL, true}));
    EXPECT_THAT(counts(copy, 6), ElementsAre(4, 2, 4, 2, 4, 2));  // figure 18, first
}

TEST(I82c54Mode3, OddCountIsHighOneClockLonger) {
    I82c54 timer = timer_in_mode(3);
    timer.write(0, 5, 20);
    I82c54 copy = timer;
    // "OUT will be high for (N + 1) / 2 counts and low for (N - 1) / 2 counts."
    EXPECT_THAT(edges_until(timer, 31),
                ElementsAre(std::pair{24ULL, false}, std::pair{26ULL, true},
                            std::pair{29ULL, false}, std::pair{31ULL, true}));
    // "The initial count minus one (an even number) is loaded ... decremented by two. One CLK pulse
    // after the count expires, OUT goes low"; from the low half it goes high when it expires.
    EXPECT_THAT(counts(copy, 8), ElementsAre(4, 2, 0, 4, 2, 4, 2, 0));
}

TEST(I82c54Mode3, SmallestCountsAreTwoAndThree) {
    I82c54 two = timer_in_mode(3);
    two.write(0, 2, 20);
    EXPECT_THAT(edges_until(two, 24), ElementsAre(std::pair{22ULL, false}, std::pair{23ULL, true},
                                                  std::pair{24ULL, false}));
    I82c54 three = timer_in_mode(3);
    three.write(0, 3, 20);
    EXPECT_THAT(edges_until(three, 26), ElementsAre(std::pair{23ULL, false}, std::pair{24ULL, true},
                                                    std::pair{26ULL, false}));
    I82c54 one = timer_in_mode(3);
    one.write(0, 1, 20);
    EXPECT_EQ(edges_until(one, 1000), Edges{});
    EXPECT_EQ(one.illegal_count_count, 1U);
}

TEST(I82c54Mode3, GateLowSetsOutputHighAndItsEdgeReloads) {
    I82c54 timer = timer_in_mode(3);
    timer.write(0, 6, 20);
    timer.advance(25);
    EXPECT_FALSE(timer.output(0));  // from 24
    timer.set_gate(0, false, 25);
    EXPECT_TRUE(timer.output(0));
    EXPECT_EQ(timer.next_event_t(), kNever);
    timer.set_gate(0, true, 40);
    I82c54 copy = timer;
    EXPECT_THAT(counts(copy, 4), ElementsAre(6, 4, 2, 6));
    EXPECT_THAT(edges_until(timer, 47),
                ElementsAre(std::pair{44ULL, false}, std::pair{47ULL, true}));
}

TEST(I82c54Mode3, NewCountWaitsForTheEndOfTheHalfCycle) {
    I82c54 timer = timer_in_mode(3);
    timer.write(0, 8, 20);
    timer.write(0, 4, 22);
    // High: 4 clocks from 21 on, of the old count. Low and on: 2 clocks, of the new one.
    EXPECT_THAT(edges_until(timer, 29), ElementsAre(std::pair{25ULL, false}, std::pair{27ULL, true},
                                                    std::pair{29ULL, false}));
}

TEST(I82c54Mode3, BaudClockDividesByTen) {
    I82c54 timer = timer_in_mode(3);
    timer.write(0, 10, 20);
    EXPECT_EQ(timer.output_period_t(0), 10U);  // 3.072 MHz / 10 / 16 = 19200 baud
    timer.watch_output(0, false);
    EXPECT_EQ(timer.next_event_t(), kNever) << "an unwatched output makes no events";
}

// -- Modes 4 and 5 -------------------------------------------------------------------------------

TEST(I82c54Mode4, StrobesOnceOneClockAfterTheCount) {
    I82c54 timer = timer_in_mode(4);
    EXPECT_TRUE(timer.output(0));
    timer.write(0, 3, 20);
    I82c54 copy = timer;
    // Low N + 1 clocks after the write, for one clock; the count runs on without a second strobe.
    EXPECT_THAT(edges_until(timer, 1'000'000),
                ElementsAre(std::pair{24ULL, false}, std::pair{25ULL, true}));
    EXPECT_THAT(counts(copy, 6), ElementsAre(3, 2, 1, 0, 0xFF, 0xFE));  // figure 19, first
}

TEST(I82c54Mode4, GateStopsTheCountButNotTheStrobe) {
    I82c54 timer = timer_in_mode(4);
    timer.set_gate(0, false, 11);
    timer.write(0, 3, 20);
    EXPECT_THAT(counts(timer, 3), ElementsAre(3, 3, 3));
    timer.set_gate(0, true, 23);
    EXPECT_THAT(counts(timer, 3), ElementsAre(2, 1, 0));  // figure 19, second
    EXPECT_FALSE(timer.output(0));
    timer.set_gate(0, false, 26);
    EXPECT_THAT(edges_until(timer, 100), ElementsAre(std::pair{27ULL, true}));
}

TEST(I82c54Mode4, NewCountIsLoadedOnTheNextClock) {
    I82c54 timer = timer_in_mode(4);
    timer.write(0, 3, 20);
    EXPECT_THAT(counts(timer, 3), ElementsAre(3, 2, 1));
    timer.write(0, 2, 23);
    I82c54 copy = timer;
    EXPECT_THAT(counts(copy, 4), ElementsAre(2, 1, 0, 0xFF));  // figure 19, third
    EXPECT_THAT(edges_until(timer, 100),
                ElementsAre(std::pair{26ULL, false}, std::pair{27ULL, true}));
}

TEST(I82c54Mode4, FirstByteOfTwoHasNoEffect) {
    I82c54 timer = timer_in_mode(4, kBoth);
    write_two(timer, 0, 5, 20);
    timer.write(0, 9, 22);
    EXPECT_THAT(edges_until(timer, 30),
                ElementsAre(std::pair{26ULL, false}, std::pair{27ULL, true}));
    timer.write(0, 0, 30);
    EXPECT_THAT(edges_until(timer, 100),
                ElementsAre(std::pair{40ULL, false}, std::pair{41ULL, true}));
}

TEST(I82c54Mode5, StrobesAfterTheTriggerAndIsRetriggerable) {
    I82c54 timer = timer_in_mode(5);
    timer.write(0, 3, 20);
    EXPECT_EQ(edges_until(timer, 30), Edges{});
    timer.set_gate(0, false, 30);
    timer.set_gate(0, true, 30);
    EXPECT_THAT(counts(timer, 2), ElementsAre(3, 2));
    timer.set_gate(0, false, 32);
    timer.set_gate(0, true, 32);
    timer.set_gate(0, false, 33);  // the level does not stop it
    I82c54 copy = timer;
    // Low N + 1 clocks after the trigger (figure 20).
    EXPECT_THAT(edges_until(timer, 1000),
                ElementsAre(std::pair{36ULL, false}, std::pair{37ULL, true}));
    EXPECT_THAT(counts(copy, 4), ElementsAre(2, 1, 0, 0xFF));
}

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

// -- Properties ----------------------------------------------------------------------------------

TEST(I82c54Speed, LongTimesNeedNoSteps) {
    for (unsigned mode = 0; mode < 6; ++mode) {
        I82c54 timer = timer_in_mode(mode);
        timer.write(0, 7, 20);
        timer.advance(1'000'000'000'000);  // would take minutes clock by clock
        EXPECT_TRUE(timer.output(0) || mode == 2 || mode == 3) << mode;
    }
    I82c54 timer = timer_in_mode(2);
    timer.write(0, 7, 20);
    timer.advance(21 + 7'000'000'000'006);
    EXPECT_EQ(timer.read(0, timer.last_t), 1);
    EXPECT_FALSE(timer.output(0));
}

using host_sim::chips_test::TimerReference;

/// One action on a counter; what it means depends on `kind`.
struct Action {
    uint8_t kind = 0;
    uint8_t mode = 0;
    bool bcd = false;
    uint16_t count = 0;
    uint32_t wait_t = 0;
};

rc::Gen<Action> any_action() {
    return rc::gen::apply(
        [](uint8_t kind, uint8_t mode, bool bcd, uint16_t count, uint32_t wait_t) {
            return Action{kind, mode, bcd, count, wait_t};
        },
        rc::gen::inRange<uint8_t>(0, 8), rc::gen::inRange<uint8_t>(0, 6),
        rc::gen::weightedElement<bool>({{3, false}, {1, true}}),
        rc::gen::oneOf(rc::gen::inRange<uint16_t>(2, 10), rc::gen::just<uint16_t>(0),
                       rc::gen::just<uint16_t>(0x1357)),
        rc::gen::oneOf(rc::gen::inRange<uint32_t>(0, 30), rc::gen::inRange<uint32_t>(0, 6000)));
}

/// Does one action to chip and reference (0 and 1 only wait).
void act(I82c54& timer, TimerReference& reference, const Action& action, uint64_t now_t) {
    switch (action.kind) {
        case 2:
            timer.write(I82c54::kControlAddress,
                        control(0, kBoth, action.mode, action.bcd ? kBcd : 0), now_t);
            reference.write_control(action.mode, action.bcd);
            break;
        case 3:
        case 4:
            write_two(timer, 0, action.count, now_t);
            reference.write_first_byte();
            reference.write_count(action.count);
            break;
        case 5:
            timer.set_gate(0, !reference.gate, now_t);
            reference.set_gate(!reference.gate);
            break;
        case 6:
            timer.write(0, static_cast<uint8_t>(action.count), now_t);
            timer.write(0, static_cast<uint8_t>(action.count >> 8), now_t + 3);
            break;
        default:
            break;
    }
}

RC_GTEST_PROP(I82c54Property, AgreesWithCountingClockByClock, ()) {
    const auto period_t = *rc::gen::element<uint64_t>(1, 1, 3);
    const auto actions = *rc::gen::container<std::vector<Action>>(any_action());
    I82c54 timer;
    timer.set_periodic_clock(0, period_t);
    timer.write(I82c54::kControlAddress, control(0, kBoth, 2), 0);
    TimerReference reference;
    reference.write_control(2, false);
    uint64_t now_t = 0;
    for (Action action : actions) {
        action.kind = action.kind == 6 ? uint8_t{1} : action.kind;
        act(timer, reference, action, now_t);
        RC_ASSERT(timer.output(0) == reference.output);
        const uint64_t end_t = now_t + action.wait_t;
        while (now_t < end_t) {
            ++now_t;
            const bool before = reference.output;
            if (now_t % period_t == 0) {
                reference.pulse();
            }
            RC_ASSERT((reference.output != before) == (timer.next_event_t() == now_t));
            if (timer.next_event_t() == now_t) {
                timer.advance(now_t);
                RC_ASSERT(timer.output(0) == reference.output);
            }
        }
        RC_ASSERT(read_two(timer, 0, now_t) == reference.count());
        RC_ASSERT(((status_of(timer) & kStatusNull) != 0) == reference.null_count);
    }
}

RC_GTEST_PROP(I82c54Property, OneStrideOrManyAndCopiesLeaveTheSameState, ()) {
    const auto actions = *rc::gen::container<std::vector<Action>>(any_action());
    const auto step_t = *rc::gen::inRange<uint64_t>(1, 400);
    I82c54 strides;
    strides.set_periodic_clock(0, *rc::gen::inRange<uint64_t>(1, 5), 1);
    strides.set_periodic_clock(1, 7);
    strides.write(I82c54::kControlAddress, control(1, kLsb, 3), 0);
    strides.write(1, 5, 0);
    I82c54 steps = strides;
    TimerReference ignored;
    uint64_t now_t = 10;
    for (const Action& action : actions) {
        TimerReference same = ignored;
        act(strides, ignored, action, now_t);
        act(steps, same, action, now_t);
        now_t += 3 + action.wait_t;
        strides.advance(now_t);
        while (steps.last_t < now_t) {
            steps.advance(std::min(now_t, steps.last_t + step_t));
        }
        RC_ASSERT(strides == steps);
        I82c54 copy = steps;
        RC_ASSERT(copy == steps);
        steps = copy;
    }
}

}  // namespace
