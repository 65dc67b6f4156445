// slip_estimators.hpp - every slip estimator behind the campaign's one interface.
// Purpose      the place where an estimator is entered, keyed by name and arithmetic.
// Depends on   host_sim/campaign/slip_estimator.hpp; firmware/estimation in the sources.
// Units        cm outside; heights enter integer estimators rounded to 1/16 mm, clamped to s16.
// Tests        tests/host_sim/campaign
#pragma once

#include <cmath>
#include <cstdint>
#include <memory>

#include "host_sim/campaign/slip_estimator.hpp"

namespace host_sim {

/// A new estimator.
/// @errors  std::invalid_argument: no such estimator with these options; the text says why
std::unique_ptr<SlipEstimator> make_slip_estimator(const SlipEstimatorOptions& options);

/// map_paper in integers; bins are the multiples of 0.25 cm from 0.25 to 8.
/// @errors  std::invalid_argument: another bin
std::unique_ptr<SlipEstimator> make_map_paper_fixed(const SlipEstimatorOptions& options);
/// map_paper in double precision; any bin from 0.01 to 8 cm.
std::unique_ptr<SlipEstimator> make_map_paper_double(const SlipEstimatorOptions& options);

/// map_grid in integers, as it flies; `prior_mean_cm` is what it has learned at the start.
/// @errors  std::invalid_argument: bin or prior sigma other than its own, prior mean not [1, 6] cm
std::unique_ptr<SlipEstimator> make_map_grid_fixed(const SlipEstimatorOptions& options);
/// map_grid in double precision. The same errors.
std::unique_ptr<SlipEstimator> make_map_grid_double(const SlipEstimatorOptions& options);

/// s16 Q4 mm nearest to a height in cm; what no number can express is clamped, NaN is 0.
inline std::int16_t height_q4_mm(double height_cm) {
    const double steps = std::round(height_cm * 160.0);
    if (std::isnan(steps)) return 0;
    return static_cast<std::int16_t>(std::fmin(32767.0, std::fmax(-32768.0, steps)));
}

}  // namespace host_sim
