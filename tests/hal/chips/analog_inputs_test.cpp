// analog_inputs_test.cpp - sums of a channel, and conversions of a handler. Accesses by hand from
// the docstrings and docs/chips/ad574a.md; values and faults on the models of the analogue chain.
#include "hal/chips/analog_inputs.hpp"

#include <gtest/gtest.h>

#include <string>

#include "tests/hal/chips/parts.hpp"

namespace {

using hal_test::Recorded;
using hal_test::Script;
using hal_test::SimBoard;
using hal_test::Simulated;
using hal_test::Stimulus;
using host_sim::SimBus;

// Three reads of a port are the time that multiplexer and amplifier need; the third one looks at
// STS.
const std::string kSettle = "<21 <21 <21";

/// What sum_of_16() gives; its two answers agree.
template <class Parts>
uint16_t sum(uint8_t channel) {
    uint16_t result = 0;
    const bool answered = Parts::AnalogInputs::sum_of_16(channel, result);
    EXPECT_EQ(answered, result != hal::kAdcAbsent);
    return result;
}

TEST(AnalogInputsAccesses, SumSelectsOnceAndReadsSixteenConversions) {
    Script bus;
    bus.in(0x21, {0x00});
    bus.in(0x28, {0x80, 0x80, 0x80, 0x80, 0x80, 0x80, 0x80, 0x80, 0x81, 0x81, 0x81, 0x81, 0x81,
                  0x81, 0x81, 0x81});
    bus.in(0x29, {0x10, 0x20, 0x30, 0x40, 0x50, 0x60, 0x70, 0x80, 0x90, 0xA0, 0xB0, 0xC0, 0xD0,
                  0xE0, 0xF0, 0x00});
    // 16 * (8 * 80h + 8 * 81h) + 1 + 2 + ... + 15
    EXPECT_EQ(sum<Recorded>(5), 16 * (8 * 0x80 + 8 * 0x81) + 120);
    std::string expected = "20=05 " + kSettle + " 28=00";
    const char* lows[] = {"10", "20", "30", "40", "50", "60", "70", "80",
                          "90", "A0", "B0", "C0", "D0", "E0", "F0"};
    for (const char* low : lows) {  // what is written to start does not matter: the byte at hand
        expected += std::string(" <21 <28 <29 28=") + low + " <21 <21";
    }
    EXPECT_EQ(bus.accesses(), expected + " <21 <28 <29");
}

TEST(AnalogInputsAccesses, SumOfADeadConverterIsAbsent) {
    Script bus;
    bus.in(0x21, {0x40, 0x40, 0x00, 0x40});
    EXPECT_EQ(sum<Recorded>(0), hal::kAdcAbsent);
    std::string expected = "20=00 " + kSettle + " 28=00";
    for (unsigned i = 0; i < Recorded::Adc::kPollsMax; ++i) expected += " <21";
    EXPECT_EQ(bus.accesses(), expected);
}

TEST(AnalogInputsAccesses, NoSumIsStartedWhileTheConverterIsBusy) {
    Script bus;
    bus.in(0x21, {0x00, 0x00, 0x40});
    EXPECT_EQ(sum<Recorded>(6), hal::kAdcAbsent);
    EXPECT_EQ(bus.accesses(), "20=06 <21 <21 <21");
}

TEST(AnalogInputsAccesses, AHandlerStartsAndLooksTheNextTime) {
    Script bus;
    using Inputs = Recorded::AnalogInputs;
    bus.in(0x20, {0x07});
    bus.in(0x21, {0x40});
    bus.in(0x28, {0xAB});
    Inputs::start(7);
    EXPECT_EQ(bus.accesses(), "20=07 " + kSettle + " 28=00");
    EXPECT_EQ(Inputs::selected(), 7);
    EXPECT_EQ(Inputs::upper_bits(), 0);  // no end, so nothing is read
    EXPECT_EQ(bus.accesses(), "<20 <21");
    bus.in(0x21, {0x00});
    EXPECT_EQ(Inputs::upper_bits(), 0xAB);
    EXPECT_EQ(bus.accesses(), "<21 <28");
}

TEST(AnalogInputsAccesses, TheMultiplexerTellsWhoseTheConverterIs) {
    Script bus;
    Recorded::AnalogInputs::claim();
    Recorded::AnalogInputs::release();
    EXPECT_EQ(bus.accesses(), "20=00 20=0E");
}

class AnalogInputsOnTheModel : public testing::Test {
protected:
    void SetUp() override { Simulated::PpiA::set_mode<hal::rb85::kPpiAMode>(); }
    void set(uint8_t channel, uint16_t count) {  // the voltage in the middle of the code
        const int64_t uv = int64_t{count} * 10'000'000 / 4096 - 5'000'000;
        board.apply(Stimulus::Kind::sensor, channel, static_cast<int32_t>(uv));
    }
    void expect_no_misuse() const {
        EXPECT_EQ(board.state.analog.unsettled_count, 0U);
        EXPECT_EQ(board.state.analog.adc.busy_start_count, 0U);
        EXPECT_EQ(board.state.analog.adc.busy_read_count, 0U);
        EXPECT_EQ(board.state.analog.amplifier.early_hold_count, 0U);
        EXPECT_EQ(board.state.violation_count, 0U);
    }

    SimBoard board;
};

TEST_F(AnalogInputsOnTheModel, EveryChannelIsItsSumExactly) {
    using Inputs = Simulated::AnalogInputs;
    for (uint8_t channel = 0; channel < 16; ++channel) {
        set(channel, static_cast<uint16_t>(channel * 273));  // 0 to 4095
    }
    for (uint8_t channel = 0; channel < 16; ++channel) {
        EXPECT_EQ(sum<Simulated>(channel), channel * 273 * 16);
        board.elapse(40);
        Inputs::start(15 - channel);
        board.elapse(108);
        EXPECT_EQ(Inputs::upper_bits(), (15 - channel) * 273 / 16);
        board.elapse(40);
    }
    EXPECT_EQ(board.state.analog.adc.conversion_count, 16U * 17U);
    expect_no_misuse();
}

// A handler comes at every place of the task's turn: the sums are right, and so is each of its own
// conversions that it finds.
TEST_F(AnalogInputsOnTheModel, TaskAndHandlerKeepOutOfEachOthersWay) {
    using Inputs = Simulated::AnalogInputs;
    set(2, 1000);
    set(9, 3777);
    unsigned found = 0;
    unsigned kept_out = 0;
    unsigned begun = 0;
    board.handler = [&](host_sim::Interrupt) {
        const uint8_t selected = Inputs::selected();
        if (selected == 2 || selected == 0) {
            ++kept_out;
            return;
        }
        if (selected == 9) {
            ASSERT_EQ(Inputs::upper_bits(), 3777 / 16);
            ++found;
        } else {
            ASSERT_EQ(selected, Inputs::kNobody);
            ++begun;
        }
        Inputs::start(9);
        board.elapse(44);  // POP of four pairs, EI and RET: the way out of a handler
    };
    using Timer = Simulated::TimerA;
    SimBus::sim(0x1B);
    SimBus::enable_interrupts();
    Inputs::release();
    for (uint16_t period = 1500; period < 2600; period += 7) {
        Timer::start<0, Timer::Mode::rate_generator>(period);
        Inputs::claim();
        board.elapse(200);
        ASSERT_EQ(sum<Simulated>(2), 1000 * 16) << period;
        Inputs::release();
        for (unsigned i = 0; i < 500; ++i) (void)SimBus::in<0x25>();
    }
    EXPECT_GT(found, 150U);
    EXPECT_GT(kept_out, 150U);
    EXPECT_GT(begun, 150U);
    expect_no_misuse();
}

// Too slow for the bound, and done while the next channel is read: no channel gets another's value.
TEST_F(AnalogInputsOnTheModel, ASlowConverterGivesNoChannelTheValueOfAnother) {
    for (uint8_t channel = 0; channel < 16; ++channel) {
        set(channel, static_cast<uint16_t>(channel * 273));
    }
    for (uint64_t conversion_t = 100; conversion_t < 900; conversion_t += 3) {
        board.state.analog.adc.conversion12_t = conversion_t;
        unsigned absent = 0;
        for (uint8_t channel = 0; channel < 16; ++channel) {
            const uint16_t all = sum<Simulated>(channel);
            absent += all == hal::kAdcAbsent ? 1U : 0U;
            const auto is = [](uint16_t value, int count) {
                return value == hal::kAdcAbsent || value == count * 16;
            };
            ASSERT_TRUE(is(all, channel * 273)) << conversion_t << ": " << all;
        }
        ASSERT_EQ(absent, conversion_t <= 9 * 20 ? 0U : 16U) << conversion_t;
        board.elapse(1000);
    }
    EXPECT_EQ(board.state.analog.adc.busy_start_count, 0U);
    EXPECT_EQ(board.state.analog.adc.busy_read_count, 0U);
}

TEST_F(AnalogInputsOnTheModel, AConverterThatNeverEndsIsAbsentUntilItWorksAgain) {
    set(3, 2000);
    const uint64_t good_t = board.state.analog.adc.conversion12_t;
    board.state.analog.adc.conversion12_t = 100'000'000;
    EXPECT_EQ(sum<Simulated>(3), hal::kAdcAbsent);
    EXPECT_EQ(Simulated::AnalogInputs::upper_bits(), 0);
    board.state.analog.adc.conversion12_t = good_t;
    board.state.analog.adc.duration_t = 0;
    board.elapse(1000);
    EXPECT_EQ(sum<Simulated>(3), 2000 * 16);
}

}  // namespace
