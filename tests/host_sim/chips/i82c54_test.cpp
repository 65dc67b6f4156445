// i82c54_test.cpp - 82C54 against its data sheet: counts and output edges of every mode.
// Source       Intel 82C54 data sheet (231244): "Mode Definitions", figures 15 to 20
//              (waveforms of modes 0 to 5) and 21 (gate operations).
// Times        CLK period 1 T unless said: what is written at T-state t is loaded at t + 1.
#include "host_sim/chips/i82c54.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <utility>

#include "tests/host_sim/chips/i82c54_fixture.hpp"

namespace {

using namespace host_sim::chips_test;
using host_sim::chips::kNever;
using testing::ElementsAre;

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

TEST(I82c54Mode0, FirstByteOfTwoStopsARunningCount) {
    I82c54 timer = timer_in_mode(0, kBoth);
    write_two(timer, 0, 100, 20);
    timer.write(0, 7, 31);  // loaded at 21, so 90 are left
    EXPECT_EQ(read_two(timer, 0, 40), 90);
    EXPECT_EQ(timer.next_event_t(), kNever);
    timer.write(0, 0, 50);
    EXPECT_THAT(edges_until(timer, 1000), ElementsAre(std::pair{58ULL, true}));
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

}  // namespace
