// angles_test.cpp - counts to angles for every count; faults of a channel.
#include "firmware/inputs/angles.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace {

using hal::AngleCalibration;
using hal::AngleChannel;

/// The formula of hal/calibration.hpp in double, ties away from zero, clamped to s16.
double real_angle_brad(std::uint32_t count, const AngleCalibration& calibration) {
    const double away = static_cast<double>(count) - calibration.zero_q4_count;
    const double brad = std::round(away * calibration.gain_q16 / 65536.0);
    return std::fmax(-32767.0, std::fmin(32767.0, calibration.inverted ? -brad : brad));
}

TEST(AngleFromCount, IsTheRoundedProductForEveryCount) {
    for (const int gain : {1, 3, 8192, 16384, 16397, 27307, 32768, 40000, 65535}) {
        for (const int zero : {0, 1, 1000, 32760, 40001, 65520}) {
            for (const bool inverted : {false, true}) {
                const AngleCalibration calibration{static_cast<std::uint16_t>(zero),
                                                   static_cast<std::uint16_t>(gain), inverted};
                for (std::uint32_t count = 0; count <= hal::kAdcMaxQ4Count; ++count) {
                    const auto got =
                        rover::angle_from_count(static_cast<std::uint16_t>(count), calibration);
                    ASSERT_EQ(got, real_angle_brad(count, calibration))
                        << "count " << count << " gain " << gain << " zero " << zero;
                }
            }
        }
    }
}

TEST(AngleFromCount, NominalGainsSpan45And75Degrees) {
    // Full scale is 65536 Q4 counts: 32760 counts are 0.49988 of it.
    const double degree = 65536.0 / 360.0;
    EXPECT_NEAR(rover::angle_from_count(65520, {32760, hal::kPotentiometerGainQ16, false}),
                45.0 * degree * 32760 / 32768, 0.6);
    EXPECT_NEAR(rover::angle_from_count(0, {32760, hal::kInclinometerGainQ16, false}),
                -75.0 * degree * 32760 / 32768, 0.6);
}

struct Bench {
    hal::RawInputs inputs;
    hal::Calibration calibration;
    rover::StuckWatch watch;
    rover::Angles angles;

    Bench() {
        for (std::uint8_t i = 0; i < hal::kAngleChannelCount; ++i) {
            set(static_cast<AngleChannel>(i), static_cast<std::uint16_t>(30000 + 100 * i));
        }
    }
    void set(AngleChannel channel, std::uint16_t count) {
        using enum hal::AdcChannel;
        constexpr hal::AdcChannel kAdc[] = {bogie_left, bogie_right, differential, pitch, roll};
        const hal::AdcChannel adc = kAdc[static_cast<std::size_t>(channel)];
        inputs.adc_q4_count[static_cast<std::size_t>(adc)] = count;
    }
    std::uint16_t read() {
        rover::read_angles(inputs, calibration, watch, angles);
        return angles.faults;
    }
};

TEST(ReadAngles, ChannelsComeFromTheirOwnMultiplexerInputs) {
    Bench bench;
    EXPECT_EQ(bench.read(), 0);
    for (std::uint8_t i = 0; i < hal::kAngleChannelCount; ++i) {
        ASSERT_TRUE(bench.angles.has(static_cast<AngleChannel>(i)));
        const bool asked = static_cast<AngleChannel>(i) != AngleChannel::bogie_right;
        EXPECT_EQ(bench.angles.brad[i],
                  asked ? real_angle_brad(30000u + 100u * i, bench.calibration.angle[i]) : 0);
    }
    bench.set(AngleChannel::bogie_left, 0);
    bench.read();
    EXPECT_EQ(bench.angles[AngleChannel::bogie_left], 0);
    EXPECT_EQ(bench.angles[AngleChannel::bogie_right],
              real_angle_brad(30100, bench.calibration.angle[1]));
}

TEST(ReadAngles, AbsentIsInvalidWithoutAFault) {
    for (const std::uint16_t count : {hal::kAdcAbsent, std::uint16_t{65521}}) {
        Bench bench;
        bench.set(AngleChannel::roll, count);
        EXPECT_EQ(bench.read(), 0);
        EXPECT_FALSE(bench.angles.has(AngleChannel::roll));
        EXPECT_TRUE(bench.angles.has(AngleChannel::pitch));
    }
}

TEST(ReadAngles, ARailIsAFaultOfThatChannelAlone) {
    const std::uint16_t bits[] = {rover::kFaultBogieLeft, rover::kFaultBogieRight,
                                  rover::kFaultDifferential, rover::kFaultPitch, rover::kFaultRoll};
    for (std::uint8_t i = 0; i < hal::kAngleChannelCount; ++i) {
        for (const std::uint16_t rail : {std::uint16_t{0}, hal::kAdcMaxQ4Count}) {
            Bench bench;
            bench.set(static_cast<AngleChannel>(i), rail);
            EXPECT_EQ(bench.read(), bits[i]);
            for (std::uint8_t j = 0; j < hal::kAngleChannelCount; ++j) {
                EXPECT_EQ(bench.angles.has(static_cast<AngleChannel>(j)), i != j);
            }
        }
    }
}

TEST(ReadAngles, AnUncalibratedChannelIsAFault) {
    Bench bench;
    bench.calibration.angle[2].gain_q16 = 0;
    EXPECT_EQ(bench.read(), rover::kFaultDifferential);
    EXPECT_FALSE(bench.angles.has(AngleChannel::differential));
}

TEST(StuckWatch, AFrozenChannelIsAFaultAfterEightCyclesAndHealsWhenItChanges) {
    Bench bench;
    std::uint16_t count = 30000;
    for (int cycle = 1; cycle <= 20; ++cycle) {
        count = static_cast<std::uint16_t>(count + 7);
        bench.set(AngleChannel::bogie_left, count);
        bench.set(AngleChannel::bogie_right, count);
        bench.set(AngleChannel::pitch, count);
        bench.set(AngleChannel::roll, count);  // the differential stays
        rover::watch_cycle(bench.watch, bench.inputs);
        // The first cycle only learns the value; eight repetitions later it is believed stuck.
        EXPECT_EQ(bench.read(), cycle >= 9 ? rover::kFaultDifferential : 0) << cycle;
        EXPECT_EQ(bench.angles.has(AngleChannel::differential), cycle < 9) << cycle;
    }
    bench.set(AngleChannel::differential, 30201);
    EXPECT_EQ(bench.read(), 0);
    EXPECT_TRUE(bench.angles.has(AngleChannel::differential));
    rover::watch_cycle(bench.watch, bench.inputs);
    EXPECT_EQ(bench.read(), 0);
}

TEST(StuckWatch, AStuckLeftBogieHandsOverToTheRightOne) {
    Bench bench;
    for (std::uint16_t cycle = 0; cycle < 10; ++cycle) {
        bench.set(AngleChannel::pitch, static_cast<std::uint16_t>(30000 + cycle));
        bench.set(AngleChannel::bogie_right, static_cast<std::uint16_t>(31000 + cycle));
        rover::watch_cycle(bench.watch, bench.inputs);
        bench.read();
    }
    EXPECT_FALSE(bench.angles.has(AngleChannel::bogie_left));
    EXPECT_EQ(bench.angles[AngleChannel::bogie_left], 0);
    EXPECT_TRUE(bench.angles.has(AngleChannel::bogie_right));
    EXPECT_EQ(bench.angles[AngleChannel::bogie_right],
              real_angle_brad(31009, bench.calibration.angle[1]));
}

TEST(StuckWatch, NothingIsStuckWhileNothingChanges) {
    Bench bench;
    for (int cycle = 0; cycle < 1000; ++cycle) rover::watch_cycle(bench.watch, bench.inputs);
    EXPECT_EQ(bench.read(), 0);
}

}  // namespace
