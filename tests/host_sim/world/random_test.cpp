// random_test.cpp - against published sequences and distributions.
#include "host_sim/world/random.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <vector>

namespace host_sim {
namespace {

// The published reference sequence of SplitMix64 from the state 1234567.
TEST(SplitMix64, GivesThePublishedSequence) {
    std::uint64_t state = 1234567;
    for (const std::uint64_t expected :
         {6457827717110365317u, 3203168211198807973u, 9817491932198370423u, 4593380528125082431u,
          16408922859458223821u}) {
        EXPECT_EQ(splitmix64(state), expected);
    }
}

TEST(Random, StreamsOfOneSeedDifferByNameAndSeed) {
    std::set<std::uint64_t> first;
    for (const char* name : {"terrain", "sinkage", "advance", "sensors", ""}) {
        for (std::uint64_t seed = 0; seed < 1000; ++seed) first.insert(stream(seed, name).bits());
    }
    EXPECT_EQ(first.size(), 5000u);
    Random again = stream(7, "terrain");
    Random same = stream(7, "terrain");
    for (int i = 0; i < 100; ++i) ASSERT_EQ(again.bits(), same.bits());
}

// Bounds five standard deviations of the estimate wide, so a false alarm is a one in a million.
TEST(Random, UniformHasTheMeanAndVarianceOfTheUnitInterval) {
    Random random = stream(1, "uniform");
    constexpr int kCount = 1000000;
    double sum = 0;
    double squares = 0;
    for (int i = 0; i < kCount; ++i) {
        const double value = random.uniform();
        ASSERT_GE(value, 0.0);
        ASSERT_LT(value, 1.0);
        sum += value;
        squares += value * value;
    }
    EXPECT_NEAR(sum / kCount, 0.5, 5 * std::sqrt(1.0 / 12 / kCount));
    EXPECT_NEAR(squares / kCount, 1.0 / 3, 5 * std::sqrt(4.0 / 45 / kCount));
}

// Kolmogorov-Smirnov distance from the normal distribution function, and the first four moments.
TEST(Random, NormalFollowsTheNormalDistribution) {
    Random random = stream(2, "normal");
    constexpr int kCount = 1000000;
    std::vector<double> values(kCount);
    double moment[5] = {};
    for (double& value : values) {
        value = random.normal();
        double power = 1;
        for (double& sum : moment) {
            sum += power / kCount;
            power *= value;
        }
    }
    EXPECT_NEAR(moment[1], 0, 5 * std::sqrt(1.0 / kCount));
    EXPECT_NEAR(moment[2], 1, 5 * std::sqrt(2.0 / kCount));
    EXPECT_NEAR(moment[3], 0, 5 * std::sqrt(15.0 / kCount));
    EXPECT_NEAR(moment[4], 3, 5 * std::sqrt(96.0 / kCount));
    std::sort(values.begin(), values.end());
    double distance = 0;
    for (int i = 0; i < kCount; ++i) {
        const double expected =
            0.5 * std::erfc(-values[static_cast<std::size_t>(i)] / std::sqrt(2.0));
        distance = std::max({distance, std::abs(expected - static_cast<double>(i) / kCount),
                             std::abs(expected - static_cast<double>(i + 1) / kCount)});
    }
    EXPECT_LT(distance, 2.23 / std::sqrt(kCount));  // exceeded once in 10,000 by chance
}

// The share beyond 4 sigma is 6.33e-5: the tail branch of the ziggurat is right too.
TEST(Random, NormalHasTheRightShareBeyondFourSigma) {
    Random random = stream(3, "normal");
    constexpr int kCount = 4000000;
    int beyond = 0;
    for (int i = 0; i < kCount; ++i) beyond += std::abs(random.normal()) > 4.0 ? 1 : 0;
    const double expected = std::erfc(4.0 / std::sqrt(2.0)) * kCount;
    EXPECT_NEAR(beyond, expected, 5 * std::sqrt(expected));
}

}  // namespace
}  // namespace host_sim
