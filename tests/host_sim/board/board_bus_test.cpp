// Decoding and wiring of RB-85: every port block, open bus, violations. Source: docs/spec/board.md.
#include "host_sim/board/board_bus.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <set>

#include "host_sim/board/board.hpp"
#include "host_sim/board/board_state.hpp"
#include "tests/support/trap_gate.hpp"

namespace {

using host_sim::BoardBus;
using host_sim::BoardState;
using host_sim::MemoryMap;
using host_sim::Stimulus;
using host_sim::Violation;

class BoardBusTest : public testing::Test {
protected:
    BoardState state;
    BoardBus bus{state};
    uint64_t t = 100;

    void SetUp() override { bus.reset(0); }
    void out(uint8_t port, uint8_t value) { bus.out(port, value, t += 20); }
    uint8_t in(uint8_t port) { return bus.in(port, t += 20); }
    void apply(Stimulus::Kind kind, uint8_t index, int32_t value) {
        bus.apply({t, kind, index, value});
    }
};

TEST_F(BoardBusTest, PortsThatNobodyAnswersReadOpenBusAndAreViolations) {
    const auto answered = [](unsigned port) {
        return port == 0x08 || port == 0x09 || (port >= 0x10 && port <= 0x1B) ||
               (port >= 0x20 && port <= 0x29) || (port >= 0x30 && port <= 0x3B);
    };
    const auto read_only = [](unsigned port) { return port == 0x2C; };
    for (unsigned port = 0; port < 256; ++port) {
        const uint64_t before = state.violation_count;
        const uint8_t value = in(static_cast<uint8_t>(port));
        const bool readable = answered(port) || read_only(port);
        EXPECT_EQ(state.violation_count - before, readable ? 0U : 1U) << port;
        if (!readable) {
            EXPECT_EQ(value, 0xFF) << port;
            EXPECT_EQ(state.last_violation.kind, Violation::Kind::unmapped_in);
            EXPECT_EQ(state.last_violation.address, port);
        }
        const uint64_t between = state.violation_count;
        out(static_cast<uint8_t>(port), 0x9B);
        EXPECT_EQ(state.violation_count - between, answered(port) ? 0U : 1U) << port;
    }
}

TEST_F(BoardBusTest, MotorLatchesTakeDutyAndSign) {
    for (uint8_t motor = 0; motor < 10; ++motor) {
        out(static_cast<uint8_t>(0x30 + motor), static_cast<uint8_t>(10 + motor));
    }
    out(0x3A, 0x21);
    out(0x3B, 0x02);
    EXPECT_EQ(state.motors.duty(0), -10);
    EXPECT_EQ(state.motors.duty(4), 14);
    EXPECT_EQ(state.motors.duty(5), -15);
    EXPECT_EQ(state.motors.duty(6), 16);
    EXPECT_EQ(state.motors.duty(7), -17);
    EXPECT_EQ(in(0x30), 0xFF);  // write-only
}

TEST_F(BoardBusTest, ParallelPortsAreInputsAfterReset) {
    EXPECT_EQ(state.ppis[0].port_output_mask(host_sim::chips::I82c55a::Port::a), 0);
    EXPECT_EQ(state.ppis[1].port_output_mask(host_sim::chips::I82c55a::Port::c), 0);
    EXPECT_FALSE(state.timers[0].counters[2].gate);  // no laser fires
    EXPECT_FALSE(state.range.select_line);
}

TEST_F(BoardBusTest, ConverterReadsTheSelectedSensor) {
    out(0x23, 0x82);
    for (uint8_t channel = 0; channel < 16; ++channel) {
        const auto count = static_cast<uint16_t>(channel * 273);
        apply(Stimulus::Kind::sensor, channel, host_sim::sensor_uv_of_count(count));
    }
    for (uint8_t channel = 0; channel < 16; ++channel) {
        out(0x20, channel);
        t += 100;  // multiplexer and amplifier settle: 2.64 + 10 us are 39 T
        out(0x28, 0);
        EXPECT_EQ(in(0x21) & 0x40, 0x40);
        t += 108;  // 35 us
        EXPECT_EQ(in(0x21) & 0x40, 0);
        const unsigned high = in(0x28);
        const unsigned low = in(0x29);
        EXPECT_EQ(high << 4 | low >> 4, channel * 273U) << int{channel};
        EXPECT_EQ(low & 0x0F, 0U);
    }
}

TEST_F(BoardBusTest, CarelessSoftwareReadsAMixtureOfTwoSensors) {
    out(0x23, 0x82);
    apply(Stimulus::Kind::sensor, 0, host_sim::sensor_uv_of_count(0));
    apply(Stimulus::Kind::sensor, 1, host_sim::sensor_uv_of_count(4000));
    out(0x20, 0);
    t += 1000;
    out(0x20, 1);
    out(0x28, 0);  // 20 T later: 6.5 us
    t += 200;
    const unsigned value = static_cast<unsigned>(in(0x28)) << 4 | in(0x29) >> 4U;
    EXPECT_GT(value, 10U);
    EXPECT_LT(value, 3990U);
    EXPECT_EQ(state.analog.unsettled_count, 1U);
}

TEST_F(BoardBusTest, TachometersCountDownTheirOwnCounter) {
    for (uint8_t wheel = 0; wheel < 6; ++wheel) {
        const auto base = static_cast<uint8_t>(wheel < 3 ? 0x14 : 0x18);
        const auto counter = static_cast<uint8_t>(wheel % 3);
        out(static_cast<uint8_t>(base + 3), static_cast<uint8_t>(counter << 6 | 0x34));  // mode 2
        out(static_cast<uint8_t>(base + counter), 0);
        out(static_cast<uint8_t>(base + counter), 0);  // 0 counts as 65536
        for (unsigned pulse = 0; pulse < 11U + wheel; ++pulse) {
            apply(Stimulus::Kind::tach_pulse, wheel, 0);
        }
        out(static_cast<uint8_t>(base + 3), static_cast<uint8_t>(counter << 6));  // latch
        const unsigned low = in(static_cast<uint8_t>(base + counter));
        const unsigned high = in(static_cast<uint8_t>(base + counter));
        // The first pulse loads the count, each later one takes 1 off.
        EXPECT_EQ(high << 8 | low, 0x10000U - (10U + wheel)) << int{wheel};
    }
}

TEST_F(BoardBusTest, PresenceBufferTellsWhichTachometersArePluggedIn) {
    EXPECT_EQ(in(0x2C), 0xFF);
    apply(Stimulus::Kind::tach_connected, 1, 0);
    apply(Stimulus::Kind::tach_connected, 4, 0);
    EXPECT_EQ(in(0x2C), 0xED);
    bus.reset(t);
    EXPECT_EQ(in(0x2C), 0xED);
    apply(Stimulus::Kind::tach_connected, 1, 1);
    EXPECT_EQ(in(0x2C), 0xEF);
}

TEST_F(BoardBusTest, DirectionBitsDetectorsAndTrapCauseAreRead) {
    EXPECT_EQ(in(0x21) & 0x80, 0);
    apply(Stimulus::Kind::tach_forward, 0, 0);
    apply(Stimulus::Kind::tach_forward, 3, 0);
    EXPECT_EQ(in(0x21) & 0x3F, 0x36);
    apply(Stimulus::Kind::tach_forward, 3, 1);
    EXPECT_EQ(in(0x21) & 0x3F, 0x3E);
    apply(Stimulus::Kind::detectors, 0, 0x5A);
    EXPECT_EQ(in(0x25), 0x5A);
    apply(Stimulus::Kind::undervoltage, 0, 1);
    EXPECT_FALSE(state.cpu.pin(host_sim::Pin::trap).level) << "the gate is closed";
    test_support::open_trap_gate(state);
    EXPECT_EQ(in(0x21) & 0x80, 0x80);
    EXPECT_TRUE(state.cpu.pin(host_sim::Pin::trap).level);
    apply(Stimulus::Kind::undervoltage, 0, 0);
    apply(Stimulus::Kind::bumper, 0, 1);
    EXPECT_EQ(in(0x21) & 0x80, 0);
    EXPECT_TRUE(state.cpu.pin(host_sim::Pin::trap).level);
}

TEST_F(BoardBusTest, LaserOpensTheGateOfItsCounter) {
    out(0x23, 0x82);
    out(0x22, 0x04);
    EXPECT_TRUE(state.timers[0].counters[2].gate);
    out(0x22, 0x00);
    EXPECT_FALSE(state.timers[0].counters[2].gate);
}

TEST_F(BoardBusTest, RangeModuleIsReadByteByByte) {
    state.range.set_scan(0x05, {100, 0, -3, 0, 0, 0, 0, 0});
    out(0x27, 0x93);
    out(0x26, 0x20);  // SELECT, STROBE low
    std::vector<uint8_t> frame;
    uint8_t strobe = 0;
    for (unsigned i = 0; i < 19; ++i) {
        t += 100;  // 20 us are 62 T
        EXPECT_EQ(in(0x26) & 0x01, strobe) << i;
        frame.push_back(in(0x24));
        strobe ^= 1;
        out(0x26, static_cast<uint8_t>(0x20 | strobe << 4));
    }
    EXPECT_EQ(frame[0], 1);     // scan counter
    EXPECT_EQ(frame[1], 0x05);  // present
    unsigned sum = 0;
    for (const uint8_t byte : frame) sum += byte;
    EXPECT_EQ(sum & 0xFF, 0xA5U);
}

TEST_F(BoardBusTest, BaudRateFollowsItsCounter) {
    out(0x13, 0x56);
    out(0x11, 10);
    EXPECT_EQ(state.usart.clock_period_t, 10U);
    out(0x13, 0x56);
    out(0x11, 20);
    EXPECT_EQ(state.usart.clock_period_t, 20U);
}

TEST_F(BoardBusTest, UnmappedMemoryReadsOpenBusAndReportsWrites) {
    BoardState small(MemoryMap{0x7FFF, 0x8000, 0x87FF});
    BoardBus small_bus(small);
    small_bus.set_instruction_pc(0x1234);
    small_bus.write(0x87FF, 0x55, 10);
    EXPECT_EQ(small_bus.read(0x87FF, 13), 0x55);
    EXPECT_EQ(small.violation_count, 0U);
    small_bus.write(0x8800, 0x55, 20);
    EXPECT_EQ(small_bus.read(0x8800, 23), 0xFF);
    const Violation expected{Violation::Kind::unmapped_write, 0x1234, 0x8800, 0x55, 20};
    EXPECT_EQ(small.first_violation, expected);
    EXPECT_EQ(small.violation_count, 1U);
}

TEST_F(BoardBusTest, ProtectedEepromIgnoresAStrayWriteAndReportsIt) {
    bus.write(0x0123, 0x00, 50);
    EXPECT_EQ(state.violation_count, 1U);
    EXPECT_EQ(state.last_violation.kind, Violation::Kind::eeprom_write);
    bus.advance(50 + 40'000);
    EXPECT_EQ(bus.read(0x0123, 50'000), 0xFF);
}

TEST_F(BoardBusTest, UnfinishedEepromCommandIsReportedWhenItsCycleEnds) {
    bus.write(0x5555, 0xAA, 50);
    EXPECT_EQ(state.violation_count, 0U);
    bus.advance(100'000);
    EXPECT_EQ(state.violation_count, 1U);
    EXPECT_EQ(state.last_violation.kind, Violation::Kind::eeprom_write);
    EXPECT_EQ(state.last_violation.address, 0x5555);
}

TEST_F(BoardBusTest, UnlockedEepromTakesAByteAndAnswersWithItsComplementMeanwhile) {
    bus.write(0x5555, 0xAA, 50);
    bus.write(0x2AAA, 0x55, 60);
    bus.write(0x5555, 0xA0, 70);
    bus.write(0x0123, 0x4C, 80);
    EXPECT_EQ(state.violation_count, 0U);
    // DATA polling: bit 7 of the last byte, inverted, at any address until 10 ms are over.
    EXPECT_EQ(bus.read(0x0123, 90) & 0x80, 0x80);
    EXPECT_EQ(bus.read(0x7000, 30'000) & 0x80, 0x80);
    const uint64_t longest_t = 80 + 461 + 30'720;  // 150 us for more bytes, then 10 ms
    EXPECT_EQ(bus.read(0x0123, longest_t + 1), 0x4C);
    EXPECT_EQ(bus.read(0x0122, longest_t + 4), 0xFF);
}

}  // namespace
