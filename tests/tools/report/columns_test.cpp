#include "tools/report/columns.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace {

using host_sim::Log;
using host_sim::LogStep;
using report::PlaceSource;

LogStep step_at(std::uint32_t time_ms) {
    LogStep step;
    step.time_ms = time_ms;
    return step;
}

Log log_of_positions(std::initializer_list<double> positions_mm) {
    Log log;
    for (const double position_mm : positions_mm) {
        log.steps.push_back(step_at(static_cast<std::uint32_t>(100 * log.steps.size())));
        log.steps.back().truth.emplace().position_mm = position_mm;
    }
    return log;
}

// io.hpp and calibration.hpp: +-45 deg over 65536 Q4 counts, so 65520 counts from a zero at 0 are
// 90 * 65520/65536 = 89.978 deg.
TEST(CalibratedDeg, FollowsTheCalibrationRecord) {
    EXPECT_NEAR(report::calibrated_deg({0, 16384, false}, 65520), 89.97803, 1e-5);
    EXPECT_NEAR(report::calibrated_deg({32760, 16384, true}, 32760 + 728), -728 * 90.0 / 65536,
                1e-9);
}

TEST(CalibratedDeg, AbsentOrUncalibratedIsNotKnown) {
    EXPECT_TRUE(std::isnan(report::calibrated_deg({}, hal::kAdcAbsent)));
    EXPECT_TRUE(std::isnan(report::calibrated_deg({}, 65521)));
    EXPECT_TRUE(std::isnan(report::calibrated_deg({32760, 0, false}, 100)));
}

// 65536/65536 mm a pulse; wheel 0: 65530 -> 4 is +10 across the wrap, wheel 1: 100 -> 80 is -20.
TEST(WheelTravel, MeanOverPresentWheelsAcrossTheWrap) {
    Log log;
    log.head.calibration.tach_q16_mm_per_count = 32768;  // half a millimetre a pulse
    for (const auto& [left, right, present] :
         {std::tuple{65530, 100, 3}, std::tuple{4, 80, 3}, std::tuple{14, 0, 1}}) {
        LogStep step;
        step.inputs.tach_count[0] = static_cast<std::uint16_t>(left);
        step.inputs.tach_count[1] = static_cast<std::uint16_t>(right);
        step.inputs.tach_present = static_cast<std::uint8_t>(present);
        log.steps.push_back(step);
    }
    const report::Column travel_mm = report::wheel_travel_mm(log);
    EXPECT_DOUBLE_EQ(travel_mm[0], 0.0);
    EXPECT_DOUBLE_EQ(travel_mm[1], -2.5);      // (10 - 20)/2 pulses
    EXPECT_DOUBLE_EQ(travel_mm[2], -2.5 + 5);  // wheel 0 alone: 10 pulses
}

TEST(WheelTravel, WithoutTachometersItIsNotKnown) {
    Log log;
    log.steps.resize(3);
    for (const double value : report::wheel_travel_mm(log)) EXPECT_TRUE(std::isnan(value));
}

TEST(TrackOf, TruePositionIsThePlaceAndSmallStepsBackAreLevelled) {
    const auto track = report::track_of(log_of_positions({50, 1000, 950, 2000}));
    EXPECT_EQ(track.source, PlaceSource::truth);
    EXPECT_FALSE(track.reverses);
    EXPECT_EQ(track.place_m, (report::Column{0.05, 1.0, 1.0, 2.0}));
}

TEST(TrackOf, ReversingTurnsThePlaceIntoDistanceDriven) {
    const auto track = report::track_of(log_of_positions({50, 1050, 850, 2050}));
    EXPECT_TRUE(track.reverses);
    EXPECT_EQ(track.place_m, (report::Column{0.0, 1.0, 1.2, 2.4}));
}

TEST(TrackOf, WithoutEnoughTruthTheFirmwareSaysWhere) {
    Log log = log_of_positions({0, 1000, 2000});
    log.steps[1].truth->position_mm = std::numeric_limits<double>::quiet_NaN();  // 2 of 3 known
    for (std::size_t row = 0; row < 3; ++row) {
        log.steps[row].estimates.emplace().position_q4_mm = static_cast<std::int32_t>(8000 * row);
    }
    const auto track = report::track_of(log);
    EXPECT_EQ(track.source, PlaceSource::firmware);
    EXPECT_EQ(track.place_m, (report::Column{0.0, 0.5, 1.0}));
}

TEST(TrackOf, StandingStillOrKnowingNothingGivesNoPlace) {
    EXPECT_EQ(report::track_of(log_of_positions({0, 40, 99})).source, PlaceSource::none);
    Log log;
    EXPECT_EQ(report::track_of(log).source, PlaceSource::none);
    log.steps.resize(2);
    EXPECT_EQ(report::track_of(log).source, PlaceSource::none);
    EXPECT_TRUE(report::track_of(log).place_m.empty());
}

}  // namespace
