// slip_estimator.hpp - what a sweep needs of an estimator, whichever it is and however it computes.
// Purpose      the campaign knows no firmware; host_sim/bind adapts each estimator to this
// interface
//              and supplies the factory.
// Depends on   host_sim/campaign/planar_ground.hpp.
// Units        cm; heights are relative to the rear wheel's contact.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string_view>

#include "host_sim/campaign/planar_ground.hpp"

namespace host_sim {

enum class EstimatorKind { map_paper, map_grid };
enum class Arithmetic { fixed, floating };  ///< printed as "fixed" and "double"

constexpr std::string_view name_of(EstimatorKind kind) {
    return kind == EstimatorKind::map_paper ? "map_paper" : "map_grid";
}
constexpr std::string_view name_of(Arithmetic arithmetic) {
    return arithmetic == Arithmetic::fixed ? "fixed" : "double";
}

/// Where the sensors of the paper's vehicle touch or see the ground, ahead of the rear contact.
inline constexpr double kMiddleWheelCm = 25;
inline constexpr double kFrontWheelCm = 50;
inline constexpr double kNearSampleCm = 60;
inline constexpr double kFarSampleCm = 80;

/// One cycle's measurements.
struct CycleInputs {
    double odometer_cm = 6;  ///< rim travel since the last cycle
    double middle_cm = 0;    ///< z(1)
    double front_cm = 0;     ///< z(2)
    double near_cm = 0;      ///< z(3), look-ahead sample at 60 cm
    double far_cm = 0;       ///< z(4), look-ahead sample at 80 cm
};

/// What the slip alarm compares with its two thresholds, and what came of it.
struct SlipLevels {
    double match_cost = 0;    ///< running cost of matching, squared sigmas
    double slip_percent = 0;  ///< of the learned mean advance against the odometer
    bool lost_lock = false;   ///< in this cycle; the running cost has restarted
    bool slip_alarm = false;
    bool sinkage_alarm = false;
};

class SlipEstimator {
public:
    virtual ~SlipEstimator() = default;
    /// Starts with the rear wheel at x = 0. The first metre is known ground: the vehicle comes down
    /// a ramp of known shape, so the estimator may read `ground` between 0 and kFarSampleCm.
    virtual void reset(const PlanarGround& ground) = 0;
    /// One cycle. @return estimated advance, cm
    virtual double step(const CycleInputs& inputs) = 0;
    /// Estimated sinkage under the front wheel, cm.
    [[nodiscard]] virtual double sinkage_cm() const = 0;
    /// One-sigma uncertainty of the position since reset, cm; nothing if not estimated.
    [[nodiscard]] virtual std::optional<double> position_sigma_cm() const { return std::nullopt; }
    /// Levels of the slip alarm after the last cycle; nothing if the estimator has no such alarm.
    [[nodiscard]] virtual std::optional<SlipLevels> slip_levels() const { return std::nullopt; }
};

struct SlipEstimatorOptions {
    EstimatorKind kind = EstimatorKind::map_paper;
    Arithmetic arithmetic = Arithmetic::fixed;
    double bin_cm = 2.5;
    double prior_mean_cm = 6.0;
    double prior_sigma_cm = 0.05;
};

/// Makes an estimator; called from several threads at once.
/// @errors  std::invalid_argument: no such estimator with these options; the text says why
using SlipEstimatorFactory =
    std::function<std::unique_ptr<SlipEstimator>(const SlipEstimatorOptions&)>;

}  // namespace host_sim
