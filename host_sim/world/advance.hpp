// advance.hpp - how far the vehicle really moves for each cycle of wheel odometry.
// Source   Wilcox 1994, "Simulation Trials" and the closing experiments.
// Cycle    kCycleCm of odometer; one draw a cycle, spread evenly over it.
#pragma once

#include "host_sim/world/random.hpp"

namespace host_sim {

inline constexpr double kCycleCm = 6.0;

enum class AdvanceKind {
    constant,      ///< mean
    gaussian,      ///< N(mean, sigma); may be negative
    uniform,       ///< mean +- half_width
    slope_sinkage  ///< mean (1 - max(0, slope)/0.6 - s/5 cm), uniform +- half_width, clipped at 0
};

struct AdvanceModel {
    AdvanceKind kind = AdvanceKind::gaussian;
    double mean_cm = 5.0;
    double sigma_cm = 1.0;
    double half_width_cm = 2.0;
};

inline constexpr double kStoppingSlope = 0.6;      ///< a 60 % grade stops the vehicle
inline constexpr double kStoppingSinkageCm = 5.0;  ///< so does sinkage of 5 cm

/// Advance of the next cycle, cm. Takes one number from `random` whatever the kind, so that runs
/// that differ in the kind alone stay comparable.
/// @param slope       z(2)/50 cm: rise over run in the direction of travel
/// @param sinkage_cm  at the front wheel, >= 0
double draw_advance_cm(const AdvanceModel& model, double slope, double sinkage_cm, Random& random);

}  // namespace host_sim
