#include "host_sim/calibration/statistics.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <vector>

namespace host_sim {

double trimmed_mean(std::span<const double> values) {
    if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
    std::vector<double> sorted(values.begin(), values.end());
    std::ranges::sort(sorted);
    const std::size_t cut = sorted.size() / 5;
    const std::span<const double> kept(sorted.data() + cut, sorted.size() - 2 * cut);
    return std::accumulate(kept.begin(), kept.end(), 0.0) / static_cast<double>(kept.size());
}

double standard_deviation(std::span<const double> values) {
    if (values.size() < 2) return 0;
    const double n = static_cast<double>(values.size());
    const double mean = std::accumulate(values.begin(), values.end(), 0.0) / n;
    double sum = 0;
    for (const double value : values) sum += (value - mean) * (value - mean);
    return std::sqrt(sum / (n - 1));
}

double quantisation_error_q4_count(double sigma_q4_count) {
    const double dither_codes = sigma_q4_count / kCodeQ4Count;
    return kCodeQ4Count / std::sqrt(12.0) *
           std::exp(-2 * std::numbers::pi * std::numbers::pi * dither_codes * dither_codes);
}

}  // namespace host_sim
