// i8251a_test.cpp - the driver of the 8251A. Accesses: Intel 8251A data sheet (205222),
// "Programming the 8251A"; consequences: the chip's model.
#include "hal/chips/i8251a.hpp"

#include <gtest/gtest.h>

#include <array>

#include "tests/hal/chips/parts.hpp"

namespace {

using hal_test::Recorded;
using hal_test::Script;
using hal_test::SimBoard;
using hal_test::Simulated;
using hal_test::Stimulus;
using host_sim::chips::I8251a;

constexpr uint64_t kCharacterT = 1600;  // 10 bits of 160 T, 19,200 baud

// Three zeros, IR, mode 01 00 11 10 (one stop bit, no parity, 8 bits, x16), command 0011 0111; a
// read of the status behind each as time for recovery.
TEST(I8251aAccesses, ResetIsTheWorstCaseSequence) {
    Script bus;
    bus.in(0x09, {0x85});
    Recorded::Usart::reset();
    EXPECT_EQ(bus.accesses(), "09=00 <09 09=00 <09 09=00 <09 09=40 <09 09=4E <09 09=37 <09");
}

TEST(I8251aAccesses, OthersAreOneEach) {
    Script bus;
    bus.in(0x08, {0x5A});
    bus.in(0x09, {0x2B});
    EXPECT_EQ(Recorded::Usart::status(), 0x2B);
    EXPECT_EQ(Recorded::Usart::read(), 0x5A);
    Recorded::Usart::write(0xC3);
    Recorded::Usart::acknowledge_errors();
    EXPECT_EQ(bus.accesses(), "<09 <08 08=C3 09=37");
}

TEST(I8251aAccesses, StatusBitsAreTheDataSheets) {
    using Usart = Recorded::Usart;
    EXPECT_EQ(Usart::kTxReady, I8251a::Status::kTxReady);
    EXPECT_EQ(Usart::kRxReady, I8251a::Status::kRxReady);
    EXPECT_EQ(Usart::kTxEmpty, I8251a::Status::kTxEmpty);
    EXPECT_EQ(Usart::kParityError, I8251a::Status::kParityError);
    EXPECT_EQ(Usart::kOverrunError, I8251a::Status::kOverrunError);
    EXPECT_EQ(Usart::kFramingError, I8251a::Status::kFramingError);
    EXPECT_EQ(Usart::kBreak, I8251a::Status::kBreakDetect);
}

void expect_ready(const I8251a& usart) {
    EXPECT_EQ(usart.expects, I8251a::Expects::command);
    EXPECT_EQ(usart.clock_factor, 16);
    EXPECT_EQ(usart.format(), (I8251a::Format{8, I8251a::Parity::none, 2}));
    EXPECT_EQ(usart.command & 0x7F, 0x37);
}

constexpr std::array<uint8_t, 4> kFillers = {0x00, 0x16, 0x37, 0xA4};

// Every first control byte, which is a mode, and behind it up to three more: whatever the part
// expects next, it is ready behind reset().
TEST(I8251aOnTheModel, ResetWorksFromEveryState) {
    for (unsigned first = 0; first < 256; ++first) {
        for (unsigned more = 0; more < 4; ++more) {
            for (const uint8_t filler : kFillers) {
                SimBoard board;
                host_sim::SimBus::out<0x09>(static_cast<uint8_t>(first));
                for (unsigned i = 0; i < more; ++i) host_sim::SimBus::out<0x09>(filler);
                board.elapse(100);
                Simulated::Usart::reset();
                expect_ready(board.state.usart);
                EXPECT_EQ(board.state.usart.recovery_violation_count, 0U);
                ASSERT_FALSE(HasFailure()) << "mode " << first << ", then " << more;
            }
        }
    }
}

class I8251aLine : public testing::Test {
protected:
    void SetUp() override {
        Simulated::TimerA::start<hal::rb85::kBaudCounter, Simulated::TimerA::Mode::square_wave>(
            hal::rb85::kBaudCount);
        Simulated::Usart::reset();
        board.elapse(1000);
    }
    void arrive(uint8_t byte) { board.apply(Stimulus::Kind::serial_byte, 0, byte); }

    SimBoard board;
};

TEST_F(I8251aLine, SendsAndReceives) {
    EXPECT_EQ(Simulated::Usart::status() & Simulated::Usart::kTxReady, 1);
    Simulated::Usart::write(0x96);
    board.elapse(kCharacterT + 200);
    ASSERT_EQ(board.state.usart.transmitted.size(), 1U);
    EXPECT_EQ(board.state.usart.transmitted[0].byte, 0x96);
    EXPECT_EQ(Simulated::Usart::status() & Simulated::Usart::kRxReady, 0);
    arrive(0x69);
    board.elapse(kCharacterT + 200);
    EXPECT_NE(Simulated::Usart::status() & Simulated::Usart::kRxReady, 0);
    EXPECT_EQ(Simulated::Usart::read(), 0x69);
    EXPECT_EQ(Simulated::Usart::status() & Simulated::Usart::kRxReady, 0);
    EXPECT_EQ(board.state.usart.empty_read_count, 0U);
}

TEST_F(I8251aLine, OverrunIsSeenAndAcknowledged) {
    arrive(0x11);
    arrive(0x22);
    board.elapse(2 * kCharacterT + 200);
    EXPECT_EQ(Simulated::Usart::status() & Simulated::Usart::kErrors,
              Simulated::Usart::kOverrunError);
    EXPECT_EQ(Simulated::Usart::read(), 0x22);
    Simulated::Usart::acknowledge_errors();
    EXPECT_EQ(Simulated::Usart::status() & Simulated::Usart::kErrors, 0);
    arrive(0x33);  // still enabled
    board.elapse(kCharacterT + 200);
    EXPECT_EQ(Simulated::Usart::read(), 0x33);
    expect_ready(board.state.usart);
}

TEST_F(I8251aLine, FramingErrorIsSeen) {
    const uint64_t t = board.state.cpu.t;
    board.state.usart.line_break(t + 100, t + 100 + kCharacterT);
    board.elapse(2 * kCharacterT);
    EXPECT_EQ(Simulated::Usart::status() & Simulated::Usart::kErrors,
              Simulated::Usart::kFramingError);
}

}  // namespace
