// i8251a_receive_test.cpp - 8251A against its data sheet: receiver, errors, break, baud rates.
// Source       Intel 8251A data sheet (205222): asynchronous reception, pin descriptions of RxRDY
//              and SYNDET/BRKDET, A.C. characteristics.
// Times        TxC = RxC = 10 T with falling edges at multiples of 10, factor 16, so 160 T per bit
//              (19,200 baud at 3.072 MHz) and 1600 T per frame 8N1. Rising edges at 5, 15, ...
#include "host_sim/chips/i8251a.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "tests/host_sim/chips/i8251a_fixture.hpp"

namespace {

using namespace host_sim::chips_test;
using host_sim::chips::kNever;

// -- Receiver ------------------------------------------------------------------------------------

TEST(I8251aReceive, RxReadyToTheTState) {
    I8251a usart = ready_usart();
    usart.line_in(0x5A, 2000, kBitQ8T);
    // First rising edge of RxC in the start bit: 2005. Its middle 80 T later, the stop bit's nine
    // bits after that: 2005 + 80 + 9 * 160 = 3525; RxRDY at most 26 tCY behind.
    constexpr uint8_t kIdle = Status::kTxReady | Status::kTxEmpty;
    EXPECT_EQ(changes_until(usart, 10'000),
              (std::vector<Change>{{3551, kIdle | Status::kRxReady}}));
    EXPECT_TRUE(usart.rx_ready_pin());
    EXPECT_EQ(usart.read(kData, 10'000), 0x5A);
    EXPECT_FALSE(usart.rx_ready_pin());
    EXPECT_EQ(usart.empty_read_count, 0U);
    EXPECT_EQ(usart.read(kData, 10'010), 0x5A);
    EXPECT_EQ(usart.empty_read_count, 1U);
}

TEST(I8251aReceive, QueuedCharactersComeBackToBack) {
    I8251a usart = ready_usart();
    for (const uint8_t byte : std::vector<uint8_t>{0x00, 0xFF, 0xA5}) {
        usart.line_in(byte, 2000, kBitQ8T);
    }
    std::vector<int> got;
    std::vector<uint64_t> times;
    while (usart.next_event_t() != kNever) {
        usart.advance(usart.next_event_t());
        if (usart.rx_ready_pin()) {
            times.push_back(usart.last_t);
            got.push_back(usart.read(kData, usart.last_t));
        }
    }
    EXPECT_THAT(got, testing::ElementsAre(0x00, 0xFF, 0xA5));
    EXPECT_THAT(times, testing::ElementsAre(3551, 5151, 6751));
    EXPECT_EQ(usart.status() & Status::kErrors, 0);
    usart.advance(6800);
    EXPECT_TRUE(usart.line.empty());
}

TEST(I8251aReceive, OverrunLosesTheOlderCharacter) {
    I8251a usart = ready_usart();
    usart.line_in(0x11, 2000, kBitQ8T);
    usart.line_in(0x22, 2000, kBitQ8T);
    usart.advance(5150);
    EXPECT_EQ(usart.status() & Status::kOverrunError, 0);
    usart.advance(5151);
    EXPECT_EQ(usart.status() & Status::kOverrunError, Status::kOverrunError);
    EXPECT_EQ(usart.read(kData, 6000), 0x22);
    EXPECT_EQ(usart.status() & Status::kOverrunError, Status::kOverrunError) << "sticks";
    EXPECT_EQ(usart.overrun_count, 1U);
    usart.write(kControl, kBothWays | Command::kErrorReset, 6100);
    EXPECT_EQ(usart.status() & Status::kErrors, 0);
}

TEST(I8251aReceive, ParityIsCheckedAndDoesNotStopReception) {
    for (const Parity parity : {Parity::odd, Parity::even}) {
        // Mode 7E... : 8 bits, parity, 1 stop bit, x16.
        I8251a usart = ready_usart(parity == Parity::even ? 0x7E : 0x5E);
        const Parity wrong = parity == Parity::even ? Parity::odd : Parity::even;
        usart.line_in(0x31, 2000, kBitQ8T, {8, parity, 2});
        usart.advance(5000);
        EXPECT_EQ(usart.read(kData, 5000), 0x31);
        EXPECT_EQ(usart.status() & Status::kErrors, 0);
        usart.line_in(0x31, 6000, kBitQ8T, {8, wrong, 2});
        usart.advance(9000);
        EXPECT_EQ(usart.status() & Status::kErrors, Status::kParityError);
        EXPECT_EQ(usart.read(kData, 9000), 0x31);
        usart.line_in(0x32, 9000, kBitQ8T, {8, parity, 2});
        usart.advance(12'000);
        EXPECT_EQ(usart.status() & Status::kErrors, Status::kParityError) << "until error reset";
        EXPECT_EQ(usart.parity_error_count, 1U);
    }
}

TEST(I8251aReceive, ParityBitsOfKnownCharacters) {
    // A receiver without parity takes the parity bit for the stop bit: a 0 is a framing error. 31h
    // has three ones, so even parity is 1 and odd parity 0; 33h has four.
    for (const auto& [byte, parity, framing] : {std::tuple{uint8_t{0x31}, Parity::even, false},
                                                {uint8_t{0x31}, Parity::odd, true},
                                                {uint8_t{0x33}, Parity::even, true},
                                                {uint8_t{0x33}, Parity::odd, false}}) {
        I8251a usart = ready_usart();
        usart.line_in(byte, 2000, kBitQ8T, {8, parity, 2});
        usart.advance(3600);
        EXPECT_EQ((usart.status() & Status::kFramingError) != 0, framing) << unsigned{byte};
        EXPECT_EQ(usart.read(kData, 3600), byte);
    }
}

TEST(I8251aReceive, UnusedBitsOfShortCharactersAreZero) {
    I8251a usart = ready_usart(0x42);  // 5 bits, no parity, 1 stop bit, x16
    usart.line_in(0xFF, 2000, kBitQ8T, {5, Parity::none, 2});
    usart.advance(5000);
    EXPECT_EQ(usart.read(kData, 5000), 0x1F);
}

TEST(I8251aReceive, OneStopBitIsEnoughWhateverIsProgrammed) {
    I8251a usart = ready_usart(0xCE);  // 8N2
    usart.line_in(0x12, 2000, kBitQ8T);
    usart.line_in(0x34, 2000, kBitQ8T);
    usart.advance(3600);
    EXPECT_EQ(usart.read(kData, 3600), 0x12);
    usart.advance(5200);
    EXPECT_EQ(usart.read(kData, 5200), 0x34);
    EXPECT_EQ(usart.status() & Status::kErrors, 0);
}

TEST(I8251aReceive, TwoPercentOffWorksEightPercentDoesNot) {
    // The stop bit is sampled 9.5 to 9.5625 bits after the edge: a sender slower than 6.25 % has
    // not got there, one faster than 5 % is already in the next character.
    const std::string text = "\x55\xAA Rover \xFF";
    for (const auto& [percent, works] :
         {std::pair{98U, true}, {102U, true}, {92U, false}, {108U, false}}) {
        I8251a usart = ready_usart();
        for (const char letter : text) {
            usart.line_in(static_cast<uint8_t>(letter), 2000, kBitQ8T * percent / 100);
        }
        std::string got;
        while (usart.next_event_t() != kNever) {
            usart.advance(usart.next_event_t());
            if (usart.rx_ready_pin()) {
                got.push_back(static_cast<char>(usart.read(kData, usart.last_t)));
            }
        }
        EXPECT_EQ(got == text, works) << percent << " %";
        EXPECT_EQ(usart.framing_error_count == 0, works) << percent << " %";
        EXPECT_EQ((usart.status() & Status::kFramingError) == 0, works) << percent << " %";
    }
}

TEST(I8251aReceive, SlowSenderShiftsTheLastBitOfOneCharacter) {
    // Bit n of the sender (0: start, 1 to 8: data, 9: stop) lasts from 1.08 n to 1.08 (n + 1), ours
    // are sampled at 1.53, 2.53 .. 8.53 and the stop bit at 9.53. Those fall into the sender's bits
    // 1 2 3 4 5 6 6 7 and 8: the sixth data bit twice, the eighth as stop bit. C0h comes as 80h.
    I8251a usart = ready_usart();
    usart.line_in(0xC0, 2000, kBitQ8T * 108 / 100);
    usart.advance(6000);
    EXPECT_EQ(usart.read(kData, 6000), 0x80);
}

TEST(I8251aReceive, GlitchShorterThanHalfABitIsNoStartBit) {
    I8251a usart = ready_usart();
    usart.line_break(2000, 2070);
    usart.advance(5000);
    EXPECT_FALSE(usart.rx_ready_pin());
    EXPECT_EQ(usart.false_start_count, 1U);
    usart.line_in(0x77, 5000, kBitQ8T);
    usart.advance(7000);
    EXPECT_EQ(usart.read(kData, 7000), 0x77);
}

TEST(I8251aReceive, FactorOneSamplesOncePerClockWithoutCheckingTheStartBit) {
    I8251a usart = ready_usart(0x4D);  // 8N1, x1: a bit is one clock of 10 T
    usart.line_in(0xC5, 2000, kClockT * 256);
    // Rising edges 2005 (start) .. 2095 (stop); RxRDY 26 tCY later.
    usart.advance(2120);
    EXPECT_FALSE(usart.rx_ready_pin());
    usart.advance(2121);
    EXPECT_TRUE(usart.rx_ready_pin());
    EXPECT_EQ(usart.read(kData, 2130), 0xC5);
    EXPECT_EQ(usart.status() & Status::kErrors, 0);
}

TEST(I8251aReceive, FactorSixtyFour) {
    I8251a usart = ready_usart(0x4F);
    usart.line_in(0xC5, 2000, 64 * kClockT * 256);
    // 2005 + 32 * 10 + 9 * 640 + 26.
    usart.advance(8110);
    EXPECT_FALSE(usart.rx_ready_pin());
    usart.advance(8111);
    EXPECT_EQ(usart.read(kData, 8111), 0xC5);
}

TEST(I8251aReceive, BreakGivesOneZeroWithFramingErrorThenBreakDetect) {
    I8251a usart = ready_usart();
    usart.line_break(2000, 10'000);
    // Stop bits at 3525 and one frame, 1600 T, later at 5125; high again seen at 10005.
    constexpr uint8_t kIdle = Status::kTxReady | Status::kTxEmpty;
    constexpr uint8_t kFirst = kIdle | Status::kRxReady | Status::kFramingError;
    EXPECT_EQ(changes_until(usart, 20'000),
              (std::vector<Change>{
                  {3551, kFirst}, {5125, kFirst | Status::kBreakDetect}, {10'005, kFirst}}));
    EXPECT_EQ(usart.read(kData, 20'000), 0x00);
    EXPECT_EQ(usart.overrun_count, 0U);
    usart.line_in(0x41, 20'000, kBitQ8T);
    usart.advance(30'000);
    EXPECT_EQ(usart.read(kData, 30'000), 0x41);
}

TEST(I8251aReceive, LowForLessThanTwoFramesIsNoBreak) {
    I8251a usart = ready_usart();
    usart.line_break(2000, 5100);
    usart.advance(20'000);
    EXPECT_EQ(usart.framing_error_count, 1U);
    EXPECT_EQ(usart.status() & Status::kBreakDetect, 0);
}

TEST(I8251aReceive, LineThatIsLowFromTheStartIsNoCharacter) {
    I8251a usart;
    usart.line_break(1, 50'000);
    usart.set_clock_period_t(kClockT, 2);
    usart.write(kControl, kMode8N1x16, 100);
    usart.write(kControl, kBothWays, 200);
    usart.advance(49'000);
    EXPECT_FALSE(usart.rx_ready_pin()) << "a 1 must be seen first after a reset";
    usart.line_in(0x41, 51'000, kBitQ8T);
    usart.advance(60'000);
    EXPECT_EQ(usart.read(kData, 60'000), 0x41);
    EXPECT_EQ(usart.status() & Status::kErrors, 0);
}

TEST(I8251aReceive, DisabledReceiverHoldsRxReadyLow) {
    I8251a usart = ready_usart(kMode8N1x16, Command::kTransmitEnable);
    usart.line_in(0x11, 2000, kBitQ8T);
    usart.advance(5000);
    EXPECT_FALSE(usart.rx_ready_pin());
    usart.write(kControl, kBothWays, 5000);
    usart.line_in(0x22, 6000, kBitQ8T);
    usart.advance(8000);
    EXPECT_TRUE(usart.rx_ready_pin());
    usart.write(kControl, Command::kTransmitEnable, 8000);
    EXPECT_FALSE(usart.rx_ready_pin());
    usart.line_in(0x33, 9000, kBitQ8T);
    usart.write(kControl, kBothWays, 9000 + 5 * kBitT);  // in the middle of it: 33h is not read
    usart.line_in(0x44, 12'000, kBitQ8T);
    usart.advance(15'000);
    EXPECT_EQ(usart.read(kData, 15'000), 0x44);
}

TEST(I8251aReceive, EnabledWithinACharacterTakesTheNextFallingEdgeForAStartBit) {
    I8251a usart = ready_usart(kMode8N1x16, Command::kTransmitEnable);
    usart.line_in(0x0F, 9000, kBitQ8T);
    usart.write(kControl, kBothWays, 9500);  // in data bit 2
    usart.advance(15'000);
    // Data bit 4 is the start bit, then come 0, 0, 0, the stop bit and the idle line.
    EXPECT_EQ(usart.read(kData, 15'000), 0xF8);
    EXPECT_EQ(usart.empty_read_count, 0U);
}

TEST(I8251aReceive, BreakIsNotDetectedAcrossADisabledTime) {
    I8251a usart = ready_usart();
    usart.line_break(2000, 10'000);
    usart.write(kControl, Command::kTransmitEnable, 4000);
    usart.write(kControl, kBothWays, 4500);
    usart.advance(9000);
    EXPECT_EQ(usart.status() & Status::kBreakDetect, 0);
}

}  // namespace
