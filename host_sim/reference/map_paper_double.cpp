#include "host_sim/reference/map_paper_double.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace host_sim {

namespace {

constexpr double kMiddleCm = 25, kFrontCm = 50, kNearAheadCm = 60, kFarAheadCm = 80;
constexpr double kWheelSigmaCm = 0.004;
constexpr double kLookAheadSigmaCm = 0.2;

int bin_of(double distance_cm, double bin_cm) {
    return static_cast<int>(std::floor(distance_cm / bin_cm + 1e-9));
}

double square(double value) {
    return value * value;
}

/// Moves `values` by `advance` bins, linear between bins. Entries past the old end are left out.
void resample(std::vector<double>& values, double advance, double lift,
              std::vector<double>& result) {
    const auto whole = static_cast<std::size_t>(advance);
    const double fraction = advance - static_cast<double>(whole);
    result.clear();
    for (std::size_t i = whole; i + 1 < values.size(); ++i) {
        result.push_back(values[i] + fraction * (values[i + 1] - values[i]) - lift);
    }
}

/// Continues `resampled` with a line from the old end to `measured` at the new end.
void extend(std::vector<double>& values, double advance, double lift, double measured,
            std::vector<double>& resampled) {
    const double old_end = values.back() - lift;
    const double old_place = static_cast<double>(values.size() - 1) - advance;
    while (resampled.size() + 1 < values.size()) {
        const double along = (static_cast<double>(resampled.size()) - old_place) / advance;
        resampled.push_back(old_end + along * (measured - old_end));
    }
    resampled.push_back(measured);
    values.swap(resampled);
}

}  // namespace

MapPaperDouble::MapPaperDouble(const MapPaperOptions& options) : options_(options) {
    if (!(options.bin_cm >= 0.01 && options.bin_cm <= 8)) {
        throw std::invalid_argument("map_paper: bin must lie in [0.01, 8] cm");
    }
    if (!(options.prior_mean_cm >= 0 && options.prior_mean_cm <= 100)) {
        throw std::invalid_argument("map_paper: prior mean must lie in [0, 100] cm");
    }
    if (!(options.prior_sigma_cm > 0) || !(options.vehicle_sigma_cm >= 0) ||
        !(options.vehicle_sigma_cm <= 100)) {
        throw std::invalid_argument("map_paper: sigmas must be positive");
    }
    middle_ = bin_of(kMiddleCm, options.bin_cm);
    front_ = bin_of(kFrontCm, options.bin_cm);
    near_ahead_ = bin_of(kNearAheadCm, options.bin_cm);
    far_ahead_ = bin_of(kFarAheadCm, options.bin_cm);
    limit_ = std::min(front_ - middle_, far_ahead_ - near_ahead_);
    const double reach_cm = options.prior_mean_cm + 4 * options.vehicle_sigma_cm;
    search_last_ = std::min(limit_, bin_of(reach_cm, options.bin_cm) + 4);
    ground_.resize(static_cast<std::size_t>(far_ahead_) + 1);
    sinkage_.resize(static_cast<std::size_t>(front_) + 1);
    costs_.resize(static_cast<std::size_t>(limit_) + 1);
}

void MapPaperDouble::reset(std::span<const double> ground_cm, std::span<const double> sinkage_cm) {
    if (ground_cm.size() != ground_.size() || sinkage_cm.size() != sinkage_.size()) {
        throw std::invalid_argument("map_paper: known ground has the wrong number of bins");
    }
    sinkage_.assign(sinkage_cm.begin(), sinkage_cm.end());
    const double rear_cm = ground_cm[0] - sinkage_cm[0];
    std::transform(ground_cm.begin(), ground_cm.end(), ground_.begin(),
                   [&](double height) { return height - rear_cm; });
    search_more_ = 0;
    least_cost_ = 0;
}

int MapPaperDouble::search_last() const {
    return std::min(limit_, search_last_ + search_more_);
}

double MapPaperDouble::cost(int bin, const MapPaperHeightsCm& heights) const {
    const double rear_cm = surface_cm(bin);
    const double middle_error = heights.middle - (surface_cm(middle_ + bin) - rear_cm);
    const double prior_error = bin * options_.bin_cm - options_.prior_mean_cm;
    double sum =
        square(middle_error / kWheelSigmaCm) + square(prior_error / options_.prior_sigma_cm);
    if (options_.look_ahead_term) {
        const double ahead_error = heights.near_ahead - (ground_at(near_ahead_ + bin) - rear_cm);
        sum += square(ahead_error / kLookAheadSigmaCm);
    }
    return sum;
}

double MapPaperDouble::find_advance_bins(const MapPaperHeightsCm& heights) {
    const int last = search_last();
    for (int bin = 0; bin <= last; ++bin)
        costs_[static_cast<std::size_t>(bin)] = cost(bin, heights);
    const int best = static_cast<int>(std::min_element(costs_.begin(), costs_.begin() + last + 1) -
                                      costs_.begin());
    const double middle = costs_[static_cast<std::size_t>(best)];
    least_cost_ = middle;
    extend_search(best, last);
    if (best == 0 || best == limit_) return best;
    const double left = costs_[static_cast<std::size_t>(best) - 1];
    const double right =
        best == last ? cost(best + 1, heights) : costs_[static_cast<std::size_t>(best) + 1];
    if (right < middle) return best;
    const double bend = left - 2 * middle + right;
    return bend > 0 ? best + 0.5 * (left - right) / bend : best;
}

void MapPaperDouble::extend_search(int best, int last) {
    const auto at = [this](int bin) { return costs_[static_cast<std::size_t>(bin)]; };
    int second = best;
    for (int bin = best + 1; bin <= last; ++bin) {
        const bool minimum = at(bin) < at(bin - 1) && (bin == last || at(bin) <= at(bin + 1));
        if (minimum && (second == best || at(bin) < at(second))) second = bin;
    }
    search_more_ = second != best && at(second) <= 3 * at(best) ? second - best : 0;
}

void MapPaperDouble::translate(double advance_bins, const MapPaperHeightsCm& heights) {
    const auto whole = static_cast<int>(advance_bins);
    const double fraction = advance_bins - whole;
    const double lift = surface_cm(whole) + fraction * (surface_cm(whole + 1) - surface_cm(whole));
    resample(ground_, advance_bins, lift, resampled_);
    extend(ground_, advance_bins, lift, heights.far_ahead, resampled_);
    resample(sinkage_, advance_bins, 0, resampled_);
    extend(sinkage_, advance_bins, 0, ground_at(front_) - heights.front, resampled_);
}

void MapPaperDouble::split_the_difference(const MapPaperHeightsCm& heights) {
    const auto force = [](std::vector<double>& values, int bin, double value) {
        const auto at = static_cast<std::size_t>(bin);
        values[at] = value;
        values[at - 1] = 0.5 * (values[at - 1] + value);
        values[at + 1] = 0.5 * (values[at + 1] + value);
    };
    force(ground_, near_ahead_, heights.near_ahead);
    force(sinkage_, middle_, ground_at(middle_) - heights.middle);
}

double MapPaperDouble::step(const MapPaperHeightsCm& heights) {
    const double advance_bins = find_advance_bins(heights);
    translate(advance_bins, heights);
    split_the_difference(heights);
    return advance_bins * options_.bin_cm;
}

}  // namespace host_sim
