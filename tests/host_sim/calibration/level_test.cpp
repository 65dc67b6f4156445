#include "host_sim/calibration/level.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "hal/io.hpp"

namespace {

using namespace host_sim;

/// `count` readings at 10 Hz: mean, white noise, noise with memory, drift over the whole stretch.
std::vector<Reading> standing(int count, double mean, double sigma, double memory, double drift,
                              std::uint64_t seed) {
    std::mt19937_64 random(seed);
    std::normal_distribution<double> normal;
    std::vector<Reading> readings;
    double noise = 0;
    for (int i = 0; i < count; ++i) {
        noise = memory * noise + std::sqrt(1 - memory * memory) * sigma * normal(random);
        readings.push_back(
            {static_cast<std::uint32_t>(100 * i),
             static_cast<std::uint16_t>(std::lround(mean + noise + drift * i / count))});
    }
    return readings;
}

// Sums change in steps of one Q4 count here, so the only error is that of the noise.
TEST(Level, ErrorMatchesTheStatedOneWithWhiteAndCorrelatedNoise) {
    for (const double memory : {0.0, 0.5}) {
        double square = 0;
        constexpr int kRuns = 300;
        for (int seed = 1; seed <= kRuns; ++seed) {
            const LevelReading level = read_level(
                standing(200, 32900, 12, memory, 0, static_cast<std::uint64_t>(seed)), {0, 20});
            square += std::pow((level.q4_count - 32900) / level.standard_error_q4_count, 2) / kRuns;
        }
        EXPECT_GT(std::sqrt(square), 0.5) << memory;
        EXPECT_LT(std::sqrt(square), 1.35) << memory;
    }
}

TEST(Level, UsesTheStretchOnly) {
    std::vector<Reading> readings = standing(100, 30000, 0, 0, 0, 1);
    for (std::size_t i = 40; i < 80; ++i) readings[i].q4_count = 33000;
    EXPECT_EQ(read_level(readings, {4, 8}).q4_count, 33000);
    EXPECT_NEAR(read_level(readings, {4, 8}).standard_error_q4_count, 16 / std::sqrt(12.0), 1e-9);
}

std::string refusal(const std::vector<Reading>& readings, TimeSpan span) {
    try {
        (void)read_level(readings, span);
        return "";
    } catch (const CalibrationError& error) {
        return error.what();
    }
}

TEST(LevelRefuses, EachReason) {
    const auto quiet = standing(100, 32760, 5, 0, 0, 1);
    EXPECT_EQ(refusal(quiet, {0, 10}), "");
    EXPECT_NE(refusal(quiet, {0, 1.9}).find("shorter"), std::string::npos);
    EXPECT_NE(refusal(quiet, {5, 3}).find("shorter"), std::string::npos);
    EXPECT_NE(refusal(quiet, {0, std::nan("")}).find("shorter"), std::string::npos);
    EXPECT_NE(refusal(quiet, {9, 30}).find("10 readings, at least 20"), std::string::npos);
    EXPECT_NE(refusal(standing(100, 32760, 90, 0, 0, 1), {0, 10}).find("scatter"),
              std::string::npos);
    EXPECT_NE(refusal(standing(100, 32760, 5, 0, 120, 1), {0, 10}).find("moved"),
              std::string::npos);
    std::vector<Reading> absent = quiet;
    for (Reading& reading : absent) reading.q4_count = hal::kAdcAbsent;
    EXPECT_NE(refusal(absent, {0, 10}).find("absent"), std::string::npos);
}

}  // namespace
