// i8251a_test.cpp - 8251A against its data sheet: transmitter and instructions.
// Source       Intel 8251A data sheet (205222): pin descriptions, mode and command instruction
//              formats, status read format, asynchronous transmission, A.C. characteristics.
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

// -- Transmitter ---------------------------------------------------------------------------------

TEST(I8251aTransmit, OneFrameAndItsFlagsToTheTState) {
    I8251a usart = ready_usart();
    constexpr uint8_t kIdle = Status::kTxReady | Status::kTxEmpty;
    EXPECT_EQ(usart.status(), kIdle);
    usart.write(kData, 0x55, 1003);
    EXPECT_EQ(usart.status(), 0);  // TxRDY falls with the write, TxEMPTY too
    // Start bit from the next falling edge of TxC, 1010: the holding register is free, TxRDY 14 tCY
    // later. Stop bit from 1010 + 9 * 160 = 2450, its middle 2530, TxEMPTY 20 tCY behind that.
    EXPECT_EQ(changes_until(usart, 10'000),
              (std::vector<Change>{{1024, Status::kTxReady}, {2550, kIdle}}));
    ASSERT_EQ(usart.transmitted.size(), 1U);
    EXPECT_EQ(usart.transmitted[0], (I8251a::TransmittedByte{0x55, 1010, 2610, false}));
}

TEST(I8251aTransmit, SecondCharacterFollowsWithoutAGap) {
    I8251a usart = ready_usart();
    usart.write(kData, 0x11, 1003);
    usart.advance(1024);
    EXPECT_TRUE(usart.tx_ready_pin());
    usart.write(kData, 0x22, 1100);
    // The shift register takes it at the middle of the first stop bit, 2530; TxRDY 14 tCY later.
    const auto changes = changes_until(usart, 3000);
    EXPECT_EQ(changes, (std::vector<Change>{{2544, Status::kTxReady}}));
    usart.advance(10'000);
    ASSERT_EQ(usart.transmitted.size(), 2U);
    EXPECT_EQ(usart.transmitted[1], (I8251a::TransmittedByte{0x22, 2610, 4210, false}));
    EXPECT_EQ(usart.overwritten_count, 0U);
}

TEST(I8251aTransmit, CharacterWrittenInTheLastHalfBitStillFollowsAtOnce) {
    I8251a usart = ready_usart();
    usart.write(kData, 0x11, 1003);
    usart.write(kData, 0x22, 2600);
    EXPECT_EQ(usart.status(), 0) << "TxEMPTY falls again";
    EXPECT_EQ(changes_until(usart, 3000), (std::vector<Change>{{2624, Status::kTxReady}}));
    usart.advance(5000);
    ASSERT_EQ(usart.transmitted.size(), 2U);
    EXPECT_EQ(usart.transmitted[1].start_t, 2610U);
}

TEST(I8251aTransmit, FrameLengthsOfAllFormats) {
    // Mode bits: 7-6 stop, 5 even, 4 parity, 3-2 length, 1-0 factor.
    for (const unsigned factor : {1U, 16U, 64U}) {
        for (unsigned length = 5; length <= 8; ++length) {
            for (unsigned parity = 0; parity < 2; ++parity) {
                for (unsigned stop = 1; stop <= 3; ++stop) {
                    const unsigned factor_bits = factor == 1 ? 1 : factor == 16 ? 2 : 3;
                    I8251a usart = ready_usart(static_cast<uint8_t>(
                        stop << 6 | parity << 4 | (length - 5) << 2 | factor_bits));
                    usart.write(kData, 0xFF, 1001);
                    usart.advance(100'000);
                    ASSERT_EQ(usart.transmitted.size(), 1U);
                    const auto& sent = usart.transmitted[0];
                    const unsigned half_bits = 2 * (1 + length + parity) + (stop + 1);
                    EXPECT_EQ(sent.end_t - sent.start_t, half_bits * factor * kClockT / 2);
                    EXPECT_EQ(sent.byte, (1U << length) - 1);
                }
            }
        }
    }
}

TEST(I8251aTransmit, WriteOverAFullBufferLosesTheFirst) {
    I8251a usart = ready_usart();
    usart.write(kData, 0x11, 1000);
    usart.write(kData, 0x22, 1200);
    usart.write(kData, 0x33, 1300);  // over 22h, which waits
    usart.advance(20'000);
    EXPECT_THAT(bytes_of(usart), testing::ElementsAre(0x11, 0x33));
    EXPECT_EQ(usart.overwritten_count, 1U);
    usart.write(kData, 0x44, 20'000);
    usart.write(kData, 0x55, 20'015);  // 44h left at 20010, TxRDY comes at 20024
    EXPECT_EQ(usart.overwritten_count, 1U);
    EXPECT_EQ(usart.early_write_count, 1U);
}

TEST(I8251aTransmit, TxReadyPinIsGatedTheStatusBitIsNot) {
    I8251a usart = ready_usart(kMode8N1x16, 0);
    EXPECT_EQ(usart.status(), Status::kTxReady | Status::kTxEmpty);
    EXPECT_FALSE(usart.tx_ready_pin());
    usart.write(kControl, Command::kTransmitEnable, 1100);
    EXPECT_TRUE(usart.tx_ready_pin());
    usart.set_cts(false, 1200);
    EXPECT_FALSE(usart.tx_ready_pin());
    EXPECT_EQ(usart.status() & Status::kTxReady, Status::kTxReady);
}

TEST(I8251aTransmit, NothingIsSentUntilEnabledAndCleared) {
    I8251a usart = ready_usart(kMode8N1x16, 0);
    usart.set_cts(false, 1000);
    usart.write(kData, 0x42, 1100);
    EXPECT_EQ(usart.status(), Status::kTxEmpty) << "TxEMPTY stays high while disabled";
    EXPECT_EQ(usart.next_event_t(), kNever);
    usart.write(kControl, Command::kTransmitEnable, 2000);
    EXPECT_EQ(usart.status(), 0);
    usart.advance(3000);
    EXPECT_EQ(usart.status(), 0);
    usart.set_cts(true, 3000);
    usart.advance(10'000);
    ASSERT_EQ(usart.transmitted.size(), 1U);
    EXPECT_EQ(usart.transmitted[0].start_t, 3010U);
}

TEST(I8251aTransmit, WhatWasWrittenBeforeDisablingGoesOut) {
    for (const bool by_cts : {false, true}) {
        I8251a usart = ready_usart();
        usart.write(kData, 0x11, 1003);
        usart.write(kData, 0x22, 1100);
        if (by_cts) {
            usart.set_cts(false, 1200);
        } else {
            usart.write(kControl, 0, 1200);
        }
        usart.advance(20'000);
        EXPECT_THAT(bytes_of(usart), testing::ElementsAre(0x11, 0x22));
        EXPECT_EQ(usart.status() & Status::kTxEmpty, Status::kTxEmpty);
        usart.write(kData, 0x33, 20'000);
        usart.advance(40'000);
        EXPECT_EQ(usart.transmitted.size(), 2U) << "written later: waits";
    }
}

TEST(I8251aTransmit, BreakHoldsTheLineAndSpoilsWhatItMeets) {
    I8251a usart = ready_usart();
    usart.write(kData, 0x11, 1003);
    usart.write(kControl, kBothWays | Command::kSendBreak, 2000);
    usart.write(kControl, kBothWays, 3000);
    usart.write(kData, 0x22, 4000);
    usart.advance(10'000);
    ASSERT_EQ(usart.transmitted.size(), 2U);
    EXPECT_TRUE(usart.transmitted[0].broken);
    EXPECT_FALSE(usart.transmitted[1].broken);
    EXPECT_EQ(usart.transmitted_breaks, (std::vector<I8251a::TransmittedBreak>{{2000, 3000}}));
}

TEST(I8251aTransmit, StoppedClockHoldsAndNewRateContinues) {
    I8251a usart = ready_usart();
    usart.write(kData, 0x11, 1003);
    usart.set_clock_period_t(0, 1010 + 5 * kBitT);  // after five of ten bits
    usart.advance(50'000);
    EXPECT_TRUE(usart.transmitted.empty());
    usart.set_clock_period_t(2 * kClockT, 50'000);
    usart.advance(100'000);
    ASSERT_EQ(usart.transmitted.size(), 1U);
    EXPECT_EQ(usart.transmitted[0].end_t, 50'000 + 5 * 2 * kBitT);
}

TEST(I8251aTransmit, NewClockBeginsWithItsOwnEdge) {
    I8251a usart = ready_usart();
    usart.set_clock_period_t(20, 1007);  // the old clock was high
    usart.write(kData, 0x11, 1010);
    usart.advance(10'000);
    ASSERT_EQ(usart.transmitted.size(), 1U);
    EXPECT_EQ(usart.transmitted[0].start_t, 1007U + 20);
    EXPECT_EQ(usart.transmitted[0].end_t, 1007U + 20 + 2 * 1600);
    usart.set_clock_period_t(20, 10'001);  // no change: the edges stay where they are
    usart.write(kData, 0x11, 10'001);
    usart.advance(20'000);
    EXPECT_EQ(usart.transmitted[1].start_t, 10'007U);
}

// -- Instructions --------------------------------------------------------------------------------

TEST(I8251aInstructions, ThreeZerosAnd40hRecoverFromEveryState) {
    const std::vector<std::vector<uint8_t>> starts{
        {},             // after RESET: expects a mode
        {0x00},         // synchronous, expects the first of two sync characters
        {0x00, 0x16},   // expects the second
        {0x80},         // synchronous with one sync character
        {0x80, 0x16},   // synchronous, expects commands
        {kMode8N1x16},  // asynchronous, expects commands
        {kMode8N1x16, kBothWays},
        {0x00, 0x16, 0x16, 0x85},
    };
    for (const auto& start : starts) {
        I8251a usart;
        usart.set_clock_period_t(kClockT, 0);
        uint64_t t = 0;
        for (const uint8_t value : start) {
            usart.write(kControl, value, t += 20);
        }
        for (const uint8_t value : std::vector<uint8_t>{0x00, 0x00, 0x00, 0x40}) {
            usart.write(kControl, value, t += 20);
        }
        EXPECT_EQ(usart.expects, I8251a::Expects::mode);
        usart.write(kControl, kMode8N1x16, t += 20);
        usart.write(kControl, kBothWays, t += 20);
        usart.write(kData, 0x5A, t += 20);
        usart.advance(t + 5000);
        EXPECT_THAT(bytes_of(usart), testing::ElementsAre(0x5A));
        EXPECT_EQ(usart.recovery_violation_count, 0U);
    }
}

TEST(I8251aInstructions, SynchronousModeTakesItsCharactersAndSaysThatItIsNotModelled) {
    I8251a usart;
    usart.write(kControl, 0x0C, 20);  // two sync characters, 8 bits
    EXPECT_EQ(usart.expects, I8251a::Expects::sync1);
    usart.write(kControl, 0x40, 40);  // a sync character, no internal reset
    EXPECT_EQ(usart.expects, I8251a::Expects::sync2);
    usart.write(kControl, 0x40, 60);
    EXPECT_EQ(usart.expects, I8251a::Expects::command);
    usart.write(kData, 0x11, 80);
    EXPECT_EQ(usart.lost_data_write_count, 1U);
    EXPECT_THAT(usart.properties()[1].value, testing::HasSubstr("not modelled"));
}

TEST(I8251aInstructions, ModeSelectsFormat) {
    EXPECT_EQ(ready_usart(0x4E).format(), (Format{8, Parity::none, 2}));
    EXPECT_EQ(ready_usart(0x7A).format(), (Format{7, Parity::even, 2}));
    EXPECT_EQ(ready_usart(0x5A).format(), (Format{7, Parity::odd, 2}));
    EXPECT_EQ(ready_usart(0x83).format(), (Format{5, Parity::none, 3}));
    EXPECT_EQ(ready_usart(0xE6).format(), (Format{6, Parity::none, 4}));
    EXPECT_EQ(ready_usart(0x0E).invalid_mode_count, 1U);
}

TEST(I8251aInstructions, InternalResetAbortsAndClears) {
    I8251a usart = ready_usart(kMode8N1x16, kBothWays | Command::kRequestToSend);
    usart.line_in(0x11, 1100, kBitQ8T);
    usart.line_in(0x22, 1100, kBitQ8T);
    usart.advance(6000);
    usart.write(kData, 0x33, 6000);
    usart.write(kControl, Command::kInternalReset, 6500);
    EXPECT_EQ(usart.status(), Status::kTxReady | Status::kTxEmpty);
    EXPECT_FALSE(usart.rts());
    EXPECT_EQ(usart.aborted_frame_count, 1U);
    usart.advance(20'000);
    EXPECT_TRUE(usart.transmitted.empty());
}

TEST(I8251aInstructions, ResetForgetsFlagsOnTheirWay) {
    I8251a sending = ready_usart();
    sending.write(kData, 0x11, 1003);
    sending.advance(1015);  // left the buffer at 1010, TxRDY due at 1024
    sending.reset();
    EXPECT_EQ(sending.status(), Status::kTxReady | Status::kTxEmpty);
    I8251a receiving = ready_usart();
    receiving.line_in(0x11, 2000, kBitQ8T);
    receiving.advance(3540);  // stop bit sampled at 3525, RxRDY due at 3551
    receiving.reset();
    receiving.advance(5000);
    EXPECT_FALSE(receiving.rx_ready_pin());
}

TEST(I8251aInstructions, ModemPins) {
    I8251a usart = ready_usart(kMode8N1x16, Command::kRequestToSend);
    EXPECT_TRUE(usart.rts());
    EXPECT_FALSE(usart.dtr());
    usart.write(kControl, Command::kDataTerminalReady, 1100);
    EXPECT_FALSE(usart.rts());
    EXPECT_TRUE(usart.dtr());
    EXPECT_EQ(usart.status() & Status::kDataSetReady, 0);
    usart.set_dsr(true, 1200);
    EXPECT_EQ(usart.read(kControl, 1210) & Status::kDataSetReady, Status::kDataSetReady);
}

TEST(I8251aInstructions, WritesCloserThanTheRecoveryTimeAreCounted) {
    I8251a usart;
    usart.write(kControl, kMode8N1x16, 100);
    usart.write(kControl, kBothWays, 107);  // 8 tCY between writes in asynchronous mode
    EXPECT_EQ(usart.recovery_violation_count, 1U);
    usart.write(kControl, kBothWays, 115);
    EXPECT_EQ(usart.recovery_violation_count, 1U);
    usart.write(kControl, Command::kInternalReset, 123);
    usart.write(kControl, kMode8N1x16, 128);  // 6 tCY in initialisation
    EXPECT_EQ(usart.recovery_violation_count, 2U);
}

TEST(I8251aInstructions, DataBeforeTheModeInstructionIsLost) {
    I8251a usart;
    usart.write(kData, 0x11, 20);
    EXPECT_EQ(usart.lost_data_write_count, 1U);
    EXPECT_EQ(usart.status(), Status::kTxReady | Status::kTxEmpty);
}

TEST(I8251aInstructions, ResetPinKeepsWhatIsOutside) {
    I8251a usart = ready_usart();
    usart.write(kData, 0x11, 1000);
    usart.advance(5000);
    usart.set_cts(false, 5000);
    usart.reset();
    EXPECT_EQ(usart.expects, I8251a::Expects::mode);
    EXPECT_EQ(usart.transmitted.size(), 1U);
    EXPECT_EQ(usart.clock_period_t, kClockT);
    EXPECT_FALSE(usart.clear_to_send);
}

}  // namespace
