// planar_course.hpp - one traverse of the paper's planar model, with any estimator on board.
// Source       Wilcox 1994, "Simulation Trials" and the runs described after Table 1.
// Model        sensors at fixed horizontal distances; heights of the wheels on y - s and of the
//              look-ahead samples on y, relative to the rear contact, each with noise.
// Random       sub-streams "advance" and "noise" of the seed: the same draws for every roughness,
//              bin size and estimator, so that two runs differ only in what is compared.
// Depends on   slip_estimator.hpp, run_metrics.hpp, host_sim/world/advance.hpp.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "host_sim/campaign/run_metrics.hpp"
#include "host_sim/campaign/slip_estimator.hpp"
#include "host_sim/world/advance.hpp"

namespace host_sim {

enum class Scenario {
    gaussian,       ///< advance N(mean, 1 cm): the paper's Table 1
    uniform,        ///< advance uniform, mean +- 2 cm
    slope_sinkage,  ///< the mean falls with slope and sinkage, then uniform +- 2 cm, clipped at 0
    sigma2,         ///< advance N(mean, 2 cm)
    noise1mm,       ///< wheel noise 1 mm instead of 0.04 mm
    noise_corr      ///< noise of z(1) and z(2) correlated, +0.9 for even seeds, -0.9 for odd ones
};
inline constexpr Scenario kScenarios[] = {Scenario::gaussian,      Scenario::uniform,
                                          Scenario::slope_sinkage, Scenario::sigma2,
                                          Scenario::noise1mm,      Scenario::noise_corr};
std::string_view name_of(Scenario scenario);

inline constexpr double kWheelNoiseCm = 0.004;
inline constexpr double kLookAheadNoiseCm = 0.2;

/// From `at_cm` of the rear wheel on, the advance is N(mean, sigma), never negative.
struct SlipOnset {
    double at_cm, mean_cm, sigma_cm;
};

struct CourseOptions {
    Scenario scenario = Scenario::gaussian;
    double true_mean_cm = 5.0;           ///< mean advance of a cycle, > 0
    double length_cm = kCourseLengthCm;  ///< the run ends with the first cycle that gets there
    double lock_bin_cm = 2.5;            ///< see RunMetrics
    std::optional<SlipOnset> onset = std::nullopt;
};

/// What the vehicle and its sensors do, cycle by cycle; knows nothing of estimators.
class PlanarCourse {
public:
    PlanarCourse(const PlanarGround& ground, const CourseOptions& options, std::uint64_t seed);

    /// Moves on by one cycle and measures.
    CycleInputs next();

    [[nodiscard]] double position_cm() const { return position_cm_; }  ///< true, rear contact
    [[nodiscard]] double sinkage_cm() const;                           ///< true, front wheel
    /// True at the end of the course, and when the cycles allowed have run out: a mean advance far
    /// below the nominal one must not make the run endless.
    [[nodiscard]] bool finished() const;

private:
    double draw_advance();

    const PlanarGround& ground_;
    CourseOptions options_;
    AdvanceModel advance_;
    double wheel_noise_cm_ = kWheelNoiseCm;
    double noise_correlation_ = 0;
    Random advance_random_, noise_random_;
    double position_cm_ = 0;
    std::uint64_t cycles_ = 0, cycles_max_;
};

/// Drives the whole course with `estimator`, which is reset first.
RunResult run_course(const PlanarGround& ground, const CourseOptions& options, std::uint64_t seed,
                     SlipEstimator& estimator);

}  // namespace host_sim
