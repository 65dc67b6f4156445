// sample_hold_test.cpp - sampling, holding, acquisition. 10 us * 3.072 MHz = 30.72 -> 31 T.
#include "host_sim/chips/sample_hold.hpp"

#include <gtest/gtest.h>

namespace {

using host_sim::chips::SampleHold;

constexpr uint64_t kClockHz = 3'072'000;

TEST(SampleHold, HoldsWhateverTheInputDoes) {
    SampleHold amplifier(kClockHz);
    EXPECT_EQ(amplifier.output_uv(700, 1000), 700);
    amplifier.hold(700, 1000);
    EXPECT_EQ(amplifier.output_uv(-9, 1001), 700);
    EXPECT_EQ(amplifier.output_uv(-9, 1'000'000), 700);
    EXPECT_EQ(amplifier.early_hold_count, 0u);
    amplifier.hold(-9, 2000);
    EXPECT_EQ(amplifier.output_uv(-9, 2000), 700) << "it holds already";
    amplifier.input_jumps(-9, 2000);
    EXPECT_EQ(amplifier.output_uv(-9, 2000), 700);
}

TEST(SampleHold, AcquiresIn31TStates) {
    SampleHold amplifier(kClockHz);
    amplifier.hold(0, 1000);
    amplifier.sample(2000);
    EXPECT_EQ(amplifier.output_uv(8192, 2000), 0);
    EXPECT_EQ(amplifier.output_uv(8192, 2003), 4096) << "13 * 3 / 31 = 1 half-life";
    EXPECT_EQ(amplifier.output_uv(8192, 2030), 8190) << "13 * 30 / 31 = 12: 2 are left";
    EXPECT_FALSE(amplifier.acquired(2030));
    EXPECT_TRUE(amplifier.acquired(2031));
    EXPECT_EQ(amplifier.output_uv(8192, 2031), 8192);
    amplifier.sample(2040);
    EXPECT_TRUE(amplifier.acquired(2040)) << "it samples already";
}

TEST(SampleHold, HeldTooEarlyIsAMixtureAndIsCounted) {
    SampleHold amplifier(kClockHz);
    amplifier.hold(0, 1000);
    amplifier.sample(2000);
    amplifier.hold(8192, 2003);
    EXPECT_EQ(amplifier.output_uv(8192, 9000), 4096);
    EXPECT_EQ(amplifier.early_hold_count, 1u);
}

TEST(SampleHold, JumpOfTheInputWhileSamplingIsAcquiredAnew) {
    SampleHold amplifier(kClockHz);
    amplifier.input_jumps(1000, 5000);
    EXPECT_EQ(amplifier.output_uv(9192, 5000), 1000);
    EXPECT_EQ(amplifier.output_uv(9192, 5003), 1000 + 4096);
    EXPECT_EQ(amplifier.output_uv(9192, 5031), 9192);
}

TEST(SampleHold, PropertiesNameTheMode) {
    SampleHold amplifier(kClockHz);
    EXPECT_EQ(amplifier.properties()[0].value, "samples since T 0");
    amplifier.hold(12, 100);
    EXPECT_EQ(amplifier.properties()[0].value, "holds 12 uV");
}

}  // namespace
