// Husky runs: conversion of runs whose truth is known, refusals, and the real recordings.
#include "host_sim/import/borealtc.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "host_sim/import/board_counts.hpp"
#include "host_sim/log/log_io.hpp"

namespace {

using namespace host_sim;

constexpr double kDeg = std::numbers::pi / 180;
constexpr std::size_t kPitch = 3;  // converter channels, hal/io.hpp
constexpr std::size_t kRoll = 4;

std::string imu_row(double time_s, double ax, double ay, double az) {
    std::string row = std::to_string(time_s) + ",0,0,0";
    for (const double a : {ax, ay, az}) row.append(",").append(std::to_string(a));
    return row + "\n";
}

/// A run at rest on a slope: specific force of a vehicle pitched nose up, then rolled right side
/// down (x forward, y left, z up).
std::string imu_on_slope(int rows, double pitch_deg, double roll_deg) {
    std::string text = std::string(kBorealtcImuHeader) + "\n";
    for (int row = 0; row < rows; ++row) {
        const double across = std::cos(pitch_deg * kDeg);
        text += imu_row(row * 0.01, 9.81 * std::sin(pitch_deg * kDeg),
                        9.81 * across * std::sin(roll_deg * kDeg),
                        9.81 * across * std::cos(roll_deg * kDeg));
    }
    return text;
}

std::string pro_of(double duration_s, double left_m_s, double right_m_s, double per_s = 0) {
    std::string text = std::string(kBorealtcProHeader) + "\n";
    for (double time_s = 0; time_s <= duration_s + 0.16; time_s += 0.154) {
        text += std::to_string(time_s) + ",1,2," + std::to_string(left_m_s + per_s * time_s) + "," +
                std::to_string(right_m_s + per_s * time_s) + "\n";
    }
    return text;
}

Log import_texts(const std::string& imu, const std::string& pro) {
    return import_borealtc(parse_numeric_table(imu, "imu.csv", kBorealtcImuHeader),
                           parse_numeric_table(pro, "pro.csv", kBorealtcProHeader));
}

double read_deg(const Log& log, std::size_t step, std::size_t channel) {
    return (log.steps[step].inputs.adc_q4_count[channel] - 32760) * 150.0 / 65536;
}

TEST(Borealtc, NoseUpAndRightSideDownArePositive) {
    const Log log = import_texts(imu_on_slope(101, 12, -7), pro_of(1, 0, 0));
    ASSERT_EQ(log.steps.size(), 10U);
    for (std::size_t step = 0; step < 10; ++step) {
        EXPECT_NEAR(read_deg(log, step, kPitch), 12, 150.0 / 4096 / 2 + 0.003);
        EXPECT_NEAR(read_deg(log, step, kRoll), -7, 150.0 / 4096 / 2 + 0.003);
    }
}

TEST(Borealtc, AStepAveragesTheTenSamplesThatEndWithIt) {
    std::string imu = std::string(kBorealtcImuHeader) + "\n";
    for (int row = 0; row <= 20; ++row) {  // rows 1..10 level, 11..20 at 10 deg
        const double pitch = row <= 10 ? 0.01 : 10.0;
        imu += imu_row(row * 0.01, std::sin(pitch * kDeg), 0, std::cos(pitch * kDeg));
    }
    const Log log = import_texts(imu, pro_of(0.2, 0, 0));
    ASSERT_EQ(log.steps.size(), 2U);
    EXPECT_NEAR(read_deg(log, 0, kPitch), 0.01, 0.025);
    EXPECT_NEAR(read_deg(log, 1, kPitch), 10, 0.025);
    EXPECT_EQ(log.steps[0].time_ms, 100U);
    EXPECT_EQ(log.steps[1].inputs.tick_count, 20);
}

TEST(Borealtc, TachometersIntegrateTheSpeedOfTheirSide) {
    const Log log = import_texts(imu_on_slope(1001, 0, 0), pro_of(10, -0.2, 0.3, 0.05));
    ASSERT_EQ(log.steps.size(), 100U);
    const double m_per_count = 2 * std::numbers::pi * 0.1651 / 2000;
    for (const LogStep& step : log.steps) {
        const double t = step.time_ms / 1000.0;
        const double left_m = -0.2 * t + 0.05 * t * t / 2;
        const double right_m = 0.3 * t + 0.05 * t * t / 2;
        const auto& tach = step.inputs.tach_count;
        // One count of floor, and the six decimals of the table.
        EXPECT_NEAR(static_cast<std::int16_t>(tach[0]) * m_per_count + m_per_count / 2, left_m,
                    m_per_count * 0.51 + 1e-5);
        EXPECT_NEAR(tach[1] * m_per_count + m_per_count / 2, right_m, m_per_count * 0.51 + 1e-5);
        EXPECT_EQ(tach[4], tach[0]);
        EXPECT_EQ(tach[5], tach[1]);
    }
}

TEST(Borealtc, OnlyWhatTheVehicleHasIsPresent) {
    const Log log = import_texts(imu_on_slope(101, 0, 0), pro_of(1, 0.1, 0.1));
    for (const LogStep& step : log.steps) {
        for (std::size_t channel = 0; channel < hal::kAdcChannelCount; ++channel) {
            const bool present = channel == kPitch || channel == kRoll;
            EXPECT_EQ(step.inputs.adc_q4_count[channel] != hal::kAdcAbsent, present) << channel;
        }
        EXPECT_EQ(step.inputs.tach_present, 0b110011);
        EXPECT_EQ(step.inputs.range_present, 0);
        EXPECT_FALSE(step.truth.has_value());
        EXPECT_FALSE(step.estimates.has_value());
        EXPECT_FALSE(step.commands.has_value());
    }
    EXPECT_EQ(log.head.calibration.tach_q16_mm_per_count, 33992);  // 2 pi 165.1 / 2000 * 65536
    EXPECT_EQ(log.head.calibration.wheel_radius_q4_mm, 2642);
}

TEST(Borealtc, EndsWhereTheShorterFileEnds) {
    EXPECT_EQ(import_texts(imu_on_slope(1001, 0, 0), pro_of(3, 0, 0)).steps.size(), 30U);
    EXPECT_EQ(import_texts(imu_on_slope(205, 0, 0), pro_of(9, 0, 0)).steps.size(), 20U);
}

std::string refusal(const std::string& imu, const std::string& pro) {
    try {
        (void)import_texts(imu, pro);
        return "";
    } catch (const LogError& error) {
        return error.what();
    }
}

TEST(Borealtc, RefusesInertialRowsThatAreNotTenMillisecondsApart) {
    std::string gap = imu_on_slope(50, 0, 0) + imu_row(0.51, 0, 0, 9.81);
    EXPECT_TRUE(refusal(gap, pro_of(1, 0, 0)).starts_with("imu.csv:52: "));
    std::string drift = std::string(kBorealtcImuHeader) + "\n";
    for (int row = 0; row < 100; ++row) drift += imu_row(row * 0.0104, 0, 0, 9.81);
    EXPECT_TRUE(refusal(drift, pro_of(1, 0, 0)).starts_with("imu.csv:5: "));
}

TEST(Borealtc, RefusesAnAccelerationWithoutDirectionOrOutOfReason) {
    EXPECT_TRUE(refusal(imu_on_slope(11, 0, 0) + imu_row(0.11, 0, 0, 0), pro_of(1, 0, 0))
                    .starts_with("imu.csv:13: "));
    EXPECT_TRUE(refusal(imu_on_slope(11, 0, 0) + imu_row(0.11, 600, 0, 0), pro_of(1, 0, 0))
                    .starts_with("imu.csv:13: "));
}

TEST(Borealtc, RefusesWheelSpeedsOutOfReasonAndGaps) {
    EXPECT_TRUE(refusal(imu_on_slope(101, 0, 0), pro_of(1, 0, 5.1)).starts_with("pro.csv:2: "));
    EXPECT_TRUE(refusal(imu_on_slope(101, 0, 0), pro_of(0, 0, 0) + "0.9,0,0,0,0\n")
                    .starts_with("pro.csv:4: "));
}

TEST(Borealtc, RefusesLessThanOneStep) {
    EXPECT_FALSE(refusal(imu_on_slope(10, 0, 0), pro_of(1, 0, 0)).empty());
    EXPECT_FALSE(refusal(imu_on_slope(101, 0, 0), std::string(kBorealtcProHeader) + "\n0,0,0,0,0\n")
                     .empty());
}

class BorealtcRuns : public testing::Test {
protected:
    void SetUp() override {
        folder_ =
            std::filesystem::path(ROVER_SOURCE_DIR) / "../shared/data/borealtc-proprioception";
        if (!std::filesystem::exists(folder_)) {
            GTEST_SKIP() << "data set borealtc-proprioception is not here";
        }
    }
    [[nodiscard]] Log run(const std::string& name) const {
        return import_borealtc(folder_ / (name + "_imu.csv"), folder_ / (name + "_pro.csv"));
    }
    std::filesystem::path folder_;
};

TEST_F(BorealtcRuns, AllImportWithOneStepPerTenthOfASecond) {
    int runs = 0;
    for (const auto& file : std::filesystem::directory_iterator(folder_)) {
        const std::string name = file.path().filename().string();
        if (!name.ends_with("_imu.csv")) continue;
        const Log log = run(name.substr(0, name.size() - 8));
        ++runs;
        EXPECT_GE(log.steps.size(), 390U) << name;
        double pitch_sum_deg = 0;
        for (std::size_t step = 0; step < log.steps.size(); ++step) {
            ASSERT_EQ(log.steps[step].time_ms, (step + 1) * 100);
            pitch_sum_deg += read_deg(log, step, kPitch);
        }
        EXPECT_LT(std::abs(pitch_sum_deg / static_cast<double>(log.steps.size())), 10) << name;
    }
    EXPECT_EQ(runs, 8);
}

// Distance of each side against a sum over the rows of the file made by a separate script:
// trapezoids from 0 to 120 s.
TEST_F(BorealtcRuns, FlooringDistanceIsThatOfTheRecordedSpeeds) {
    const Log log = run("flooring_00");
    const NumericTable pro =
        read_numeric_table(folder_ / "flooring_00_pro.csv", kBorealtcProHeader);
    double left_m = 0;
    for (std::size_t row = 1; row < pro.row_count(); ++row) {
        left_m += (pro.at(row, 0) - pro.at(row - 1, 0)) * (pro.at(row, 3) + pro.at(row - 1, 3)) / 2;
    }
    double counted_m = 0;
    std::uint16_t before = 0;
    for (const LogStep& step : log.steps) {
        const std::uint16_t count = step.inputs.tach_count[0];
        counted_m += static_cast<std::int16_t>(static_cast<std::uint16_t>(count - before)) *
                     (log.head.calibration.tach_q16_mm_per_count / 65536e3);
        before = count;
    }
    EXPECT_NEAR(counted_m, left_m, 0.001 + 2e-5 * std::abs(left_m));
}

// The axes are not documented: x is forward because the vehicle accelerates along +x when its
// wheels speed up, z is up and right-handed because it turns to + when the right side is faster.
TEST_F(BorealtcRuns, AxesAreForwardLeftUp) {
    const NumericTable imu =
        read_numeric_table(folder_ / "flooring_00_imu.csv", kBorealtcImuHeader);
    const NumericTable pro =
        read_numeric_table(folder_ / "flooring_00_pro.csv", kBorealtcProHeader);
    double forward = 0, forward_norm = 0, thrust_norm = 0, turn = 0, turn_norm = 0, rate_norm = 0;
    for (std::size_t row = 1; row + 1 < pro.row_count(); ++row) {
        const auto from = static_cast<std::size_t>(pro.at(row - 1, 0) * 100);
        const auto to = static_cast<std::size_t>(pro.at(row + 1, 0) * 100);
        double ax = 0, wz = 0;
        for (std::size_t i = from; i < to; ++i) {
            ax += imu.at(i, 4) / static_cast<double>(to - from);
            wz += imu.at(i, 3) / static_cast<double>(to - from);
        }
        const double speeding =
            (pro.at(row + 1, 3) + pro.at(row + 1, 4) - pro.at(row - 1, 3) - pro.at(row - 1, 4)) /
            2 / (pro.at(row + 1, 0) - pro.at(row - 1, 0));
        const double turning = pro.at(row, 4) - pro.at(row, 3);
        forward += ax * speeding;
        forward_norm += speeding * speeding;
        thrust_norm += ax * ax;
        turn += wz * turning;
        turn_norm += turning * turning;
        rate_norm += wz * wz;
    }
    EXPECT_GT(forward / std::sqrt(forward_norm * thrust_norm), 0.3);
    EXPECT_GT(turn / std::sqrt(turn_norm * rate_norm), 0.9);
}

}  // namespace
