// i82c54_test.cpp - the driver of the 82C54. Accesses: Intel 82C54 data sheet (231244),
// "Programming the 82C54"; consequences: the chip's model.
#include "hal/chips/i82c54.hpp"

#include <gtest/gtest.h>

#include "tests/hal/chips/parts.hpp"

namespace {

using hal_test::Recorded;
using hal_test::Script;
using hal_test::SimBoard;
using hal_test::Simulated;
using hal_test::Stimulus;
using TimerA = Recorded::TimerA;

// Control word: counter, both bytes (11), mode, binary; then LSB, MSB.
TEST(I82c54Accesses, StartIsControlWordAndTwoBytes) {
    Script bus;
    TimerA::start<0, TimerA::Mode::rate_generator>(30720);  // 7800h
    EXPECT_EQ(bus.accesses(), "13=34 10=00 10=78");
    TimerA::start<1, TimerA::Mode::square_wave>(10);
    EXPECT_EQ(bus.accesses(), "13=76 11=0A 11=00");
    TimerA::start<2, TimerA::Mode::terminal_count>(0x1234);
    EXPECT_EQ(bus.accesses(), "13=B0 12=34 12=12");
    TimerA::start<2, TimerA::Mode::software_strobe>(1);
    EXPECT_EQ(bus.accesses(), "13=B8 12=01 12=00");
}

TEST(I82c54Accesses, CountIsLatchedThenLowThenHigh) {
    Script bus;
    bus.in(0x12, {0x34, 0x12});
    EXPECT_EQ(TimerA::count<2>(), 0x1234);
    EXPECT_EQ(bus.accesses(), "13=80 <12 <12");
}

// Read-back command 11, COUNT bar, STATUS bar, counters 2 to 0, 0.
TEST(I82c54Accesses, ReadBackLatchesAllThree) {
    Script bus;
    bus.in(0x14, {0x01, 0x02});
    bus.in(0x15, {0x03, 0x04});
    bus.in(0x16, {0x05, 0x06});
    using TimerB = Recorded::TimerB;
    TimerB::latch_counts();
    EXPECT_EQ(TimerB::latched_count<0>(), 0x0201);
    EXPECT_EQ(TimerB::latched_count<1>(), 0x0403);
    EXPECT_EQ(TimerB::latched_count<2>(), 0x0605);
    EXPECT_EQ(bus.accesses(), "17=DE <14 <14 <15 <15 <16 <16");
}

TEST(I82c54Accesses, PulsesAreStatusThenCount) {
    Script bus;
    using TimerC = Recorded::TimerC;
    TimerC::start_pulses<2>();
    EXPECT_EQ(bus.accesses(), "1B=B0 1A=FE 1A=FF");
    bus.in(0x18, {0x30, 0xFD, 0xFF});  // loaded; the complement of 2
    bus.in(0x19, {0x70, 0xA5, 0xA5});  // null count
    TimerC::latch_pulses();
    EXPECT_EQ(TimerC::pulses<0>(), 2);
    EXPECT_EQ(TimerC::pulses<1>(), 0);
    EXPECT_EQ(bus.accesses(), "1B=CE <18 <18 <18 <19 <19 <19");
}

TEST(I82c54Accesses, AllThreeAreStartedByteByByte) {
    Script bus;
    Recorded::TimerB::start_all_pulses();
    EXPECT_EQ(bus.accesses(), "17=30 17=70 17=B0 14=FE 15=FE 16=FE 14=FF 15=FF 16=FF");
}

/// What no program should do to a timer.
void expect_no_misuse(const SimBoard& board) {
    for (const auto& timer : board.state.timers) {
        EXPECT_EQ(timer.unprogrammed_access_count, 0U);
        EXPECT_EQ(timer.undefined_read_count, 0U);
        EXPECT_EQ(timer.live_read_count, 0U);
        EXPECT_EQ(timer.lost_latch_count, 0U);
        EXPECT_EQ(timer.illegal_count_count, 0U);
    }
}

class I82c54Pulses : public testing::Test {
protected:
    void SetUp() override { start(); }
    static void start() { Simulated::TimerB::start_all_pulses(); }
    void pulse(uint8_t wheel, unsigned count) {
        for (unsigned i = 0; i < count; ++i) board.apply(Stimulus::Kind::tach_pulse, wheel, 0);
    }

    SimBoard board;
};

// Every count modulo 2^16, more than one turn, and none is lost at either end.
TEST_F(I82c54Pulses, AreCountedModulo65536FromTheFirst) {
    for (unsigned expected = 0; expected < 0x10000 + 300; ++expected) {
        if (expected < 300 || expected % 37 == 0 || expected > 0xFF00) {
            Simulated::TimerB::latch_pulses();
            ASSERT_EQ(Simulated::TimerB::pulses<0>(), expected & 0xFFFF);
            ASSERT_EQ(Simulated::TimerB::pulses<1>(), 0);
            ASSERT_EQ(Simulated::TimerB::pulses<2>(), 0);
        }
        pulse(0, 1);
    }
    expect_no_misuse(board);
}

TEST_F(I82c54Pulses, AreOfOneMomentWhileTheyComeBetweenTheReads) {
    pulse(1, 256);
    Simulated::TimerB::latch_pulses();
    EXPECT_EQ(Simulated::TimerB::pulses<0>(), 0);
    pulse(1, 1);
    pulse(2, 3);
    EXPECT_EQ(Simulated::TimerB::pulses<1>(), 256);
    EXPECT_EQ(Simulated::TimerB::pulses<2>(), 0);
    Simulated::TimerB::latch_pulses();
    EXPECT_EQ(Simulated::TimerB::pulses<0>(), 0);
    EXPECT_EQ(Simulated::TimerB::pulses<1>(), 257);
    EXPECT_EQ(Simulated::TimerB::pulses<2>(), 3);
    expect_no_misuse(board);
}

// The part has no RESET pin: the processor starts anew in the middle of a read, and the counters
// go on meanwhile.
TEST_F(I82c54Pulses, StartAnewBehindAResetInMidRead) {
    pulse(0, 1000);
    Simulated::TimerB::latch_pulses();
    (void)host_sim::SimBus::in<0x14>();
    pulse(0, 5);
    start();
    Simulated::TimerB::latch_pulses();
    EXPECT_EQ(Simulated::TimerB::pulses<0>(), 0);
    pulse(0, 2);
    Simulated::TimerB::latch_pulses();
    EXPECT_EQ(Simulated::TimerB::pulses<0>(), 2);
}

TEST_F(I82c54Pulses, EachWheelHasItsCounter) {
    Simulated::TimerC::start_pulses<0>();
    Simulated::TimerC::start_pulses<1>();
    Simulated::TimerC::start_pulses<2>();
    for (uint8_t wheel = 0; wheel < 6; ++wheel) pulse(wheel, 10U + wheel);
    Simulated::TimerB::latch_pulses();
    Simulated::TimerC::latch_pulses();
    EXPECT_EQ(Simulated::TimerB::pulses<0>(), 10);
    EXPECT_EQ(Simulated::TimerB::pulses<1>(), 11);
    EXPECT_EQ(Simulated::TimerB::pulses<2>(), 12);
    EXPECT_EQ(Simulated::TimerC::pulses<0>(), 13);
    EXPECT_EQ(Simulated::TimerC::pulses<1>(), 14);
    EXPECT_EQ(Simulated::TimerC::pulses<2>(), 15);
}

// Counter 0 counts CLK OUT: between two reads as many as T-states have passed, across 256 too.
TEST(I82c54OnTheModel, CountIsOfOneMomentWhileItCounts) {
    SimBoard board;
    using Timer = Simulated::TimerA;
    Timer::start<0, Timer::Mode::rate_generator>(30720);
    board.elapse(50);
    for (unsigned i = 0; i < 2000; ++i) {
        const uint16_t first = Timer::count<0>();
        const uint16_t second = Timer::count<0>();
        const unsigned between = (first + 30720U - second) % 30720U;
        ASSERT_EQ(between, 3 * (10 + SimBoard::kWorkT)) << i;
    }
    expect_no_misuse(board);
}

TEST(I82c54OnTheModel, TickComes100TimesASecond) {
    SimBoard board;
    using Timer = Simulated::TimerA;
    Timer::start<hal::rb85::kTickCounter, Timer::Mode::rate_generator>(hal::rb85::kTickCount);
    unsigned ticks = 0;
    board.handler = [&](host_sim::Interrupt interrupt) {
        EXPECT_EQ(interrupt, host_sim::Interrupt::rst75);
        ++ticks;
    };
    host_sim::SimBus::sim(0x1B);  // RST 7.5 alone; what power-on left in its latch is gone
    host_sim::SimBus::enable_interrupts();
    for (unsigned i = 0; i < 50; ++i) host_sim::SimBus::halt();
    EXPECT_EQ(ticks, 50U);
    EXPECT_NEAR(static_cast<double>(board.state.cpu.t), 50 * 30720.0, 200.0);
}

}  // namespace
