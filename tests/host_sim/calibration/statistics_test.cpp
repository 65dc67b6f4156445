#include "host_sim/calibration/statistics.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

namespace {

using namespace host_sim;

TEST(TrimmedMean, DropsAFifthAtEachEnd) {
    EXPECT_EQ(trimmed_mean(std::vector<double>{1000, 2, 3, 4, -900}), 3);
    EXPECT_EQ(trimmed_mean(std::vector<double>{1, 2, 6, 3}), 3);  // four values: nothing dropped
    EXPECT_EQ(trimmed_mean(std::vector<double>{7}), 7);
    EXPECT_TRUE(std::isnan(trimmed_mean({})));
}

TEST(StandardDeviation, IsTheSampleOne) {
    EXPECT_NEAR(standard_deviation(std::vector<double>{2, 4, 4, 4, 5, 5, 7, 9}),
                std::sqrt(32.0 / 7), 1e-12);
    EXPECT_EQ(standard_deviation(std::vector<double>{5}), 0);
}

TEST(QuantisationError, IsThatOfOneCodeWithoutNoise) {
    EXPECT_NEAR(quantisation_error_q4_count(0), 16 / std::sqrt(12.0), 1e-12);
}

// The bound holds in the worst case it is made for: all 16 conversions move together. Reference:
// the mean of floor(x + noise) integrated numerically, over all places of x within a code.
TEST(QuantisationError, BoundsTheErrorThatNoiseLeaves) {
    for (const double sigma_codes : {0.0, 0.1, 0.2, 0.3, 0.4, 0.6}) {
        double square = 0;
        double variance = 0;
        constexpr int kPlaces = 64;
        for (int place = 0; place < kPlaces; ++place) {
            const double x = (place + 0.5) / kPlaces;
            double mean = 0, mean_square = 0, weight = 0;
            for (int i = -3000; i <= 3000; ++i) {
                const double deviate = i / 500.0;
                const double density = std::exp(-deviate * deviate / 2);
                const double code = std::floor(x + sigma_codes * deviate);
                mean += density * code;
                mean_square += density * code * code;
                weight += density;
            }
            mean /= weight;
            variance += (mean_square / weight - mean * mean) / kPlaces;
            square += (mean + 0.5 - x) * (mean + 0.5 - x) / kPlaces;
        }
        const double left_q4_count = 16 * std::sqrt(square);
        // The bound sees the spread of the readings, which quantisation itself widens; it may
        // only use the part that is dither.
        EXPECT_LE(left_q4_count, quantisation_error_q4_count(16 * sigma_codes) + 0.01)
            << sigma_codes;
        RecordProperty("spread", std::to_string(variance));
    }
}

}  // namespace
