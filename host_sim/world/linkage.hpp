// linkage.hpp - where the wheels of a planar rocker-bogie stand on a surface, and what a look-ahead
// sample sees from there.
// Model    wheels are points below their axles. With rocker angle rho and bogie angle beta against
//          the horizon, R = rocker, b = bogie arm:
//            middle  x + R cos rho - b cos beta,  z(1) = R sin rho - b sin beta above the rear
//            wheel front   x + R cos rho + b cos beta,  z(2) = R sin rho + b sin beta
// Bounds   at most kLinkageIterations steps, then kRootSteps^2; never fails to return a pose.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace host_sim {

inline constexpr int kLinkageIterations = 60;
inline constexpr int kRootSteps = 100;
inline constexpr double kLinkageToleranceCm = 1e-7;
inline constexpr double kRangeReachCm = 100;    ///< look-ahead heights beyond +-1 m are not seen
inline constexpr double kSteepestSine = 0.985;  ///< bracketing looks between -80 and +80 degrees

struct LinkageGeometry {
    double rocker_cm = 37.5;
    double bogie_arm_cm = 12.5;
};

enum class LinkageMethod : std::uint8_t {
    iteration,   ///< ordinary ground: residual below kLinkageToleranceCm
    bracketing,  ///< rough ground: solved by nested root bracketing, residual below 1e-6 cm
    nearest  ///< no pose puts all wheels on the ground: the pose with the smallest residual seen
};

struct LinkagePose {
    double rocker_rad = 0;   ///< rho, against the horizon, front up positive
    double bogie_rad = 0;    ///< beta, against the horizon, front up positive
    double x_middle_cm = 0;  ///< world x of the middle and front contacts
    double x_front_cm = 0;
    double z_middle_cm = 0;  ///< z(1): middle contact above the rear contact
    double z_front_cm = 0;   ///< z(2)
    double residual_cm = 0;  ///< largest distance of a wheel from the surface, vertical
    LinkageMethod method = LinkageMethod::iteration;
};

namespace linkage_detail {

// A root of a continuous f with f(low) >= 0 >= f(high): false position with the Illinois
// correction, every third step a bisection, so that steep and flat parts do no harm. Where f has no
// root but jumps, the place of the jump.
template <typename Function>
double find_root(const Function& f, double low, double high) {
    double f_low = f(low);
    double f_high = f(high);
    double x = 0.5 * (low + high);
    int kept = 0;  // ends kept in succession: below 0 the lower one
    for (int i = 0; i < kRootSteps && high - low > 1e-15; ++i) {
        const bool bisect = i % 3 == 2 || !(f_low > f_high);
        x = bisect ? 0.5 * (low + high) : low + (high - low) * f_low / (f_low - f_high);
        const double f_x = f(x);
        if (std::abs(f_x) < 1e-13) break;
        if (f_x > 0) {
            low = x;
            f_low = f_x;
            if (kept > 0) f_high *= 0.5;
            kept = 1;
        } else {
            high = x;
            f_high = f_x;
            if (kept < 0) f_low *= 0.5;
            kept = -1;
        }
    }
    return x;
}

// One side in the unknowns u = sin rho, v = sin beta.
template <typename Surface>
struct Side {
    const LinkageGeometry& geometry;
    const Surface& surface;
    double x_cm;
    double rear_cm = surface(x_cm);

    struct Fit {
        double u_wanted, v_wanted;  // sines that the heights under the wheels call for
        double residual_cm;
    };

    [[nodiscard]] double pivot_x_cm(double u) const {
        return x_cm + geometry.rocker_cm * std::sqrt(1.0 - u * u);
    }
    [[nodiscard]] Fit fit(double u, double v) const {
        const double pivot_cm = pivot_x_cm(u);
        const double reach_cm = geometry.bogie_arm_cm * std::sqrt(1.0 - v * v);
        const double middle_cm = surface(pivot_cm - reach_cm) - rear_cm;
        const double front_cm = surface(pivot_cm + reach_cm) - rear_cm;
        const double rocker_up_cm = geometry.rocker_cm * u;
        const double bogie_up_cm = geometry.bogie_arm_cm * v;
        return {0.5 * (middle_cm + front_cm) / geometry.rocker_cm,
                0.5 * (front_cm - middle_cm) / geometry.bogie_arm_cm,
                std::max(std::abs(middle_cm - (rocker_up_cm - bogie_up_cm)),
                         std::abs(front_cm - (rocker_up_cm + bogie_up_cm)))};
    }
    // The bogie's sine that puts both of its wheels equally far from the surface; one always
    // exists, because at the vertical the wheels stand over one point.
    [[nodiscard]] double bogie_sine(double u) const {
        return find_root([&](double v) { return fit(u, v).v_wanted - v; }, -1.0, 1.0);
    }
    [[nodiscard]] LinkagePose pose(double u, double v, LinkageMethod method) const {
        const double pivot_cm = pivot_x_cm(u);
        const double reach_cm = geometry.bogie_arm_cm * std::sqrt(1.0 - v * v);
        const double rocker_up_cm = geometry.rocker_cm * u;
        const double bogie_up_cm = geometry.bogie_arm_cm * v;
        return {std::asin(u),
                std::asin(v),
                pivot_cm - reach_cm,
                pivot_cm + reach_cm,
                rocker_up_cm - bogie_up_cm,
                rocker_up_cm + bogie_up_cm,
                fit(u, v).residual_cm,
                method};
    }
};

}  // namespace linkage_detail

/// Puts one side of the vehicle on a surface.
/// @param surface  height in cm as a function of x in cm, any callable; finite everywhere
/// @param x_cm     place of the rear contact
/// @param guess    pose to start from, the previous one of a drive; saves iterations only
/// @return  the pose; see LinkageMethod for what is promised about residual_cm
template <typename Surface>
LinkagePose solve_linkage(const LinkageGeometry& geometry, const Surface& surface, double x_cm,
                          const LinkagePose& guess = {}) {
    const linkage_detail::Side<Surface> side{geometry, surface, x_cm};
    double u = std::clamp(std::sin(guess.rocker_rad), -kSteepestSine, kSteepestSine);
    double v = std::clamp(std::sin(guess.bogie_rad), -kSteepestSine, kSteepestSine);
    double best_u = u;
    double best_v = v;
    double best_cm = side.fit(u, v).residual_cm;
    const auto keep_best = [&](double residual_cm) {
        if (residual_cm < best_cm) {
            best_cm = residual_cm;
            best_u = u;
            best_v = v;
        }
    };
    // The error shrinks by (slope x tan angle) in each iteration; halving the correction helps
    // where that is between 1 and 3.
    for (int i = 0; i < kLinkageIterations; ++i) {
        const auto fit = side.fit(u, v);
        if (fit.residual_cm <= kLinkageToleranceCm) {
            return side.pose(u, v, LinkageMethod::iteration);
        }
        keep_best(fit.residual_cm);
        const double gain = i < kLinkageIterations / 2 ? 1.0 : 0.5;
        u = std::clamp(u + gain * (fit.u_wanted - u), -kSteepestSine, kSteepestSine);
        v = std::clamp(v + gain * (fit.v_wanted - v), -kSteepestSine, kSteepestSine);
    }
    const auto rocker_miss = [&](double sine) {
        return side.fit(sine, side.bogie_sine(sine)).u_wanted - sine;
    };
    u = linkage_detail::find_root(rocker_miss, -kSteepestSine, kSteepestSine);
    v = side.bogie_sine(u);
    keep_best(side.fit(u, v).residual_cm);
    return side.pose(best_u, best_v,
                     best_cm < 1e-6 ? LinkageMethod::bracketing : LinkageMethod::nearest);
}

/// What the body carries into the view of a look-ahead sample.
struct RangeView {
    double rear_x_cm = 0;       ///< rear contact
    double rear_height_cm = 0;  ///< height of the rear contact
    double rocker_rad = 0;      ///< rocker angle of the side on which the sample lies
    double pitch_rad = 0;       ///< body pitch, front up positive
    double body_reference_cm = 18.75;
    double wheel_radius_cm = 6.5;
};

struct RangeSight {
    double height_cm =
        0;  ///< H: ground height in the body frame, 0 for level ground under a level rover
    double x_cm = 0;    ///< world x of the point seen
    bool seen = false;  ///< false: no ground within kRangeReachCm; the numbers mean nothing
};

/// Solves for the height H at which the point X ahead of the body reference, H above the level of
/// the wheels, both in the body frame, lies on the ground:
///   x = rear + ref cos rho + X cos pitch - (H - r) sin pitch
///   y = rear height + r + ref sin rho + X sin pitch + (H - r) cos pitch
/// Starts at the height of the ground above X, so it finds the solution nearest to that.
/// @param ahead_cm  X, from the body reference
template <typename Ground>
RangeSight look_ahead(const RangeView& view, double ahead_cm, const Ground& ground) {
    const double pitch_sin = std::sin(view.pitch_rad);
    const double pitch_cos = std::max(0.05, std::cos(view.pitch_rad));
    const double r = view.wheel_radius_cm;
    const double base_x = view.rear_x_cm + view.body_reference_cm * std::cos(view.rocker_rad) +
                          ahead_cm * pitch_cos + r * pitch_sin;
    const double base_y = view.rear_height_cm + r +
                          view.body_reference_cm * std::sin(view.rocker_rad) +
                          ahead_cm * pitch_sin - r * pitch_cos;
    RangeSight sight;
    for (int i = 0; i < kLinkageIterations; ++i) {
        sight.x_cm = base_x - sight.height_cm * pitch_sin;
        const double miss_cm = ground(sight.x_cm) - (base_y + sight.height_cm * pitch_cos);
        if (std::abs(miss_cm) <= kLinkageToleranceCm) {
            sight.seen = std::abs(sight.height_cm) <= kRangeReachCm;
            return sight;
        }
        const double gain = i < kLinkageIterations / 2 ? 1.0 : 0.5;
        sight.height_cm += gain * miss_cm / pitch_cos;
    }
    // Rough ground: the line of points is straight, so it is cut between two brackets.
    const auto miss = [&](double height_cm) {
        return ground(base_x - height_cm * pitch_sin) - (base_y + height_cm * pitch_cos);
    };
    if (!(miss(-kRangeReachCm) > 0) || !(miss(kRangeReachCm) < 0)) return sight;
    sight.height_cm = linkage_detail::find_root(miss, -kRangeReachCm, kRangeReachCm);
    sight.x_cm = base_x - sight.height_cm * pitch_sin;
    sight.seen = std::abs(miss(sight.height_cm)) < 1e-6;
    return sight;
}

}  // namespace host_sim
