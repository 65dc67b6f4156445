// planar_course_test.cpp - the course does what the paper says, seen from outside.
#include "host_sim/campaign/planar_course.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "host_sim/campaign/slip_estimator.hpp"

namespace {

using namespace host_sim;

PlanarGround level_ground() {
    return {Terrain(0, 2.5, std::vector<double>(2600, 0.0)), SinkageField()};
}

struct Moments {
    double mean = 0, sd = 0, least = 0, most = 0;
};
Moments moments(const std::vector<double>& values) {
    Moments result{.least = values.at(0), .most = values.at(0)};
    for (const double value : values) {
        result.mean += value / static_cast<double>(values.size());
        result.least = std::min(result.least, value);
        result.most = std::max(result.most, value);
    }
    for (const double value : values) {
        result.sd += (value - result.mean) * (value - result.mean);
    }
    result.sd = std::sqrt(result.sd / static_cast<double>(values.size()));
    return result;
}

struct Drive {
    std::vector<double> advance_cm, middle_cm, front_cm, near_cm, far_cm;
};
Drive drive(const PlanarGround& ground, const CourseOptions& options, std::uint64_t first_seed) {
    Drive result;
    for (std::uint64_t seed = first_seed; seed < first_seed + 20; seed += 2) {
        PlanarCourse course(ground, options, seed);
        while (!course.finished()) {
            const double before_cm = course.position_cm();
            const CycleInputs inputs = course.next();
            result.advance_cm.push_back(course.position_cm() - before_cm);
            result.middle_cm.push_back(inputs.middle_cm);
            result.front_cm.push_back(inputs.front_cm);
            result.near_cm.push_back(inputs.near_cm);
            result.far_cm.push_back(inputs.far_cm);
        }
    }
    return result;
}

// 12,500 cycles: a standard error of the mean of 0.009 sigma. Bounds are five of them and more.
TEST(PlanarCourse, OnLevelGroundAdvanceAndNoiseAreAsThePaperStates) {
    const PlanarGround ground = level_ground();
    const Drive seen = drive(ground, {}, 1);
    EXPECT_NEAR(moments(seen.advance_cm).mean, 5.0, 0.06);
    EXPECT_NEAR(moments(seen.advance_cm).sd, 1.0, 0.04);
    for (const auto* wheel : {&seen.middle_cm, &seen.front_cm}) {
        EXPECT_NEAR(moments(*wheel).mean, 0, 0.004 * 0.05);
        EXPECT_NEAR(moments(*wheel).sd, 0.004, 0.004 * 0.04);
    }
    for (const auto* sample : {&seen.near_cm, &seen.far_cm}) {
        EXPECT_NEAR(moments(*sample).mean, 0, 0.2 * 0.05);
        EXPECT_NEAR(moments(*sample).sd, 0.2, 0.2 * 0.04);
    }
}

TEST(PlanarCourse, ScenariosChangeWhatTheirNamesSay) {
    const PlanarGround ground = level_ground();
    const Moments wide = moments(drive(ground, {.scenario = Scenario::sigma2}, 1).advance_cm);
    EXPECT_NEAR(wide.sd, 2.0, 0.08);
    const Moments even = moments(drive(ground, {.scenario = Scenario::uniform}, 1).advance_cm);
    EXPECT_GE(even.least, 3.0);
    EXPECT_LE(even.most, 7.0);
    EXPECT_NEAR(even.sd, 4 / std::sqrt(12.0), 0.04);
    const Moments loud = moments(drive(ground, {.scenario = Scenario::noise1mm}, 1).front_cm);
    EXPECT_NEAR(loud.sd, 0.1, 0.004);
    const Moments slow = moments(drive(ground, {.true_mean_cm = 3}, 1).advance_cm);
    EXPECT_NEAR(slow.mean, 3.0, 0.06);
}

double correlation(const Drive& seen) {
    double product = 0;
    for (std::size_t i = 0; i < seen.middle_cm.size(); ++i) {
        product += seen.middle_cm[i] * seen.front_cm[i];
    }
    return product / static_cast<double>(seen.middle_cm.size()) / (0.004 * 0.004);
}

TEST(PlanarCourse, CorrelatedNoiseIsPositiveForEvenSeedsAndNegativeForOddOnes) {
    const PlanarGround ground = level_ground();
    EXPECT_NEAR(correlation(drive(ground, {.scenario = Scenario::noise_corr}, 2)), 0.9, 0.07);
    EXPECT_NEAR(correlation(drive(ground, {.scenario = Scenario::noise_corr}, 1)), -0.9, 0.07);
    EXPECT_NEAR(correlation(drive(ground, {}, 1)), 0.0, 0.07);
}

TEST(PlanarCourse, HeightsAreOfTheSinkingWheelsAndOfTheUntouchedGroundAhead) {
    // Ground rising 1 in 10, wheels 3 cm deep: the rear wheel too, so it cancels for the wheels.
    std::vector<double> rising(2600);
    for (std::size_t i = 0; i < rising.size(); ++i) rising[i] = 0.25 * static_cast<double>(i);
    const SinkageField deep(Terrain(0, 2.5, std::vector<double>(2600, 3.0)));
    const PlanarGround ground(Terrain(0, 2.5, rising), deep);
    PlanarCourse course(ground, {}, 5);
    for (int i = 0; i < 100; ++i) {
        const CycleInputs inputs = course.next();
        EXPECT_NEAR(inputs.middle_cm, 2.5, 0.03);
        EXPECT_NEAR(inputs.front_cm, 5.0, 0.03);
        EXPECT_NEAR(inputs.near_cm, 6.0 + 3.0, 1.2);
        EXPECT_NEAR(inputs.far_cm, 8.0 + 3.0, 1.2);
        EXPECT_DOUBLE_EQ(course.sinkage_cm(), 3.0);
        EXPECT_EQ(inputs.odometer_cm, 6.0);
    }
}

TEST(PlanarCourse, SlopeAndSinkageSlowTheVehicleButNeverStopItForGood) {
    std::vector<double> steep(2600);
    for (std::size_t i = 0; i < steep.size(); ++i)
        steep[i] = 0.75 * static_cast<double>(i);  // 30 %
    const CourseOptions options{.scenario = Scenario::slope_sinkage};
    const PlanarGround climb(Terrain(0, 2.5, steep), SinkageField());
    // Half of the stopping slope: uniform on 2.5 +- 2 cm.
    const Moments half = moments(drive(climb, options, 1).advance_cm);
    EXPECT_NEAR(half.mean, 2.5, 0.06);
    EXPECT_GE(half.least, 0.5);
    EXPECT_LE(half.most, 4.5);
    // Far beyond both limits: a mean of 0, uniform on 0 +- 2 cm, clipped at 0.
    const SinkageField bog(Terrain(0, 2.5, std::vector<double>(2600, 20.0)));
    const PlanarGround worst(Terrain(0, 2.5, steep), bog);
    PlanarCourse course(worst, options, 1);
    while (!course.finished()) course.next();
    EXPECT_GE(course.position_cm(), kCourseLengthCm);
}

TEST(PlanarCourse, SameSeedDrawsTheSameAtEveryRoughness) {
    const PlanarGround unit = make_planar_ground(TerrainKind::fractal, 3, 1000).resampled(2.5);
    const PlanarGround smooth = unit.scaled(0.0025);
    const PlanarGround rough = unit.scaled(0.08);
    PlanarCourse one(smooth, {.length_cm = 1000}, 9);
    PlanarCourse other(rough, {.length_cm = 1000}, 9);
    while (!one.finished()) {
        one.next();
        other.next();
        ASSERT_EQ(one.position_cm(), other.position_cm());
    }
}

TEST(PlanarCourse, RefusesAnAdvanceOrALengthThatIsNotAboveZero) {
    const PlanarGround ground = level_ground();
    EXPECT_THROW(PlanarCourse(ground, {.true_mean_cm = 0}, 1), std::invalid_argument);
    EXPECT_THROW(PlanarCourse(ground, {.length_cm = 0}, 1), std::invalid_argument);
}

/// Answers with what it was told to.
class Oracle final : public SlipEstimator {
public:
    void reset(const PlanarGround& ground) override { start_cm = ground.surface_cm(0); }
    double step(const CycleInputs&) override { return 5.5; }
    [[nodiscard]] double sinkage_cm() const override { return 0.5; }
    [[nodiscard]] std::optional<double> position_sigma_cm() const override { return 1e6; }
    double start_cm = -1;
};

TEST(RunCourse, ScoresTheEstimatorItIsGiven) {
    const PlanarGround ground = level_ground();
    Oracle oracle;
    const RunResult result = run_course(ground, {}, 1, oracle);
    EXPECT_EQ(oracle.start_cm, 0);
    // 5.5 instead of a mean of 5 cm, up to the scatter of 1250 advances of sigma 1.
    EXPECT_NEAR(result.odometry_error_pct, 10, 3);
    EXPECT_DOUBLE_EQ(result.sinkage_square_cm2, 0.25);
    EXPECT_DOUBLE_EQ(result.zero_square_cm2, 0);
    EXPECT_EQ(result.covered, true);
    EXPECT_NEAR(static_cast<double>(result.cycles), 1250, 40);
}

TEST(PlanarCourse, FromTheOnsetOnTheAdvanceIsAsGivenAndNeverNegative) {
    const PlanarGround ground = level_ground();
    CourseOptions options;
    options.onset = SlipOnset{.at_cm = 1000, .mean_cm = 1, .sigma_cm = 0.5};
    PlanarCourse course(ground, options, 4);
    std::vector<double> after_cm;
    while (course.position_cm() < 3000) {
        const double before_cm = course.position_cm();
        (void)course.next();
        if (before_cm >= 1000) after_cm.push_back(course.position_cm() - before_cm);
    }
    // 2000 draws: a standard error of 0.011 cm. Clipping at 0 raises the mean by 0.004 cm.
    EXPECT_NEAR(moments(after_cm).mean, 1.0, 0.06);
    EXPECT_GE(moments(after_cm).least, 0);
}

}  // namespace
