// ad574a_test.cpp - the converter against its data sheet. At 3.072 MHz
//   12 bits  35 us * 3.072 MHz = 107.52 -> 108 T, a bit every 9 T
//    8 bits  24 us * 3.072 MHz =  73.73 ->  74 T
// On +-5 V one count is 10 V / 4096 = 2441.4 uV; code n begins at -5 V + (n - 1/2) counts.
#include "host_sim/chips/ad574a.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

namespace {

using host_sim::chips::Ad574a;
using host_sim::chips::kNever;

constexpr uint64_t kClockHz = 3'072'000;
constexpr uint16_t kHigh = 0;  ///< A0 = 0: 12-bit start, upper byte
constexpr uint16_t kLow = 1;   ///< A0 = 1: 8-bit start, lower nibble

/// Both bytes, left-justified.
int read_word(Ad574a& adc, uint64_t t) {
    const int high = adc.read(kHigh, t);
    return high << 8 | adc.read(kLow, t);
}

int convert(Ad574a& adc, int32_t voltage_uv, uint64_t start_t = 1000) {
    adc.set_input(voltage_uv, start_t);
    adc.write(kHigh, 0, start_t);
    return read_word(adc, start_t + 108) >> 4;
}

/// The code by definition: nearest count, half a count up, within 12 bits.
int ideal_code(int64_t voltage_uv) {
    const int64_t twice = (voltage_uv + 5'000'000) * 8192 + 10'000'000;
    const int64_t code = twice >= 0 ? twice / 20'000'000 : -1;
    return static_cast<int>(std::clamp<int64_t>(code, 0, 4095));
}

TEST(Ad574a, TwelveBitConversionLasts108TStates) {
    Ad574a adc(kClockHz);
    adc.write(kHigh, 0, 1000);
    EXPECT_TRUE(adc.busy(1000));
    EXPECT_TRUE(adc.busy(1107));
    EXPECT_FALSE(adc.busy(1108));
    EXPECT_EQ(adc.end_t(), 1108u);
    EXPECT_EQ(adc.read(kHigh, 1107), 0xFF);
    EXPECT_EQ(adc.read(kHigh, 1108), 0x80);
}

TEST(Ad574a, EightBitConversionLasts74TStates) {
    Ad574a adc(kClockHz);
    adc.write(kLow, 0, 1000);
    EXPECT_TRUE(adc.busy(1073));
    EXPECT_FALSE(adc.busy(1074));
    EXPECT_EQ(adc.read(kHigh, 1074), 0x80);
}

TEST(Ad574a, TypicalPartCanBeChosen) {
    Ad574a adc(kClockHz, {.conversion12_ns = 25'000, .conversion8_ns = 16'000});
    adc.write(kHigh, 0, 0);
    EXPECT_EQ(adc.end_t(), 77u) << "76.8";
    adc.advance(77);
    adc.write(kLow, 0, 100);
    EXPECT_EQ(adc.end_t(), 150u) << "49.2";
}

TEST(Ad574a, BytesAreLeftJustifiedWithTrailingZeros) {
    Ad574a adc(kClockHz);
    // Code A5Bh = 2651: -5 V + 2651 * 2441.40625 uV = 1.472168 V.
    adc.set_input(1'472'168, 0);
    adc.write(kHigh, 0, 10);
    EXPECT_EQ(adc.read(kHigh, 200), 0xA5);
    EXPECT_EQ(adc.read(kLow, 200), 0xB0);
    EXPECT_EQ(adc.read(kLow, 300), 0xB0) << "reading changes nothing";
    EXPECT_EQ(adc.read(0x1232, 300), 0xA5) << "only bit 0 of the address is wired";
}

TEST(Ad574a, EightBitResultHasTheNextTrialBitSetInTheLowByte) {
    Ad574a adc(kClockHz);
    adc.set_input(1'472'168, 0);
    adc.write(kLow, 0, 10);
    EXPECT_EQ(adc.read(kHigh, 200), 0xA5);
    EXPECT_EQ(adc.read(kLow, 200), 0x80);
}

TEST(Ad574a, CodesOfTheDataSheet) {
    Ad574a adc(kClockHz);
    uint64_t t = 1000;
    const auto code = [&](int32_t uv) { return convert(adc, uv, t += 200); };
    EXPECT_EQ(code(-5'000'000), 0x000);
    EXPECT_EQ(code(-4'998'780), 0x000) << "half a count is 1220.7 uV";
    EXPECT_EQ(code(-4'998'779), 0x001);
    EXPECT_EQ(code(-1'221), 0x7FF);
    EXPECT_EQ(code(-1'220), 0x800);
    EXPECT_EQ(code(0), 0x800);
    EXPECT_EQ(code(4'996'337), 0xFFE) << "last transition at +5 V - 1.5 counts = 4.9963379 V";
    EXPECT_EQ(code(4'996'338), 0xFFF);
}

TEST(Ad574a, SaturatesOutsideOfTheRange) {
    Ad574a adc(kClockHz);
    EXPECT_EQ(convert(adc, INT32_MIN, 1000), 0x000);
    EXPECT_EQ(convert(adc, INT32_MAX, 2000), 0xFFF);
    EXPECT_EQ(convert(adc, 15'000'000, 3000), 0xFFF);
}

TEST(Ad574a, EveryTransitionIsWhereTheDefinitionPutsIt) {
    Ad574a adc(kClockHz);
    uint64_t t = 1000;
    for (int n = 1; n < 4096; ++n) {
        // Smallest whole microvolt at or above (n - 1/2) * 10 V / 4096.
        const int64_t above = ((2 * n - 1) * int64_t{10'000'000} + 8191) / 8192;
        const auto first = static_cast<int32_t>(above - 5'000'000);
        ASSERT_EQ(convert(adc, first, t += 200), n);
        ASSERT_EQ(convert(adc, first - 1, t += 200), n - 1);
    }
}

TEST(Ad574a, UnipolarRange) {
    Ad574a adc(kClockHz, {.low_uv = 0});
    EXPECT_EQ(convert(adc, 0, 1000), 0x000);
    EXPECT_EQ(convert(adc, 5'000'000, 2000), 0x800);
    EXPECT_EQ(convert(adc, -1, 3000), 0x000);
}

TEST(Ad574a, StartWhileBusyIsIgnoredAndCounted) {
    Ad574a adc(kClockHz);
    adc.write(kHigh, 0, 1000);
    adc.write(kLow, 0, 1107);
    EXPECT_EQ(adc.busy_start_count, 1u);
    EXPECT_EQ(adc.end_t(), 1108u);
    adc.write(kHigh, 0, 1108);
    EXPECT_EQ(adc.busy_start_count, 1u);
    EXPECT_EQ(adc.end_t(), 1216u);
}

TEST(Ad574a, ReadWhileBusyIsAnOpenBusAndIsCounted) {
    Ad574a adc(kClockHz);
    convert(adc, 0);
    adc.write(kHigh, 0, 2000);
    EXPECT_EQ(adc.read(kHigh, 2050), 0xFF) << "not even the last result";
    EXPECT_EQ(adc.read(kLow, 2050), 0xFF);
    EXPECT_EQ(adc.busy_read_count, 2u);
}

TEST(Ad574a, ResetOfTheProcessorDoesNotStopAConversion) {
    Ad574a adc(kClockHz);
    adc.write(kHigh, 0, 1000);
    adc.reset();
    EXPECT_TRUE(adc.busy(1050));
}

TEST(Ad574a, NextEventIsTheNextBit) {
    Ad574a adc(kClockHz);
    EXPECT_EQ(adc.next_event_t(), kNever);
    adc.write(kHigh, 0, 1000);
    for (uint64_t bit = 1; bit <= 12; ++bit) {
        EXPECT_EQ(adc.next_event_t(), 1000 + 9 * bit);
        adc.advance(adc.next_event_t());
    }
    EXPECT_EQ(adc.next_event_t(), kNever);
    EXPECT_EQ(adc.conversion_count, 1u);
}

// The most significant bit is decided at T 1009. After it the register only looks at the rest.
TEST(Ad574a, InputThatMovesDuringAConversionGivesACodeThatItNeverHad) {
    Ad574a adc(kClockHz);
    adc.set_input(-2'000, 1000);  // just below the middle: bit 11 is 0
    adc.write(kHigh, 0, 1000);
    adc.set_input(1'000'000, 1010);  // 99Ah; all lower bits become 1
    EXPECT_EQ(read_word(adc, 1108) >> 4, 0x7FF);
    EXPECT_EQ(adc.moved_input_count, 1u);

    Ad574a falling(kClockHz);
    falling.set_input(3'000'000, 1000);
    falling.write(kHigh, 0, 1000);
    falling.set_input(-3'000'000, 1018 + 1);  // two bits decided: C00h
    EXPECT_EQ(read_word(falling, 1108) >> 4, 0xC00);
}

TEST(Ad574a, BitSeesTheInputThatIsSetAtItsOwnMoment) {
    Ad574a adc(kClockHz);
    adc.set_input(-2'000, 1000);
    adc.write(kHigh, 0, 1000);
    adc.set_input(1'000'000, 1009);
    EXPECT_EQ(read_word(adc, 1108) >> 4, 0x99A) << "1 V = 409.6 counts above 800h";
}

TEST(Ad574a, SteadyInputSetAgainIsNoMove) {
    Ad574a adc(kClockHz);
    adc.set_input(5, 1000);
    adc.write(kHigh, 0, 1000);
    adc.set_input(5, 1050);
    adc.advance(1108);
    EXPECT_EQ(adc.moved_input_count, 0u);
}

TEST(Ad574a, PropertiesShowTheMistakes) {
    Ad574a adc(kClockHz);
    adc.write(kHigh, 0, 1000);
    adc.write(kHigh, 0, 1001);
    std::string all;
    for (const auto& [name, value] : adc.properties()) all += name + "=" + value + ";";
    EXPECT_NE(all.find("status=converts 12 bits until T 1108;"), std::string::npos) << all;
    EXPECT_NE(all.find("starts ignored: busy=1;"), std::string::npos) << all;
}

RC_GTEST_PROP(Ad574a, SteadyInputGivesTheNearestCode, ()) {
    Ad574a adc(kClockHz);
    const auto uv = *rc::gen::inRange<int32_t>(-6'000'000, 6'000'000);
    RC_ASSERT(convert(adc, uv) == ideal_code(uv));
}

RC_GTEST_PROP(Ad574a, CodeLiesBetweenTheExtremesOfAMonotonousInput, ()) {
    Ad574a adc(kClockHz);
    auto uv = *rc::gen::inRange<int32_t>(-5'000'000, 0);
    const int first = ideal_code(uv);
    adc.set_input(uv, 1000);
    adc.write(kHigh, 0, 1000);
    for (uint64_t t = 1001; t < 1108; t += 5) {
        uv += *rc::gen::inRange<int32_t>(0, 100'000);
        adc.set_input(uv, t);
    }
    const int code = read_word(adc, 1108) >> 4;
    RC_ASSERT(code >= first);
    RC_ASSERT(code <= ideal_code(uv));
}

RC_GTEST_PROP(Ad574a, StridesOfTimeLeaveTheSameState, ()) {
    Ad574a one(kClockHz);
    Ad574a many(kClockHz);
    uint64_t t = 100;
    const auto gaps = *rc::gen::container<std::vector<int>>(rc::gen::inRange<int>(0, 150));
    for (const int gap : gaps) {
        const uint64_t until = t + static_cast<uint64_t>(gap);
        for (; t < until; ++t) many.advance(t);
        t = until;
        const auto uv = *rc::gen::inRange<int32_t>(-5'000'000, 5'000'000);
        const auto address = *rc::gen::inRange<uint16_t>(0, 2);
        const bool start = *rc::gen::arbitrary<bool>();
        for (Ad574a* adc : {&one, &many}) {
            adc->set_input(uv, t);
            if (start) adc->write(address, 0, t);
        }
    }
    one.advance(t + 200);
    many.advance(t + 200);
    RC_ASSERT(one == many);
}

}  // namespace
