#include "host_sim/campaign/run_metrics.hpp"

#include <algorithm>
#include <cmath>

namespace host_sim {

namespace {

constexpr double kVehicleCm = 50;

double square(double value) {
    return value * value;
}

}  // namespace

void RunMetrics::add(const CycleOutcome& outcome) {
    places_.push_back({outcome.true_cm, outcome.estimate_cm - outcome.true_cm});
    while (mapped_ + 1 < places_.size() &&
           places_[mapped_ + 1].true_cm + kVehicleCm <= outcome.true_cm) {
        ++mapped_;
    }
    const double off_cm = places_.back().error_cm - places_[mapped_].error_cm;
    cycles_off_ = std::abs(off_cm) > bin_cm_ ? cycles_off_ + 1 : 0;
    lost_lock_ = lost_lock_ || cycles_off_ >= kLostCycles;
    sinkage_squares_ += square(outcome.sinkage_cm - outcome.true_sinkage_cm);
    zero_squares_ += square(outcome.true_sinkage_cm);
}

RunResult RunMetrics::result(std::optional<double> position_sigma_cm) const {
    RunResult result;
    result.cycles = places_.size() - 1;
    if (result.cycles == 0) return result;
    const auto count = static_cast<double>(result.cycles);
    const Place& end = places_.back();
    if (end.true_cm != 0) result.odometry_error_pct = 100 * end.error_cm / end.true_cm;
    result.sinkage_square_cm2 = sinkage_squares_ / count;
    result.zero_square_cm2 = zero_squares_ / count;
    result.lost_lock = lost_lock_;
    if (position_sigma_cm) result.covered = std::abs(end.error_cm) <= *position_sigma_cm;
    return result;
}

Summary summarize(std::span<const RunResult> runs) {
    Summary summary;
    summary.runs = runs.size();
    if (runs.empty()) return summary;
    const auto count = static_cast<double>(runs.size());
    double with_sigma = 0;
    double covered = 0;
    for (const RunResult& run : runs) {
        summary.mean_pct += run.odometry_error_pct / count;
        summary.mean_abs_pct += std::abs(run.odometry_error_pct) / count;
        summary.worst_abs_pct = std::max(summary.worst_abs_pct, std::abs(run.odometry_error_pct));
        summary.sinkage_rms_cm += run.sinkage_square_cm2 / count;
        summary.sinkage_zero_rms_cm += run.zero_square_cm2 / count;
        if (run.lost_lock) ++summary.lost_lock_runs;
        if (!run.covered) continue;
        with_sigma += 1;
        if (*run.covered) covered += 1;
    }
    double squares = 0;
    for (const RunResult& run : runs) squares += square(run.odometry_error_pct - summary.mean_pct);
    if (runs.size() > 1) summary.sd_pct = std::sqrt(squares / (count - 1));
    summary.sinkage_rms_cm = std::sqrt(summary.sinkage_rms_cm);
    summary.sinkage_zero_rms_cm = std::sqrt(summary.sinkage_zero_rms_cm);
    if (with_sigma > 0) summary.sigma_coverage = covered / with_sigma;
    return summary;
}

}  // namespace host_sim
