// run_metrics.hpp - how good one run was, and how good many were.
// Depends on   the standard library only.
// Lock         The map is registered to the ground when the distance between two places is right
//              over the vehicle's length: the error made since the ground under the rear wheel was
//              under the front wheel. A run has lost lock when that error exceeds one bin in 20
//              cycles in a row. (The position error itself grows slowly even with perfect lock.)
// Tests        tests/host_sim/campaign/run_metrics_test.cpp
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace host_sim {

struct CycleOutcome {
    double true_cm = 0;
    double estimate_cm = 0;
    double true_sinkage_cm = 0;
    double sinkage_cm = 0;
};

struct RunResult {
    double odometry_error_pct = 0;  ///< 100 (estimate - true) / true at the end
    double sinkage_square_cm2 = 0;  ///< mean squared error of the sinkage under the front wheel
    double zero_square_cm2 = 0;     ///< the same if the answer were always 0
    bool lost_lock = false;
    /// Final position error within the reported one sigma; nothing if none was reported.
    std::optional<bool> covered = std::nullopt;
    std::size_t cycles = 0;

    bool operator==(const RunResult&) const = default;
};

class RunMetrics {
public:
    static constexpr int kLostCycles = 20;

    explicit RunMetrics(double bin_cm) : bin_cm_(bin_cm) {}
    void add(const CycleOutcome& outcome);
    /// @param position_sigma_cm  as reported by the estimator at the end
    [[nodiscard]] RunResult result(std::optional<double> position_sigma_cm) const;

private:
    struct Place {
        double true_cm, error_cm;
    };
    double bin_cm_;
    std::vector<Place> places_{{0, 0}};
    std::size_t mapped_ = 0;  // last place whose front wheel stood behind today's rear wheel
    int cycles_off_ = 0;
    bool lost_lock_ = false;
    double sinkage_squares_ = 0, zero_squares_ = 0;
};

/// Many runs of one kind.
struct Summary {
    std::size_t runs = 0;
    double mean_pct = 0, mean_abs_pct = 0;
    double sd_pct = 0;  ///< sample standard deviation; 0 for a single run
    double worst_abs_pct = 0;
    double sinkage_rms_cm = 0;       ///< over all runs: root of the mean of the runs' mean squares
    double sinkage_zero_rms_cm = 0;  ///< the same for the answer 0
    std::size_t lost_lock_runs = 0;
    std::optional<double> sigma_coverage;  ///< share of runs within their one sigma
};
/// In the order given, so that the result does not depend on who computed what when.
Summary summarize(std::span<const RunResult> runs);

}  // namespace host_sim
