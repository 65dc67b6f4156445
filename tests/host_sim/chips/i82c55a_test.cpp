// i82c55a_test.cpp - the parallel interface against the Intel 82C55A data sheet: mode definitions,
// status words and handshake sequences of its figures.
#include "host_sim/chips/i82c55a.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <string>
#include <vector>

namespace {

using host_sim::chips::I82c55a;
using host_sim::chips::kNever;
using Port = I82c55a::Port;

constexpr uint16_t kA = 0;
constexpr uint16_t kB = 1;
constexpr uint16_t kC = 2;
constexpr uint16_t kControl = 3;

/// The part with short names; time means nothing to it.
struct Bench {
    I82c55a chip;
    void out(uint16_t address, int value) { chip.write(address, static_cast<uint8_t>(value), 0); }
    int in(uint16_t address) { return chip.read(address, 0); }
    void set_bit(int bit, int level) { out(kControl, bit << 1 | level); }
    void pins(Port port, int value, int mask = 0xFF) {
        chip.set_port_input(port, static_cast<uint8_t>(value), static_cast<uint8_t>(mask), 0);
    }
    void pin_c(int bit, int level) { pins(Port::c, level << bit, 1 << bit); }
    int driven_c(int bit) const {
        return (chip.port_output_mask(Port::c) >> bit & 1) == 0
                   ? -1
                   : chip.port_output(Port::c) >> bit & 1;
    }
};

TEST(I82c55a, ResetMakesEveryPinAnInputHeldHigh) {
    Bench bench;
    bench.out(kControl, 0x80);
    bench.out(kA, 0x12);
    bench.chip.reset();
    EXPECT_EQ(bench.in(kControl), 0x9B);
    for (const Port port : {Port::a, Port::b, Port::c}) {
        EXPECT_EQ(bench.chip.port_output_mask(port), 0x00);
        EXPECT_EQ(bench.chip.port_output(port), 0xFF);
        EXPECT_EQ(bench.chip.port_level(port), 0xFF);
    }
    EXPECT_EQ(bench.in(kA), 0xFF);
    EXPECT_EQ(bench.in(kB), 0xFF);
    EXPECT_EQ(bench.in(kC), 0xFF);
    EXPECT_EQ(bench.chip.next_event_t(), kNever);
    EXPECT_EQ(bench.chip, I82c55a{}) << "as after power-on";
}

// All 16 words of mode 0: bit 4 port A, bit 3 upper C, bit 1 port B, bit 0 lower C; 1 is input.
TEST(I82c55a, Mode0HasSixteenCombinationsOfDirections) {
    for (int directions = 0; directions < 16; ++directions) {
        const bool a_in = (directions & 8) != 0;
        const bool upper_in = (directions & 4) != 0;
        const bool b_in = (directions & 2) != 0;
        const bool lower_in = (directions & 1) != 0;
        const int word = 0x80 | (a_in ? 0x10 : 0) | (upper_in ? 0x08 : 0) | (b_in ? 0x02 : 0) |
                         (lower_in ? 0x01 : 0);
        Bench bench;
        bench.pins(Port::a, 0x5A);
        bench.pins(Port::b, 0x69);
        bench.pins(Port::c, 0x3C);
        bench.out(kControl, word);
        EXPECT_EQ(bench.in(kControl), word);
        bench.out(kA, 0xA1);
        bench.out(kB, 0xB2);
        bench.out(kC, 0xC3);
        const int output_c = (upper_in ? 0 : 0xF0) | (lower_in ? 0 : 0x0F);
        EXPECT_EQ(bench.chip.port_output_mask(Port::a), a_in ? 0 : 0xFF);
        EXPECT_EQ(bench.chip.port_output_mask(Port::b), b_in ? 0 : 0xFF);
        EXPECT_EQ(bench.chip.port_output_mask(Port::c), output_c);
        EXPECT_EQ(bench.chip.port_output(Port::a), a_in ? 0xFF : 0xA1);
        EXPECT_EQ(bench.chip.port_output(Port::b), b_in ? 0xFF : 0xB2);
        EXPECT_EQ(bench.chip.port_output(Port::c), 0xC3 | (~output_c & 0xFF));
        EXPECT_EQ(bench.in(kA), a_in ? 0x5A : 0xA1);
        EXPECT_EQ(bench.in(kB), b_in ? 0x69 : 0xB2);
        EXPECT_EQ(bench.in(kC), (0xC3 & output_c) | (0x3C & ~output_c));
        EXPECT_FALSE(bench.chip.interrupt_a() || bench.chip.interrupt_b());
        EXPECT_EQ(bench.chip.input_write_count,
                  static_cast<uint64_t>((a_in ? 1 : 0) + (b_in ? 1 : 0) + (output_c == 0 ? 1 : 0)));
    }
}

TEST(I82c55a, Mode0InputsAreNotLatched) {
    Bench bench;
    bench.pins(Port::a, 0x11);
    EXPECT_EQ(bench.in(kA), 0x11);
    bench.pins(Port::a, 0x22);
    EXPECT_EQ(bench.in(kA), 0x22);
    bench.pins(Port::a, 0xFF, 0x0F);
    EXPECT_EQ(bench.in(kA), 0x2F) << "pins outside of the mask keep their level";
}

TEST(I82c55a, EveryModeWordClearsTheOutputLatches) {
    Bench bench;
    bench.out(kControl, 0x80);
    bench.out(kA, 0x12);
    bench.out(kB, 0x34);
    bench.out(kC, 0x56);
    bench.out(kControl, 0x80);
    EXPECT_EQ(bench.in(kA), 0);
    EXPECT_EQ(bench.in(kB), 0);
    EXPECT_EQ(bench.in(kC), 0);
    EXPECT_EQ(bench.chip.port_output(Port::c), 0);
}

TEST(I82c55a, BitSetAndResetTouchOneBitOfPortC) {
    for (int bit = 0; bit < 8; ++bit) {
        Bench bench;
        bench.out(kControl, 0x80);
        bench.set_bit(bit, 1);
        EXPECT_EQ(bench.in(kC), 1 << bit);
        EXPECT_EQ(bench.chip.port_output(Port::c), 1 << bit);
        bench.out(kC, 0xFF);
        bench.set_bit(bit, 0);
        EXPECT_EQ(bench.in(kC), 0xFF & ~(1 << bit));
        EXPECT_EQ(bench.in(kControl), 0x80) << "no mode word";
    }
}

TEST(I82c55a, BitOfAnInputDrivesNothingAndIsCounted) {
    Bench bench;
    bench.out(kControl, 0x88);  // upper C input
    bench.set_bit(7, 0);
    bench.set_bit(3, 1);
    EXPECT_EQ(bench.in(kC), 0xF8);
    EXPECT_EQ(bench.chip.port_output(Port::c), 0xF8);
    EXPECT_EQ(bench.chip.input_write_count, 1u);
}

TEST(I82c55a, OnlyTwoAddressLinesAreWired) {
    Bench bench;
    bench.out(0x83, 0x80);
    bench.out(0x44, 0x12);
    EXPECT_EQ(bench.in(0), 0x12);
}

// Data sheet, mode 1 strobed input: STB low sets IBF; INTR is set when STB is high again, IBF is
// high and INTE is set; the read resets INTR and then IBF.
TEST(I82c55a, Mode1InputOfPortA) {
    Bench bench;
    bench.out(kControl, 0xB0);  // A mode 1 input, PC7 and PC6 outputs, B mode 0 output
    EXPECT_EQ(bench.driven_c(5), 0) << "IBF";
    EXPECT_EQ(bench.driven_c(3), 0) << "INTR";
    EXPECT_EQ(bench.driven_c(4), -1) << "STB is an input";
    bench.set_bit(4, 1);  // INTE A
    EXPECT_EQ(bench.in(kC) & 0x38, 0x10) << "the status shows INTE in the place of STB";
    bench.pins(Port::a, 0x41);
    bench.pin_c(4, 0);
    EXPECT_EQ(bench.driven_c(5), 1);
    EXPECT_EQ(bench.driven_c(3), 0) << "STB is still low";
    bench.pins(Port::a, 0x42);  // transparent while STB is low
    bench.pin_c(4, 1);
    EXPECT_EQ(bench.driven_c(3), 1);
    EXPECT_TRUE(bench.chip.interrupt_a());
    EXPECT_EQ(bench.in(kC) & 0x38, 0x38);
    bench.pins(Port::a, 0x43);  // after the rising edge: not seen
    EXPECT_EQ(bench.in(kA), 0x42);
    EXPECT_EQ(bench.driven_c(5), 0);
    EXPECT_FALSE(bench.chip.interrupt_a());
    EXPECT_EQ(bench.chip.empty_read_count, 0u);
    EXPECT_EQ(bench.in(kA), 0x42) << "the latch keeps the byte";
    EXPECT_EQ(bench.chip.empty_read_count, 1u);
}

TEST(I82c55a, Mode1InputWithoutEnableRaisesNoInterrupt) {
    Bench bench;
    bench.out(kControl, 0xB0);
    bench.pin_c(4, 0);
    bench.pin_c(4, 1);
    EXPECT_FALSE(bench.chip.interrupt_a());
    bench.set_bit(4, 1);
    EXPECT_TRUE(bench.chip.interrupt_a()) << "enabled later: the request is there";
    bench.set_bit(4, 0);
    EXPECT_FALSE(bench.chip.interrupt_a());
}

TEST(I82c55a, StrobeOverAnUnreadByteIsCountedAndTheNewByteWins) {
    Bench bench;
    bench.out(kControl, 0xB0);
    for (const int value : {0x01, 0x02}) {
        bench.pins(Port::a, value);
        bench.pin_c(4, 0);
        bench.pin_c(4, 1);
    }
    EXPECT_EQ(bench.chip.strobe_overrun_count, 1u);
    EXPECT_EQ(bench.in(kA), 0x02);
}

// Data sheet, mode 1 strobed output: WR clears INTR and pulls OBF low; ACK low releases OBF; INTR
// is set when ACK is high again, OBF is high and INTE is set.
TEST(I82c55a, Mode1OutputOfPortA) {
    Bench bench;
    bench.out(kControl, 0xA0);  // A mode 1 output, PC5 and PC4 outputs
    EXPECT_EQ(bench.driven_c(7), 1) << "OBF is active low";
    EXPECT_EQ(bench.driven_c(6), -1) << "ACK is an input";
    bench.set_bit(6, 1);  // INTE A
    EXPECT_TRUE(bench.chip.interrupt_a()) << "the buffer is empty";
    bench.out(kA, 0x77);
    EXPECT_FALSE(bench.chip.interrupt_a());
    EXPECT_EQ(bench.driven_c(7), 0);
    EXPECT_EQ(bench.chip.port_output(Port::a), 0x77);
    EXPECT_EQ(bench.in(kC) & 0xC8, 0x40) << "OBF low, INTE set, no INTR";
    bench.pin_c(6, 0);
    EXPECT_EQ(bench.driven_c(7), 1);
    EXPECT_FALSE(bench.chip.interrupt_a()) << "ACK is still low";
    bench.pin_c(6, 1);
    EXPECT_TRUE(bench.chip.interrupt_a());
    EXPECT_EQ(bench.in(kC) & 0xC8, 0xC8);
    EXPECT_EQ(bench.in(kA), 0x77) << "output latch";
}

TEST(I82c55a, ByteOverAnUnacknowledgedOneIsCounted) {
    Bench bench;
    bench.out(kControl, 0xA0);
    bench.out(kA, 1);
    bench.out(kA, 2);
    EXPECT_EQ(bench.chip.output_overrun_count, 1u);
    EXPECT_EQ(bench.chip.port_output(Port::a), 2);
}

TEST(I82c55a, Mode1InputOfPortB) {
    Bench bench;
    bench.out(kControl, 0x86);  // B mode 1 input, A mode 0 output, C output
    bench.set_bit(2, 1);        // INTE B
    bench.pins(Port::b, 0x5C);
    bench.pin_c(2, 0);
    EXPECT_EQ(bench.driven_c(1), 1) << "IBF";
    bench.pin_c(2, 1);
    EXPECT_TRUE(bench.chip.interrupt_b());
    EXPECT_EQ(bench.driven_c(0), 1);
    EXPECT_EQ(bench.in(kC) & 0x07, 0x07);
    EXPECT_EQ(bench.in(kB), 0x5C);
    EXPECT_FALSE(bench.chip.interrupt_b());
    EXPECT_EQ(bench.in(kC) & 0x07, 0x04);
}

TEST(I82c55a, Mode1OutputOfPortB) {
    Bench bench;
    bench.out(kControl, 0x84);
    bench.set_bit(2, 1);
    EXPECT_TRUE(bench.chip.interrupt_b());
    bench.out(kB, 0x39);
    EXPECT_EQ(bench.driven_c(1), 0) << "OBF";
    EXPECT_FALSE(bench.chip.interrupt_b());
    bench.pin_c(2, 0);
    bench.pin_c(2, 1);
    EXPECT_EQ(bench.driven_c(1), 1);
    EXPECT_TRUE(bench.chip.interrupt_b());
    EXPECT_EQ(bench.chip.port_output(Port::b), 0x39);
}

TEST(I82c55a, FreePinsOfPortCStayInGeneralUseInMode1) {
    Bench bench;
    bench.out(kControl, 0xBE);  // A mode 1 input, PC7-6 inputs, B mode 1 input
    bench.pins(Port::c, 0x80, 0xC0);
    EXPECT_EQ(bench.in(kC) & 0xC0, 0x80);
    EXPECT_EQ(bench.chip.port_output_mask(Port::c), 0x2B) << "IBF A, INTR A, IBF B, INTR B";
    bench.out(kControl, 0xA4);  // A and B mode 1 output, PC5-4 outputs
    bench.out(kC, 0xFF);
    EXPECT_EQ(bench.chip.port_output_mask(Port::c), 0xBB);
    EXPECT_EQ(bench.driven_c(5), 1);
    EXPECT_EQ(bench.driven_c(4), 1);
    EXPECT_EQ(bench.in(kC), 0xB2) << "OBF A, PC5, PC4, OBF B; enables clear: not written by OUT";
    bench.set_bit(5, 0);
    EXPECT_EQ(bench.driven_c(5), 0);
}

TEST(I82c55a, Mode1WithGroupBInMode0LeavesPinsTwoToZero) {
    Bench bench;
    bench.out(kControl, 0xB0);
    bench.out(kC, 0xC7);
    EXPECT_EQ(bench.chip.port_output_mask(Port::c), 0xEF) << "all but STB";
    EXPECT_EQ(bench.chip.port_output(Port::c), 0xD7) << "STB reads as held high";
    bench.out(kControl, 0x86);  // B mode 1, A mode 0, both halves of C outputs
    bench.out(kC, 0xF8);
    EXPECT_EQ(bench.chip.port_output(Port::c), 0xFC) << "PC7-3 as written, PC2 is STB";
}

// Data sheet, mode 2: port A drives only while ACK is low; INTR = IBF INTE2 STB + OBF INTE1 ACK.
TEST(I82c55a, Mode2IsABusInBothDirections) {
    Bench bench;
    bench.out(kControl, 0xC0);
    EXPECT_EQ(bench.chip.port_output_mask(Port::a), 0x00);
    bench.out(kA, 0x5E);
    EXPECT_EQ(bench.driven_c(7), 0) << "OBF";
    EXPECT_EQ(bench.chip.port_output_mask(Port::a), 0x00) << "not yet acknowledged";
    bench.pin_c(6, 0);
    EXPECT_EQ(bench.chip.port_output_mask(Port::a), 0xFF);
    EXPECT_EQ(bench.chip.port_output(Port::a), 0x5E);
    EXPECT_EQ(bench.driven_c(7), 1);
    bench.pin_c(6, 1);
    EXPECT_EQ(bench.chip.port_output_mask(Port::a), 0x00);
    bench.pins(Port::a, 0xE5);
    bench.pin_c(4, 0);
    bench.pin_c(4, 1);
    EXPECT_EQ(bench.driven_c(5), 1) << "IBF";
    EXPECT_EQ(bench.in(kA), 0xE5) << "the input latch, not the output latch";
    EXPECT_EQ(bench.driven_c(5), 0);
}

TEST(I82c55a, Mode2InterruptComesFromEitherDirection) {
    Bench bench;
    bench.out(kControl, 0xC0);
    bench.set_bit(6, 1);  // INTE 1: output
    EXPECT_TRUE(bench.chip.interrupt_a());
    bench.out(kA, 1);
    EXPECT_FALSE(bench.chip.interrupt_a());
    bench.set_bit(4, 1);  // INTE 2: input
    bench.pin_c(4, 0);
    EXPECT_FALSE(bench.chip.interrupt_a());
    bench.pin_c(4, 1);
    EXPECT_TRUE(bench.chip.interrupt_a());
    EXPECT_EQ(bench.in(kC) & 0xF8, 0x78) << "OBF low, INTE 1, IBF, INTE 2, INTR";
    bench.in(kA);
    EXPECT_FALSE(bench.chip.interrupt_a());
    bench.pin_c(6, 0);
    bench.pin_c(6, 1);
    EXPECT_TRUE(bench.chip.interrupt_a());
}

TEST(I82c55a, Mode2LeavesGroupBItsModes) {
    Bench bench;
    bench.out(kControl, 0xC1);  // B mode 0 output, PC2-0 inputs
    EXPECT_EQ(bench.chip.port_output_mask(Port::c), 0xA8);
    bench.pins(Port::c, 0x05, 0x07);
    EXPECT_EQ(bench.in(kC) & 0x07, 0x05);
    bench.out(kControl, 0xC4);  // B mode 1 output
    EXPECT_EQ(bench.chip.port_output_mask(Port::c), 0xAB);
    bench.out(kControl, 0xD0);  // bit 4 means nothing in mode 2
    EXPECT_EQ(bench.chip.port_output_mask(Port::a), 0x00);
}

TEST(I82c55a, BitSetReachesTheFlagsOfTheHandshake) {
    Bench bench;
    bench.out(kControl, 0xC4);
    bench.set_bit(5, 1);
    EXPECT_EQ(bench.driven_c(5), 1) << "IBF";
    bench.set_bit(7, 0);
    EXPECT_EQ(bench.driven_c(7), 0) << "OBF";
    bench.set_bit(1, 0);
    EXPECT_EQ(bench.driven_c(1), 0) << "OBF B";
    bench.set_bit(3, 1);
    EXPECT_EQ(bench.driven_c(3), 0) << "INTR follows its inputs";
    bench.out(kControl, 0x86);
    bench.set_bit(1, 1);
    EXPECT_EQ(bench.driven_c(1), 1) << "IBF B";
}

TEST(I82c55a, ModeWordClearsHandshakesAndEnables) {
    Bench bench;
    bench.out(kControl, 0xC4);
    bench.out(kA, 1);
    bench.out(kB, 1);
    bench.set_bit(4, 1);
    bench.set_bit(6, 1);
    bench.set_bit(2, 1);
    bench.pin_c(4, 0);
    bench.out(kControl, 0xC4);
    EXPECT_EQ(bench.in(kC), 0x82) << "OBF A and OBF B high, all else clear";
    bench.pin_c(4, 1);
    EXPECT_EQ(bench.driven_c(5), 0) << "a strobe that was low before the mode word sets no IBF";
}

TEST(I82c55a, DirectionsOfPinsThatFlipLoseTheirOutsideLevelOnlyWhileDriven) {
    Bench bench;
    bench.pins(Port::a, 0x0F);
    bench.out(kControl, 0x80);
    EXPECT_EQ(bench.chip.port_level(Port::a), 0x00) << "the latch, cleared by the mode word";
    bench.out(kControl, 0x9B);
    EXPECT_EQ(bench.chip.port_level(Port::a), 0x0F);
}

TEST(I82c55a, PropertiesNameModesAndMistakes) {
    Bench bench;
    bench.out(kControl, 0xC6);
    bench.out(kA, 1);
    bench.out(kA, 2);
    std::string all;
    for (const auto& [name, value] : bench.chip.properties()) all += name + "=" + value + ";";
    EXPECT_NE(all.find("mode of group A=2;"), std::string::npos) << all;
    EXPECT_NE(all.find("mode of group B=1 input;"), std::string::npos) << all;
    EXPECT_NE(all.find("bytes over an unacknowledged one=1;"), std::string::npos) << all;
}

// In mode 0 a read shows, pin by pin, the latch where the pin is an output and the wire elsewhere,
// whatever was written before.
RC_GTEST_PROP(I82c55a, Mode0NeverDependsOnHistory, ()) {
    Bench bench;
    const auto words = *rc::gen::container<std::vector<uint8_t>>(rc::gen::arbitrary<uint8_t>());
    for (const uint8_t word : words) {
        bench.out(*rc::gen::inRange<uint16_t>(0, 4), word);
        bench.in(*rc::gen::inRange<uint16_t>(0, 3));
        bench.pins(*rc::gen::element(Port::a, Port::b, Port::c), *rc::gen::arbitrary<uint8_t>());
    }
    Bench fresh;
    const int word = 0x80 | (*rc::gen::arbitrary<uint8_t>() & 0x1B);
    for (Bench* each : {&bench, &fresh}) {
        for (const Port port : {Port::a, Port::b, Port::c}) each->pins(port, 0x6A);
        each->out(kControl, word);
        each->out(kA, 0x12);
        each->out(kB, 0x34);
        each->out(kC, 0x56);
        for (const uint16_t address : {kA, kB, kC}) each->in(address);
    }
    for (const uint16_t address : {kA, kB, kC, kControl}) {
        RC_ASSERT(bench.in(address) == fresh.in(address));
    }
    for (const Port port : {Port::a, Port::b, Port::c}) {
        RC_ASSERT(bench.chip.port_level(port) == fresh.chip.port_level(port));
    }
}

}  // namespace
