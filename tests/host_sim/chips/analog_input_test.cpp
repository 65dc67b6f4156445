// analog_input_test.cpp - multiplexer, sample-and-hold and converter together: what software gets
// that waits, and what software gets that does not.
#include "host_sim/chips/analog_input.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <string>
#include <vector>

namespace {

using host_sim::chips::AnalogInput;
using host_sim::chips::kNever;

constexpr uint64_t kClockHz = 3'072'000;
constexpr uint64_t kAcquisitionT = 31;  ///< 10 us; the multiplexer's 9 T pass meanwhile
constexpr uint64_t kConversionT = 108;

/// Selects, waits, converts and reads; moves `t` to the end.
int convert(AnalogInput& input, unsigned channel, uint64_t wait_t, uint64_t& t) {
    input.select(channel, t);
    t += wait_t;
    input.write(0, 0, t);
    t += kConversionT;
    const int high = input.read(0, t);
    return (high << 8 | input.read(1, t)) >> 4;
}

TEST(AnalogInput, SoftwareThatWaitsReadsEveryChannel) {
    AnalogInput input(kClockHz);
    uint64_t t = 1000;
    // Channel i carries code 256 * i exactly: -5 V + i * 0.625 V.
    for (unsigned i = 0; i < 16; ++i) {
        input.set_sensor(i, -5'000'000 + static_cast<int32_t>(i) * 625'000, t);
    }
    for (const unsigned channel : {15u, 0u, 8u, 1u, 14u}) {
        EXPECT_EQ(convert(input, channel, kAcquisitionT, t), static_cast<int>(channel) * 256);
    }
    EXPECT_EQ(input.unsettled_count, 0u);
}

TEST(AnalogInput, SoftwareThatStartsTooEarlyReadsAMixture) {
    AnalogInput input(kClockHz);
    uint64_t t = 1000;
    input.set_sensor(0, 4'000'000, t);
    input.set_sensor(1, -4'000'000, t);
    const int old_code = convert(input, 0, 100, t);
    t += 100;
    // 7 T later the multiplexer has 4 V - 8 V * (1 - 2^-10), the amplifier 13 * 7 / 31 = 2
    // halvings: -3,992,188 + (4,000,000 + 3,992,188) / 4 = -1,994,141 uV = code 4CFh (1231.2).
    const int mixture = convert(input, 1, 7, t);
    t += 100;
    const int new_code = convert(input, 1, 0, t);
    EXPECT_EQ(old_code, 0xE66) << "2048 + 1638.4";
    EXPECT_EQ(mixture, 0x4CF);
    EXPECT_EQ(new_code, 0x19A) << "2048 - 1638.4";
    EXPECT_EQ(input.unsettled_count, 1u);
    EXPECT_EQ(input.amplifier.early_hold_count, 1u);
}

TEST(AnalogInput, SecondConversionRightAfterTheFirstIsTooEarlyAfterAChange) {
    AnalogInput input(kClockHz);
    uint64_t t = 1000;
    input.set_sensor(0, 4'000'000, t);
    convert(input, 0, 100, t);
    input.set_sensor(0, 0, t);  // while the amplifier begins to sample
    const int code = convert(input, 0, 3, t);
    EXPECT_GT(code, 0x800 + 600) << "half of the old voltage";
    EXPECT_EQ(input.unsettled_count, 1u);
}

TEST(AnalogInput, HeldVoltageKeepsAMovingSensorOutOfTheConversion) {
    AnalogInput input(kClockHz);
    input.set_sensor(0, -2'000, 100);
    input.write(0, 0, 1000);
    for (uint64_t t = 1001; t < 1108; t += 3) {
        input.set_sensor(0, static_cast<int32_t>(t) * 1000, t);
        input.select(static_cast<unsigned>(t), t);
    }
    EXPECT_EQ(input.read(0, 1108), 0x7F);
    EXPECT_EQ(input.read(1, 1108), 0xF0);
    EXPECT_EQ(input.adc.moved_input_count, 0u);
}

TEST(AnalogInput, StatusSwitchesTheSampleAndHold) {
    AnalogInput input(kClockHz);
    EXPECT_EQ(input.next_event_t(), kNever);
    input.write(0, 0, 1000);
    EXPECT_TRUE(input.amplifier.holding);
    EXPECT_TRUE(input.busy(1107));
    EXPECT_EQ(input.next_event_t(), 1108u);
    input.advance(5000);
    EXPECT_FALSE(input.amplifier.holding);
    EXPECT_EQ(input.amplifier.sample_t, 1108u) << "since the end, not since it was looked at";
}

TEST(AnalogInput, StartWhileBusyDoesNotTouchTheHeldVoltage) {
    AnalogInput input(kClockHz);
    input.set_sensor(0, 1'000'000, 100);
    input.write(0, 0, 1000);
    input.set_sensor(0, 2'000'000, 1050);
    input.write(0, 0, 1051);
    EXPECT_EQ(input.adc.busy_start_count, 1u);
    EXPECT_EQ(input.read(0, 1108), 0x99) << "1 V";
}

TEST(AnalogInput, AnySixteenConversionsOfAReplayedSumAddUpToItExactly) {
    for (unsigned sum_q4 = 0; sum_q4 <= 65520; sum_q4 += sum_q4 == 65519 ? 1 : 431) {
        AnalogInput input(kClockHz);
        uint64_t t = 1000;
        input.set_sensor_sum(3, static_cast<uint16_t>(sum_q4), t);
        std::vector<int> codes;
        for (int j = 0; j < 40; ++j) {
            codes.push_back(convert(input, 3, kAcquisitionT, t));
            ASSERT_GE(codes.back(), static_cast<int>(sum_q4 / 16));
            ASSERT_LE(codes.back(), static_cast<int>((sum_q4 + 15) / 16)) << "one more at most";
        }
        for (std::size_t first = 0; first + 16 <= codes.size(); ++first) {
            int sum = 0;
            for (std::size_t i = 0; i < 16; ++i) sum += codes[first + i];
            ASSERT_EQ(sum, static_cast<int>(sum_q4)) << "from conversion " << first;
        }
        ASSERT_EQ(input.unsettled_count, 0u);
    }
}

TEST(AnalogInput, TheHighestSumIsTheHighestCodeSixteenTimes) {
    AnalogInput input(kClockHz);
    uint64_t t = 1000;
    input.set_sensor_sum(0, 65520, t);
    for (int j = 0; j < 16; ++j) EXPECT_EQ(convert(input, 0, kAcquisitionT, t), 4095);
}

TEST(AnalogInput, ReplayedSumsOfTwoChannelsDoNotDisturbEachOther) {
    AnalogInput input(kClockHz);
    uint64_t t = 1000;
    input.set_sensor_sum(1, 16 * 100 + 7, t);
    input.set_sensor_sum(2, 16 * 4000 + 9, t);
    int sum_1 = 0, sum_2 = 0;
    for (int j = 0; j < 16; ++j) {
        sum_1 += convert(input, 1, kAcquisitionT, t);
        sum_2 += convert(input, 2, kAcquisitionT, t);
    }
    EXPECT_EQ(sum_1, 1607);
    EXPECT_EQ(sum_2, 64009);
    input.set_sensor(1, 0, t);
    EXPECT_EQ(convert(input, 1, kAcquisitionT, t), 2048) << "a voltage ends the replay";
}

TEST(AnalogInput, ASilentChannelIsBusyForAsLongAsItIsSelected) {
    AnalogInput input(kClockHz);
    uint64_t t = 1000;
    input.set_sensor(1, 0, t);
    input.set_silent(0, t);
    input.select(0, t);
    input.write(0, 0, t += kAcquisitionT);
    EXPECT_TRUE(input.busy(t + kConversionT));
    EXPECT_TRUE(input.busy(t + 100 * kConversionT));
    EXPECT_EQ(input.read(0, t + 100 * kConversionT), 0xFF) << "nothing drives the bus";
    t += 100 * kConversionT;
    EXPECT_EQ(convert(input, 1, kAcquisitionT, t), 2048);
    EXPECT_FALSE(input.busy(t));
    input.set_sensor(0, 0, t);
    EXPECT_EQ(convert(input, 0, kAcquisitionT, t), 2048) << "plugged in again";
}

TEST(AnalogInput, PropertiesNameAllThreeParts) {
    AnalogInput input(kClockHz);
    std::string all;
    for (const auto& [name, value] : input.properties(10)) all += name + ";";
    EXPECT_NE(all.find("multiplexer: channel;"), std::string::npos);
    EXPECT_NE(all.find("sample-and-hold: held too early;"), std::string::npos);
    EXPECT_NE(all.find("converter: conversions;"), std::string::npos);
    EXPECT_NE(all.find("conversions started too early;"), std::string::npos);
}

RC_GTEST_PROP(AnalogInput, StridesOfTimeLeaveTheSameState, ()) {
    AnalogInput one(kClockHz);
    AnalogInput many(kClockHz);
    uint64_t t = 100;
    const auto gaps = *rc::gen::container<std::vector<int>>(rc::gen::inRange<int>(0, 150));
    for (const int gap : gaps) {
        const uint64_t until = t + static_cast<uint64_t>(gap);
        for (; t < until; ++t) many.advance(t);
        t = until;
        const auto channel = *rc::gen::inRange<unsigned>(0, 16);
        const auto uv = *rc::gen::inRange<int32_t>(-5'000'000, 5'000'000);
        const auto action = *rc::gen::inRange<int>(0, 5);
        for (AnalogInput* input : {&one, &many}) {
            if (action == 0) input->set_sensor(channel, uv, t);
            if (action == 1) input->select(channel, t);
            if (action == 2) input->write(channel & 1, 0, t);
            if (action == 3) input->set_sensor_sum(channel, static_cast<uint16_t>(uv & 0x7FFF), t);
            if (action == 4) input->set_silent(channel, t);
        }
    }
    one.advance(t + 200);
    many.advance(t + 200);
    RC_ASSERT(one == many);
}

}  // namespace
