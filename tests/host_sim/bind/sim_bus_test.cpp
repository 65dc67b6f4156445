// sim_bus_test.cpp - an access of SimBus is the processor's instruction: its time, its effect, its
// interrupts. T-states: 8085A instruction set (IN, OUT 10; SIM, RIM, EI, DI, NOP 4; RET 10;
// accepted interrupt 12).
#include "host_sim/bind/sim_bus.hpp"

#include <gtest/gtest.h>

#include <stdexcept>
#include <vector>

namespace {

using host_sim::Interrupt;
using host_sim::SimBoard;
using host_sim::SimBus;
using host_sim::Stimulus;

TEST(SimBus, AccessesReachTheBoardAndTakeTime) {
    SimBoard board;
    SimBus::out<0x31>(77);
    EXPECT_EQ(board.state.motors.duty(1), 77);
    EXPECT_EQ(board.state.cpu.t, 10 + SimBoard::kWorkT);
    board.apply(Stimulus::Kind::detectors, 0, 0xA6);
    EXPECT_EQ(SimBus::in<0x25>(), 0xA6);
    EXPECT_EQ(board.state.violation_count, 0U);
    (void)SimBus::in<0x70>();
    EXPECT_EQ(board.state.violation_count, 1U);
}

TEST(SimBus, SimAndRimAreTheProcessors) {
    SimBoard board;
    SimBus::sim(0xC0 | 0x08 | 0x05);
    EXPECT_TRUE(board.state.cpu.sod);
    EXPECT_EQ(SimBus::rim(), 0x05);
    SimBus::enable_interrupts();
    EXPECT_EQ(SimBus::rim(), 0x08 | 0x05);
    SimBus::disable_interrupts();
    EXPECT_EQ(SimBus::rim(), 0x05);
    EXPECT_EQ(board.state.cpu.t, 6U * 4U);
}

class SimBusInterrupts : public testing::Test {
protected:
    void SetUp() override {
        board.handler = [this](Interrupt interrupt) {
            EXPECT_FALSE(board.state.cpu.interrupt_enable);
            seen.push_back(interrupt);
            if (interrupt == Interrupt::rst65) (void)SimBus::in<0x08>();
        };
        SimBus::out<0x13>(0x76);  // baud rate: counter 1, mode 3, 10
        SimBus::out<0x11>(10);
        SimBus::out<0x11>(0);
        SimBus::out<0x09>(0x4E);
        SimBus::out<0x09>(0x04);  // RxE
        SimBus::sim(0x08 | 0x05);
    }
    SimBoard board;
    std::vector<Interrupt> seen;
};

TEST_F(SimBusInterrupts, ComeBehindTheAccessThatFindsThemAndNotWhileDisabled) {
    board.apply(Stimulus::Kind::serial_byte, 0, 'x');
    board.elapse(2000);
    (void)SimBus::in<0x25>();
    EXPECT_TRUE(seen.empty());
    SimBus::enable_interrupts();
    EXPECT_TRUE(seen.empty());
    (void)SimBus::in<0x25>();
    EXPECT_EQ(seen, std::vector{Interrupt::rst65});
    (void)SimBus::in<0x25>();
    EXPECT_EQ(seen.size(), 1U);
    board.apply(Stimulus::Kind::serial_byte, 0, 'y');
    board.elapse(2000);
    (void)SimBus::in<0x25>();
    EXPECT_EQ(seen.size(), 2U);
    EXPECT_TRUE(board.state.cpu.interrupt_enable);
}

TEST_F(SimBusInterrupts, EndHaltAtTheirTime) {
    board.apply(Stimulus::Kind::serial_byte, 0, 'x');
    const uint64_t t = board.state.cpu.t;
    SimBus::enable_interrupts();
    SimBus::halt();
    EXPECT_EQ(seen.size(), 1U);
    // Ten bits of 160 T less half a stop bit, and 26 T; then the interrupt, IN, EI and RET.
    EXPECT_NEAR(static_cast<double>(board.state.cpu.t - t), 1520 + 26 + 12 + 20 + 14, 20);
}

TEST(SimBus, HaltWithoutHandlerIsRefused) {
    SimBoard board;
    EXPECT_THROW(SimBus::halt(), std::logic_error);
}

TEST(SimBus, BoardsNest) {
    SimBoard outer;
    {
        SimBoard inner;
        SimBus::out<0x30>(1);
    }
    SimBus::out<0x30>(2);
    EXPECT_EQ(outer.state.motors.duty(0), 2);
}

}  // namespace
