#include "host_sim/calibration/level.hpp"

#include <fmt/format.h>

#include <cmath>
#include <vector>

#include "hal/io.hpp"
#include "host_sim/calibration/statistics.hpp"

namespace host_sim {
namespace {

constexpr std::size_t kBlocks = 8;

std::vector<double> cut_out(std::span<const Reading> readings, TimeSpan span,
                            const LevelOptions& options) {
    if (!(span.to_s - span.from_s >= options.duration_min_s)) {
        throw CalibrationError(fmt::format("the level stretch {} to {} s is shorter than {} s",
                                           span.from_s, span.to_s, options.duration_min_s));
    }
    std::vector<double> values;
    std::size_t absent = 0;
    for (const Reading& reading : readings) {
        if (reading.time_ms < span.from_s * 1000 || reading.time_ms >= span.to_s * 1000) continue;
        if (reading.q4_count > hal::kAdcMaxQ4Count) {
            ++absent;
        } else {
            values.push_back(reading.q4_count);
        }
    }
    if (values.empty() && absent > 0) throw CalibrationError("the sensor is absent");
    if (static_cast<double>(values.size()) < options.duration_min_s * 10) {
        throw CalibrationError(
            fmt::format("the level stretch {} to {} s holds {} readings, at least {:.0f} needed",
                        span.from_s, span.to_s, values.size(), options.duration_min_s * 10));
    }
    return values;
}

}  // namespace

LevelReading read_level(std::span<const Reading> readings, TimeSpan span,
                        const LevelOptions& options) {
    const std::vector<double> values = cut_out(readings, span, options);
    const std::span<const double> all(values);
    const auto part = [&](std::size_t index, std::size_t parts) {
        const std::size_t begin = all.size() * index / parts;
        return all.subspan(begin, all.size() * (index + 1) / parts - begin);
    };
    const double noise = std::max(standard_deviation(part(0, 2)), standard_deviation(part(1, 2)));
    if (noise > options.noise_max_q4_count) {
        throw CalibrationError(
            fmt::format("the readings scatter by {:.0f} Q4 counts in the level stretch, at most "
                        "{:.0f} is usable: stand still, motors off",
                        noise, options.noise_max_q4_count));
    }
    std::vector<double> block_means;
    for (std::size_t block = 0; block < kBlocks; ++block) {
        block_means.push_back(trimmed_mean(part(block, kBlocks)));
    }
    const double statistical = standard_deviation(block_means) / std::sqrt(double{kBlocks});
    const double drift = std::abs(trimmed_mean(part(0, 2)) - trimmed_mean(part(1, 2)));
    const double half_error = noise * std::sqrt(2.0 / static_cast<double>(all.size()));
    if (drift > kCodeQ4Count + 4 * std::sqrt(2.0) * half_error) {
        throw CalibrationError(fmt::format(
            "the vehicle moved in the level stretch: its halves differ by {:.0f} Q4 counts",
            drift));
    }
    return {trimmed_mean(all), std::hypot(statistical, quantisation_error_q4_count(noise))};
}

}  // namespace host_sim
