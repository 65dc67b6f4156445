// statistics.hpp - robust means and honest standard errors of converter counts.
// Depends on   nothing.     Source  docs/spec/calibration.md, "Uncertainty".
// Tests        tests/host_sim/calibration/statistics_test.cpp
#pragma once

#include <span>

namespace host_sim {

/// One 12-bit code in the sum of 16 conversions, Q4 counts.
inline constexpr double kCodeQ4Count = 16;

/// Mean without the lowest and highest fifth (rounded down). NaN for no values.
double trimmed_mean(std::span<const double> values);

/// Sample standard deviation (n - 1). 0 for fewer than two values.
double standard_deviation(std::span<const double> values);

/// Q4 counts: bound on the RMS error that quantisation leaves in the mean of many readings.
/// A reading that never varies may lie anywhere within a code: 16/sqrt(12). Noise of the
/// conversions dithers this away as exp(-2 pi^2 (sigma/code)^2); the sum's spread gives the least
/// dither there can be, sigma/16 codes, if all 16 conversions move together.
/// @param sigma_q4_count  standard deviation of the sums of 16
double quantisation_error_q4_count(double sigma_q4_count);

}  // namespace host_sim
