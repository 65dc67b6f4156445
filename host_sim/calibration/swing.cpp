#include "host_sim/calibration/swing.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>
#include <vector>

#include "hal/io.hpp"
#include "host_sim/calibration/statistics.hpp"

namespace host_sim {
namespace {

constexpr std::uint32_t kGapMs = 250;  // readings further apart do not belong to one rest

/// Readings [begin, end) that stay together.
struct Rest {
    std::size_t begin = 0, end = 0;
    std::vector<double> settled;  // without the way in, the way out and outliers
    double level = 0;             // trimmed mean of these
};

std::vector<Reading> present_readings(std::span<const Reading> readings) {
    std::vector<Reading> present;
    std::ranges::copy_if(readings, std::back_inserter(present), [](const Reading& reading) {
        return reading.q4_count <= hal::kAdcMaxQ4Count;
    });
    if (present.empty()) throw CalibrationError("the sensor is absent in the whole log");
    if ((readings.size() - present.size()) * 10 > readings.size()) {
        throw CalibrationError(
            fmt::format("the sensor is absent in {} of {} steps: check its wiring and record again",
                        readings.size() - present.size(), readings.size()));
    }
    return present;
}

double median(std::vector<double> values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::ranges::nth_element(values, middle);
    return *middle;
}

/// The readings of a rest that lie within three robust sigma (1.4826 times the median deviation)
/// of its median, or within 2 Q4 counts. An arm that comes or goes leaves readings further out.
std::vector<double> settled_values(std::span<const Reading> readings) {
    std::vector<double> values, deviations, kept;
    for (const Reading& reading : readings) values.push_back(reading.q4_count);
    const double middle = median(values);
    for (const double value : values) deviations.push_back(std::abs(value - middle));
    const double limit = std::max(2.0, 3 * 1.4826 * median(deviations));
    std::ranges::copy_if(values, std::back_inserter(kept),
                         [&](double value) { return std::abs(value - middle) <= limit; });
    return kept;
}

/// What is left of a rest without its first and last `settle_s`: bounce and way out.
std::span<const Reading> inner_part(std::span<const Reading> rest, double settle_s) {
    const double from_ms = rest.front().time_ms + settle_s * 1000;
    const double to_ms = rest.back().time_ms - settle_s * 1000;
    std::size_t begin = 0, end = rest.size();
    while (begin + 1 < end && rest[begin].time_ms < from_ms) ++begin;
    while (end > begin + 1 && rest[end - 1].time_ms > to_ms) --end;
    return rest.subspan(begin, end - begin);
}

/// Cuts the readings into rests: the longest stretches from left to right whose spread is at most
/// eight times the noise limit.
std::vector<Rest> find_rests(std::span<const Reading> readings, const SwingOptions& options) {
    const double spread = 8 * options.noise_max_q4_count;
    const double dwell_ms = options.dwell_s * 1000;
    std::vector<Rest> rests;
    for (std::size_t begin = 0; begin < readings.size();) {
        int low = readings[begin].q4_count;
        int high = low;
        std::size_t end = begin + 1;
        for (; end < readings.size(); ++end) {
            if (readings[end].time_ms - readings[end - 1].time_ms > kGapMs) break;
            low = std::min<int>(low, readings[end].q4_count);
            high = std::max<int>(high, readings[end].q4_count);
            if (high - low > spread) break;
        }
        if (readings[end - 1].time_ms - readings[begin].time_ms < dwell_ms) {
            ++begin;
            continue;
        }
        std::vector<double> settled =
            settled_values(inner_part(readings.subspan(begin, end - begin), options.settle_s));
        const double level = trimmed_mean(settled);
        rests.push_back({begin, end, std::move(settled), level});
        begin = end;
    }
    return rests;
}

/// Noise from third differences, which a smooth motion hardly disturbs; the lower quartile, so that
/// jerky stretches do not count. Sigma for white noise at rest, up to twice that when half of the
/// log is motion: good to tell why there are no rests, not to measure noise.
double rough_noise(std::span<const Reading> readings) {
    std::vector<double> differences;
    for (std::size_t i = 3; i < readings.size(); ++i) {
        differences.push_back(std::abs(readings[i].q4_count - 3.0 * readings[i - 1].q4_count +
                                       3.0 * readings[i - 2].q4_count - readings[i - 3].q4_count));
    }
    if (differences.empty()) return 0;
    const auto quartile = differences.begin() + static_cast<std::ptrdiff_t>(differences.size() / 4);
    std::ranges::nth_element(differences, quartile);
    return *quartile / 0.3186 / std::sqrt(20.0);  // 0.3186: lower quartile of |N(0, 1)|
}

/// Throws when noise explains that rests are missing.
void blame_noise(std::span<const Reading> readings, const SwingOptions& options) {
    const double noise = rough_noise(readings);
    if (noise > 2 * options.noise_max_q4_count) {
        throw CalibrationError(fmt::format(
            "the readings scatter by about {:.0f} Q4 counts, at most {:.0f} is usable: check "
            "wiring and supply",
            noise, options.noise_max_q4_count));
    }
}

struct Stop {
    std::vector<double> visit_means;
    std::vector<double> visit_noise;
    StopLevel level;
};

/// Gathers the rests at one stop into visits. `away` readings further than a quarter of the span
/// from the extreme end a visit.
Stop gather_stop(std::span<const Reading> readings, const std::vector<Rest>& rests, double extreme,
                 double span, const SwingOptions& options) {
    Stop stop;
    std::vector<double> visit;
    std::size_t visited_until = 0;
    const auto close_visit = [&] {
        if (visit.empty()) return;
        stop.visit_means.push_back(trimmed_mean(visit));
        stop.visit_noise.push_back(standard_deviation(visit));
        visit.clear();
    };
    for (const Rest& rest : rests) {
        if (std::abs(rest.level - extreme) > options.visit_spread_q4_count) continue;
        const auto between = readings.subspan(visited_until, rest.begin - visited_until);
        if (std::ranges::any_of(between, [&](const Reading& reading) {
                return std::abs(reading.q4_count - extreme) > span / 4;
            })) {
            close_visit();
        }
        visit.insert(visit.end(), rest.settled.begin(), rest.settled.end());
        visited_until = rest.end;
    }
    close_visit();
    return stop;
}

void estimate_level(Stop& stop) {
    const double visits = static_cast<double>(stop.visit_means.size());
    double sum = 0;
    for (const double mean : stop.visit_means) sum += mean;
    const double noise = *std::ranges::min_element(stop.visit_noise);
    const double between = standard_deviation(stop.visit_means);
    stop.level.visits = static_cast<int>(stop.visit_means.size());
    stop.level.q4_count = sum / visits;
    stop.level.standard_error_q4_count =
        std::hypot(between / std::sqrt(visits), quantisation_error_q4_count(noise));
}

void check_stop(const Stop& stop, std::string_view name, const SwingOptions& options) {
    const auto visits = static_cast<int>(stop.visit_means.size());
    if (visits < options.visits_min) {
        throw CalibrationError(fmt::format(
            "the {} stop (near {:.0f} Q4 counts) was visited {} times, {} needed: swing to both "
            "stops and hold for {} s each time",
            name, stop.visit_means.front(), visits, options.visits_min, options.dwell_s));
    }
    const double noise = trimmed_mean(stop.visit_noise);
    if (noise > options.noise_max_q4_count) {
        throw CalibrationError(fmt::format(
            "the readings scatter by {:.0f} Q4 counts at the {} stop, at most {:.0f} is "
            "usable: hold still, check wiring and supply",
            noise, name, options.noise_max_q4_count));
    }
    for (const double mean : stop.visit_means) {
        if (mean < kCodeQ4Count || mean > hal::kAdcMaxQ4Count - kCodeQ4Count) {
            throw CalibrationError(fmt::format(
                "the converter is at its limit at the {} stop: turn the potentiometer's body",
                name));
        }
    }
}

void check_overshoot(std::span<const Reading> readings, double low, double high,
                     const SwingOptions& options) {
    for (const Reading& reading : readings) {
        const double beyond =
            std::max(low - reading.q4_count, static_cast<double>(reading.q4_count) - high);
        if (beyond > options.overshoot_q4_count) {
            throw CalibrationError(fmt::format(
                "at {:.1f} s the reading is {:.0f} Q4 counts beyond the outermost rest: that rest "
                "was not the stop, or the reading jumped; hold against each stop and record again",
                reading.time_ms / 1000.0, beyond));
        }
    }
}

}  // namespace

Swing find_swing(std::span<const Reading> readings, const SwingOptions& options) {
    const std::vector<Reading> present = present_readings(readings);
    const std::vector<Rest> rests = find_rests(present, options);
    if (rests.empty()) {
        blame_noise(present, options);
        throw CalibrationError(fmt::format(
            "the arm never rests for {} s: hold it against each stop for longer", options.dwell_s));
    }
    const auto [lowest, highest] =
        std::ranges::minmax(rests, {}, [](const Rest& rest) { return rest.level; });
    const double span = highest.level - lowest.level;
    if (span < options.span_min_q4_count) {
        throw CalibrationError(fmt::format(
            "the rests span {:.0f} Q4 counts, at least {:.0f} needed: swing to both stops", span,
            options.span_min_q4_count));
    }
    check_overshoot(present, lowest.level, highest.level, options);
    Stop low = gather_stop(present, rests, lowest.level, span, options);
    Stop high = gather_stop(present, rests, highest.level, span, options);
    if (std::min(low.visit_means.size(), high.visit_means.size()) <
        static_cast<std::size_t>(options.visits_min)) {
        blame_noise(present, options);
    }
    check_stop(low, "low", options);
    check_stop(high, "high", options);
    estimate_level(low);
    estimate_level(high);
    return {low.level, high.level,
            std::max(trimmed_mean(low.visit_noise), trimmed_mean(high.visit_noise))};
}

}  // namespace host_sim
