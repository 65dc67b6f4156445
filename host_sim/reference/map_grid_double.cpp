// map_grid_double.cpp - see map_grid_double.hpp; equations in docs/design/slip-and-sinkage.md.
#include "host_sim/reference/map_grid_double.hpp"

#include <algorithm>
#include <cmath>

namespace host_sim {
namespace {

constexpr int kHalfBins = 8;  // candidates reach 10 cm ahead
constexpr double kMatchReachCm = 10;
constexpr double kGapMaxCm = 25;  // a longer step of the front wheel leaves a hole: new map
constexpr std::size_t kSamplesMax = 24;
constexpr double kDriftPerLossCm = 5;      // position uncertainty added when lock is lost
constexpr double kUninformedShare = 0.85;  // posterior this near the prior: the ground said nothing
constexpr double kDriftDivisor = 256;      // ... and the learned mean may be off by this share

}  // namespace

MapGridDouble::MapGridDouble(const MapGridTuning& tuning)
    : tuning_(tuning), prior_mean_cm_(tuning.prior_mean_cm) {}

double MapGridDouble::surface_at(double place_cm) {
    const double bins = place_cm / tuning_.bin_cm;
    const double floor_bin = std::floor(bins);
    const long node = static_cast<long>(floor_bin);
    return at(node) + (at(node + 1) - at(node)) * (bins - floor_bin);
}

void MapGridDouble::drop_map() {
    has_map_ = false;
    samples_.clear();
    sinkage_valid_ = false;
    sinkage_count_ = 0;
}

// Three contacts are known: straight lines between them until the front wheel's own track is there.
void MapGridDouble::begin_map(const MapGridInput& input) {
    lowest_ = static_cast<long>(std::floor(position_cm_ / tuning_.bin_cm));
    const double front = position_cm_ + input.d2_cm;
    for (long node = lowest_; static_cast<double>(node) * tuning_.bin_cm <= front + tuning_.bin_cm;
         ++node) {
        const double ahead =
            std::clamp(static_cast<double>(node) * tuning_.bin_cm - position_cm_, 0.0, input.d2_cm);
        at(node) = ahead <= input.d1_cm
                       ? input.z1_cm * ahead / input.d1_cm
                       : input.z1_cm + (input.z2_cm - input.z1_cm) * (ahead - input.d1_cm) /
                                           (input.d2_cm - input.d1_cm);
    }
    front_place_cm_ = front;
    front_height_cm_ = front_height_before_cm_ = input.z2_cm;
    measured_from_cm_ = front;
    has_map_ = true;
    look_ahead(input, 0.0);
}

bool MapGridDouble::can_match(const MapGridInput& input) const {
    if (!has_map_ || position_cm_ < measured_from_cm_) return false;
    if (input.odometer_cm < 0 || input.odometer_cm > kMatchReachCm) return false;
    const double first = static_cast<double>(lowest_) * tuning_.bin_cm;
    const double last_needed = position_cm_ + kMatchReachCm + 2 * tuning_.bin_cm + input.d1_cm;
    return position_cm_ >= first && last_needed <= front_place_cm_ + tuning_.bin_cm;
}

double MapGridDouble::residual(long node, const MapGridInput& input) {
    return input.z1_cm -
           (surface_at(static_cast<double>(node) * tuning_.bin_cm + input.d1_cm) - at(node));
}

/// 1.6 cm halved zero to seven times, whichever is nearest to 1.04 sigma on a logarithmic scale:
/// with the square root of 3/2 / (2 ln 2) = 1.04 squared misfits are right on average.
double MapGridDouble::nearest_octave(double sigma_cm) const {
    const double halvings =
        std::round(std::log2(tuning_.sigma_max_cm / std::max(1.04 * sigma_cm, 1e-9)));
    return tuning_.sigma_max_cm *
           std::exp2(-std::clamp(halvings, 0.0,
                                 std::log2(tuning_.sigma_max_cm / tuning_.sigma_floor_cm)));
}

double MapGridDouble::match(const MapGridInput& input) {
    const double widen =
        std::clamp(tuning_.sigma_per_cost * match_cost_, 1.0, tuning_.sigma_widen_max);
    const double sigma = nearest_octave(tuning_.sigma_per_rough * rough_cm_ * widen);
    const double half = tuning_.bin_cm / 2;
    const double mean = prior_mean_cm_ + input.odometer_cm - tuning_.prior_mean_cm;
    // Four half bins to both sides of the expected place, from a whole bin on; none before the bin
    // of the rear wheel.
    const double expected = position_cm_ + std::max(0.0, mean);
    const long first = 2 * static_cast<long>(std::floor(expected / tuning_.bin_cm - 1.5));
    const long here = 2 * static_cast<long>(std::floor(position_cm_ / tuning_.bin_cm));
    const int nearest = static_cast<int>(std::max(0L, here - first));
    std::array<double, kHalfBins + 1> cost{}, fit{};
    int best = nearest;
    for (int i = nearest; i <= kHalfBins; ++i) {
        const long place = first + i;
        const long node = place >> 1;
        const double e = (place & 1) != 0 ? (residual(node, input) + residual(node + 1, input)) / 2
                                          : residual(node, input);
        fit[static_cast<std::size_t>(i)] = e * e / (sigma * sigma);
        const double off = static_cast<double>(place) * half - position_cm_ - mean;
        cost[static_cast<std::size_t>(i)] =
            e * e / (sigma * sigma) + off * off / (tuning_.prior_sigma_cm * tuning_.prior_sigma_cm);
        if (cost[static_cast<std::size_t>(i)] < cost[static_cast<std::size_t>(best)]) best = i;
    }
    const auto b = static_cast<std::size_t>(best);
    double fine = best;
    const double prior_variance = tuning_.prior_sigma_cm * tuning_.prior_sigma_cm;
    double variance = prior_variance;
    if (best > nearest && best < kHalfBins) {
        const double bend = cost[b - 1] - 2 * cost[b] + cost[b + 1];
        if (bend > 0) {
            fine += 0.5 * (cost[b - 1] - cost[b + 1]) / bend;
            variance = std::min(variance, 2 * half * half / bend);
        }
    }
    variance_cm2_ += variance;
    if (variance > kUninformedShare * prior_variance) drift_cm_ += mean / kDriftDivisor;
    judge(cost[b]);
    if (fit[b] > tuning_.credible_fit && (best == nearest || best == kHalfBins))
        return std::max(0.0, mean);
    return std::max(0.0, (static_cast<double>(first) + fine) * half - position_cm_);
}

void MapGridDouble::judge(double cost) {
    match_cost_ += (std::min(cost, tuning_.cost_cap) - match_cost_) / 8;
    if (match_cost_ > tuning_.reacquire_cost) {
        if (mode_ != MapGridMode::reacquiring) {
            ++lost_lock_count_;
            drift_cm_ += kDriftPerLossCm;
        }
        mode_ = MapGridMode::reacquiring;
        prior_mean_cm_ = std::max(prior_mean_cm_, tuning_.reacquire_mean_cm);
        learned_ = 0;
        match_cost_ = tuning_.reacquire_cost / 2;
    } else if (mode_ != MapGridMode::reacquiring || match_cost_ < tuning_.tracking_cost) {
        mode_ = MapGridMode::tracking;
    }
}

void MapGridDouble::learn(double advance_cm) {
    const double gain = std::max(1.0 / 32, 1.0 / (learned_ + 8));
    if (learned_ < 24) ++learned_;
    prior_mean_cm_ = std::clamp(prior_mean_cm_ + (advance_cm - prior_mean_cm_) * gain, 1.0, 6.0);
}

void MapGridDouble::extend(const MapGridInput& input) {
    const double middle = position_cm_ + input.d1_cm;
    const double rear_height = (surface_at(position_cm_) + surface_at(middle) - input.z1_cm) / 2;
    const double front_height = rear_height + input.z2_cm;
    const double front = position_cm_ + input.d2_cm;
    const double gap = front - front_place_cm_;
    if (gap >= 0) {
        long node = static_cast<long>(std::floor(front_place_cm_ / tuning_.bin_cm)) + 1;
        for (; static_cast<double>(node) * tuning_.bin_cm <= front; ++node)
            at(node) = front_height_cm_ +
                       (front_height - front_height_cm_) *
                           (static_cast<double>(node) * tuning_.bin_cm - front_place_cm_) /
                           std::max(gap, 1e-9);
        at(node) = front_height;
        lowest_ = std::max(lowest_, node - kNodes + 1);
        const double bend = std::abs(front_height - 2 * front_height_cm_ + front_height_before_cm_);
        const double gain = std::max(1.0 / 32, 1.0 / (rough_count_ + 8));
        if (rough_count_ < 24) ++rough_count_;
        rough_cm_ += (bend - rough_cm_) * gain;
        front_height_before_cm_ = front_height_cm_;
        front_place_cm_ = front;
        front_height_cm_ = front_height;
    }
    const double miss = rear_height + input.z1_cm - surface_at(middle);
    const long node = static_cast<long>(std::floor(middle / tuning_.bin_cm));
    at(node) += miss / 2;
    at(node + 1) += miss / 2;
    look_ahead(input, rear_height);
}

void MapGridDouble::insert(double place_cm, double height_cm) {
    auto after = std::find_if(samples_.begin(), samples_.end(),
                              [&](const Sample& s) { return s.place_cm > place_cm; });
    for (auto near : {after, after == samples_.begin() ? after : after - 1}) {
        if (near == samples_.end() || std::abs(near->place_cm - place_cm) >= tuning_.look_merge_cm)
            continue;
        near->place_cm = (near->place_cm + place_cm) / 2;
        near->height_cm = (near->height_cm + height_cm) / 2;
        return;
    }
    if (samples_.size() < kSamplesMax) samples_.insert(after, {place_cm, height_cm});
}

void MapGridDouble::look_ahead(const MapGridInput& input, double rear_height_cm) {
    for (int i = 0; i < input.ahead_count; ++i) {
        const auto k = static_cast<std::size_t>(i);
        insert(position_cm_ + input.ahead_distance_cm[k],
               rear_height_cm + input.ahead_height_cm[k]);
    }
    while (samples_.size() > 1 && samples_[1].place_cm < front_place_cm_)
        samples_.erase(samples_.begin());
    sinkage_valid_ = samples_.size() > 1 && samples_[0].place_cm <= front_place_cm_ &&
                     position_cm_ + input.d2_cm >= front_place_cm_;
    if (!sinkage_valid_) return;
    const Sample &a = samples_[0], &b = samples_[1];
    const double share = (front_place_cm_ - a.place_cm) / std::max(b.place_cm - a.place_cm, 1e-9);
    const double raw = a.height_cm + (b.height_cm - a.height_cm) * share - front_height_cm_;
    const double gain = std::max(1.0 / 4, 1.0 / (sinkage_count_ + 1));
    sinkage_smooth_cm_ += (raw - sinkage_smooth_cm_) * gain;
    const double size_gain = std::max(1.0 / 32, 1.0 / (sinkage_count_ + 1));
    if (sinkage_count_ < 31) ++sinkage_count_;
    sinkage_size_cm_ += (std::abs(sinkage_smooth_cm_) - sinkage_size_cm_) * size_gain;
    // What remains of the noise after smoothing, and the share of the signal to be believed.
    const double noise =
        0.378 * std::hypot(0.82 * tuning_.look_sigma_cm, tuning_.look_per_rough * rough_cm_);
    const double ratio = sinkage_size_cm_ > 0 ? noise / sinkage_size_cm_ : 2;
    const double share_believed = std::max(0.0, 1 - 0.64 * ratio * ratio);
    sinkage_cm_ = std::max(0.0, sinkage_smooth_cm_) * share_believed;
    sinkage_alarm_ = sinkage_cm_ > tuning_.sinkage_alarm_cm;
}

double MapGridDouble::sigma_cm() const {
    return std::sqrt(variance_cm2_) + drift_cm_;
}

void MapGridDouble::step(const MapGridInput& input) {
    const std::uint32_t losses_before = lost_lock_count_;
    move(input);
    // The running cost restarts lower when lock is lost, so the loss itself counts.
    slip_alarm_ = lost_lock_count_ != losses_before || match_cost_ > tuning_.slip_alarm_cost ||
                  100 * (1 - prior_mean_cm_ / tuning_.prior_mean_cm) > tuning_.slip_alarm_percent;
}

void MapGridDouble::move(const MapGridInput& input) {
    switch (input.motion) {
        case CycleMotion::turn:
        case CycleMotion::moved:
            drop_map();
            advance_cm_ = 0;
            mode_ = input.motion == CycleMotion::turn ? MapGridMode::turning : MapGridMode::moved;
            drift_cm_ += input.motion == CycleMotion::turn ? 0.5 : 2.5;
            return;
        case CycleMotion::reverse:
            advance_cm_ = input.odometer_cm;
            position_cm_ += advance_cm_;
            drift_cm_ += std::abs(advance_cm_) / 4;
            mode_ = MapGridMode::reversing;
            return;
        case CycleMotion::forward:
            break;
    }
    if (input.linkage && can_match(input)) {
        if (mode_ != MapGridMode::tracking) mode_ = MapGridMode::reacquiring;
        advance_cm_ = match(input);
        learn(advance_cm_);
    } else {
        advance_cm_ = std::max(0.0, prior_mean_cm_ + input.odometer_cm - tuning_.prior_mean_cm);
        drift_cm_ += advance_cm_ / 4;
        mode_ = input.linkage ? MapGridMode::reacquiring : MapGridMode::odometry_only;
    }
    position_cm_ += advance_cm_;
    sinkage_valid_ = false;
    if (input.linkage) {
        if (has_map_ && position_cm_ + input.d2_cm - front_place_cm_ > kGapMaxCm) drop_map();
        if (!has_map_)
            begin_map(input);
        else if (position_cm_ >= static_cast<double>(lowest_) * tuning_.bin_cm)
            extend(input);
    }
}

}  // namespace host_sim
