#include "host_sim/campaign/planar_course.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace host_sim {

namespace {

constexpr double kCorrelation = 0.9;
constexpr double kCyclesAllowed = 100;  // times the cycles that the nominal mean would need

AdvanceModel advance_model(const CourseOptions& options) {
    AdvanceModel model;
    model.mean_cm = options.true_mean_cm;
    if (options.scenario == Scenario::sigma2) model.sigma_cm = 2.0;
    if (options.scenario == Scenario::uniform) model.kind = AdvanceKind::uniform;
    if (options.scenario == Scenario::slope_sinkage) model.kind = AdvanceKind::slope_sinkage;
    return model;
}

}  // namespace

std::string_view name_of(Scenario scenario) {
    switch (scenario) {
        case Scenario::gaussian:
            return "gaussian";
        case Scenario::uniform:
            return "uniform";
        case Scenario::slope_sinkage:
            return "slope_sinkage";
        case Scenario::sigma2:
            return "sigma2";
        case Scenario::noise1mm:
            return "noise1mm";
        case Scenario::noise_corr:
            return "noise_corr";
    }
    return "unknown";
}

PlanarCourse::PlanarCourse(const PlanarGround& ground, const CourseOptions& options,
                           std::uint64_t seed)
    : ground_(ground),
      options_(options),
      advance_(advance_model(options)),
      advance_random_(stream(seed, "advance")),
      noise_random_(stream(seed, "noise")) {
    if (!(options.true_mean_cm > 0) || !(options.length_cm > 0)) {
        throw std::invalid_argument("course: mean advance and length must be above 0");
    }
    if (options.scenario == Scenario::noise1mm) wheel_noise_cm_ = 0.1;
    if (options.scenario == Scenario::noise_corr) {
        noise_correlation_ = seed % 2 == 0 ? kCorrelation : -kCorrelation;
    }
    cycles_max_ = static_cast<std::uint64_t>(
        std::ceil(kCyclesAllowed * options.length_cm / options.true_mean_cm));
}

double PlanarCourse::sinkage_cm() const {
    return ground_.sinkage_cm(position_cm_ + kFrontWheelCm);
}

bool PlanarCourse::finished() const {
    return position_cm_ >= options_.length_cm || cycles_ >= cycles_max_;
}

// The paper clips the mean so that the vehicle never stops for good ("5 at best and 1 at worst").
double PlanarCourse::draw_advance() {
    const double front_cm = position_cm_ + kFrontWheelCm;
    const double rise_cm = ground_.surface_cm(front_cm) - ground_.surface_cm(position_cm_);
    double slope = rise_cm / kFrontWheelCm;
    double sunk_cm = ground_.sinkage_cm(front_cm);
    const double lost_share = std::max(0.0, slope) / kStoppingSlope + sunk_cm / kStoppingSinkageCm;
    if (lost_share > 1) {
        slope = std::max(0.0, slope) / lost_share;
        sunk_cm /= lost_share;
    }
    if (options_.onset && position_cm_ >= options_.onset->at_cm) {
        const AdvanceModel after{.kind = AdvanceKind::gaussian,
                                 .mean_cm = options_.onset->mean_cm,
                                 .sigma_cm = options_.onset->sigma_cm};
        return std::max(0.0, draw_advance_cm(after, slope, sunk_cm, advance_random_));
    }
    return draw_advance_cm(advance_, slope, sunk_cm, advance_random_);
}

CycleInputs PlanarCourse::next() {
    position_cm_ += draw_advance();
    ++cycles_;
    const double middle_noise = noise_random_.normal();
    const double front_noise =
        noise_correlation_ * middle_noise +
        std::sqrt(1 - noise_correlation_ * noise_correlation_) * noise_random_.normal();
    const double rear_cm = ground_.surface_cm(position_cm_);
    CycleInputs inputs;
    inputs.odometer_cm = kCycleCm;
    inputs.middle_cm = ground_.surface_cm(position_cm_ + kMiddleWheelCm) - rear_cm +
                       wheel_noise_cm_ * middle_noise;
    inputs.front_cm =
        ground_.surface_cm(position_cm_ + kFrontWheelCm) - rear_cm + wheel_noise_cm_ * front_noise;
    inputs.near_cm = ground_.ground_cm(position_cm_ + kNearSampleCm) - rear_cm +
                     kLookAheadNoiseCm * noise_random_.normal();
    inputs.far_cm = ground_.ground_cm(position_cm_ + kFarSampleCm) - rear_cm +
                    kLookAheadNoiseCm * noise_random_.normal();
    return inputs;
}

RunResult run_course(const PlanarGround& ground, const CourseOptions& options, std::uint64_t seed,
                     SlipEstimator& estimator) {
    PlanarCourse course(ground, options, seed);
    RunMetrics metrics(options.lock_bin_cm);
    estimator.reset(ground);
    double estimate_cm = 0;
    while (!course.finished()) {
        estimate_cm += estimator.step(course.next());
        metrics.add({.true_cm = course.position_cm(),
                     .estimate_cm = estimate_cm,
                     .true_sinkage_cm = course.sinkage_cm(),
                     .sinkage_cm = estimator.sinkage_cm()});
    }
    return metrics.result(estimator.position_sigma_cm());
}

}  // namespace host_sim
