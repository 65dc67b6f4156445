// sod_watchdog_test.cpp - the driver of the watchdog. SIM: bits 7 SOD, 6 SOD enable, 4 reset RST
// 7.5, 3 mask set enable (8085A data sheet); consequences: the model of the one-shot.
#include "hal/chips/sod_watchdog.hpp"

#include <gtest/gtest.h>

#include "tests/hal/chips/parts.hpp"

namespace {

using hal_test::SimBoard;
using host_sim::SimBus;

// A type of its own for each test: the level that the driver remembers is its own too.
template <class Bus, int kTest>
struct OwnBus : Bus {};

TEST(SodWatchdogDriver, TogglesWithoutTouchingMasks) {
    hal_test::Script bus;
    using Watchdog = hal::SodWatchdog<OwnBus<test_support::RecordingBus, 1>>;
    Watchdog::toggle();
    Watchdog::toggle();
    Watchdog::toggle();
    Watchdog::set<true>();
    Watchdog::set<false>();
    EXPECT_EQ(bus.accesses(), "SIM=C0 SIM=40 SIM=C0 SIM=C0 SIM=40");
}

TEST(SodWatchdogDriver, EveryToggleIsAnEdgeFromResetOn) {
    SimBoard board;
    using Watchdog = hal::SodWatchdog<OwnBus<SimBus, 2>>;
    SimBus::sim(0x0D);  // RST 6.5 alone
    board.state.cpu.rst75_latch = true;
    for (unsigned i = 0; i < 20; ++i) {
        board.elapse(1'500'000);  // 0.5 s are 1,536,000 T
        Watchdog::toggle();
        EXPECT_EQ(board.state.cpu.sod, i % 2 == 0);
    }
    EXPECT_EQ(board.state.watchdog.fired_count, 0U);
    EXPECT_EQ(board.state.cpu.masks, 0x05);
    EXPECT_TRUE(board.state.cpu.rst75_latch);
    board.elapse(1'600'000);
    EXPECT_EQ(board.state.watchdog.fired_count, 1U);
}

}  // namespace
