// Stops found in synthetic swings with known truth; every refusal.
#include "host_sim/calibration/swing.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "tests/host_sim/calibration/synthetic_swing.hpp"

namespace {

using namespace host_sim;
using host_sim::test::SwingTruth;
using host_sim::test::SyntheticSwing;

double stop_q4_count(const SwingTruth& truth, int side) {
    return truth.zero_q4_count + side * truth.stop_deg * 65536 / 360 * 65536 / truth.gain_q16;
}

// Bound from the noise alone: the mean of all readings at rest, five sigma, plus one Q4 count for
// the readings on the way in that a rest may hold.
TEST(Swing, FindsBothStopsWithinTheNoiseOfTheirMean) {
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
        SwingTruth truth;
        truth.seed = seed;
        truth.zero_q4_count = 32760 + 137.0 * static_cast<double>(seed);
        const Swing swing = find_swing(SyntheticSwing(truth).record());
        const double readings_at_rest = truth.visits * truth.dwell_s * 10;
        const double bound =
            5 * SyntheticSwing::reading_sigma_q4_count(truth) / std::sqrt(readings_at_rest) + 1;
        EXPECT_NEAR(swing.low.q4_count, stop_q4_count(truth, -1), bound) << "seed " << seed;
        EXPECT_NEAR(swing.high.q4_count, stop_q4_count(truth, +1), bound) << "seed " << seed;
        EXPECT_EQ(swing.low.visits, 5) << "seed " << seed;
        EXPECT_EQ(swing.high.visits, 5) << "seed " << seed;
    }
}

TEST(Swing, WithoutNoiseTheErrorIsThatOfOneCode) {
    SwingTruth truth;
    truth.conversion_noise_codes = 0;
    truth.reading_noise_q4_count = 0;
    for (int offset = 0; offset < 16; ++offset) {
        truth.zero_q4_count = 32000 + offset;
        const Swing swing = find_swing(SyntheticSwing(truth).record());
        EXPECT_NEAR(swing.low.q4_count, stop_q4_count(truth, -1), 8.1);
        EXPECT_NEAR(swing.low.standard_error_q4_count, 16 / std::sqrt(12.0), 1e-9);
    }
}

TEST(Swing, BouncesAndPausesAtOneStopAreOneVisit) {
    SyntheticSwing paused({.bounce_deg = 2.9, .rest_halfway = false});
    paused.hold(0, 1);
    for (int visit = 0; visit < 3; ++visit) {
        paused.visit_stop(-1);
        paused.move_to(-27, 0.5);  // eases off and pushes again
        paused.visit_stop(-1);
        paused.visit_stop(+1);
    }
    const Swing found = find_swing(paused.readings());
    EXPECT_EQ(found.low.visits, 3);
    EXPECT_EQ(found.high.visits, 3);
}

TEST(Swing, ToleratesASmallShareOfAbsentReadings) {
    std::vector<Reading> readings = SyntheticSwing({}).record();
    const Swing whole = find_swing(readings);
    for (std::size_t i = 5; i < readings.size(); i += 12) readings[i].q4_count = hal::kAdcAbsent;
    const Swing holed = find_swing(readings);
    EXPECT_NEAR(holed.low.q4_count, whole.low.q4_count, 3);
    EXPECT_EQ(holed.high.visits, whole.high.visits);
}

std::string refusal(const std::vector<Reading>& readings, const SwingOptions& options = {}) {
    try {
        (void)find_swing(readings, options);
        return "";
    } catch (const CalibrationError& error) {
        return error.what();
    }
}

void expect_refusal(const std::vector<Reading>& readings, std::string_view phrase) {
    EXPECT_NE(refusal(readings).find(phrase), std::string::npos) << refusal(readings);
}

TEST(SwingRefuses, AnAbsentSensor) {
    std::vector<Reading> readings = SyntheticSwing({}).record();
    for (std::size_t i = 0; i < readings.size(); i += 8) readings[i].q4_count = hal::kAdcAbsent;
    expect_refusal(readings, "absent in");
    for (Reading& reading : readings) reading.q4_count = hal::kAdcAbsent;
    expect_refusal(readings, "absent in the whole log");
    expect_refusal({}, "absent in the whole log");
}

TEST(SwingRefuses, ASpanThatIsTooSmall) {
    SwingTruth truth;
    truth.stop_deg = 4;
    truth.rest_halfway = false;
    truth.bounce_deg = 0.3;
    expect_refusal(SyntheticSwing(truth).record(), "span");
    SyntheticSwing still({});
    still.hold(5, 20);
    expect_refusal(still.readings(), "span");
}

TEST(SwingRefuses, OneStopOnly) {
    SyntheticSwing one({.rest_halfway = false});
    for (int visit = 0; visit < 5; ++visit) {
        one.visit_stop(-1);
        one.move_to(5 + 3 * visit, 1.5);
        one.hold(5 + 3 * visit, 1.5);
    }
    expect_refusal(one.readings(), "the high stop");
    SyntheticSwing other({.rest_halfway = false});
    for (int visit = 0; visit < 5; ++visit) {
        other.visit_stop(+1);
        other.move_to(-5 - 3 * visit, 1.5);
        other.hold(-5 - 3 * visit, 1.5);
    }
    expect_refusal(other.readings(), "the low stop");
}

TEST(SwingRefuses, TooFewVisits) {
    SwingTruth truth;
    truth.visits = 2;
    expect_refusal(SyntheticSwing(truth).record(), "visited 2 times, 3 needed");
    SwingOptions two;
    two.visits_min = 2;
    EXPECT_EQ(refusal(SyntheticSwing(truth).record(), two), "");
}

TEST(SwingRefuses, NoiseThatIsTooLarge) {
    SwingTruth truth;
    truth.reading_noise_q4_count = 150;
    expect_refusal(SyntheticSwing(truth).record(), "scatter");
    truth.reading_noise_q4_count = 33;
    expect_refusal(SyntheticSwing(truth).record(), "scatter");
}

TEST(SwingRefuses, AnArmThatNeverRests) {
    SyntheticSwing restless({});
    for (int i = 0; i < 12; ++i) restless.move_to(i % 2 == 0 ? -30 : 30, 3);
    expect_refusal(restless.readings(), "never rests");
}

TEST(SwingRefuses, ReadingsFarBeyondTheSupposedStop) {
    SyntheticSwing swing({});
    std::vector<Reading> readings = swing.record();
    readings[20].q4_count = 65000;
    expect_refusal(readings, "beyond the outermost rest");
}

TEST(SwingRefuses, AConverterAtItsLimit) {
    SwingTruth truth;
    truth.zero_q4_count = 32760 + 13000;
    expect_refusal(SyntheticSwing(truth).record(), "converter is at its limit at the high stop");
    truth.zero_q4_count = 32760 - 13000;
    expect_refusal(SyntheticSwing(truth).record(), "converter is at its limit at the low stop");
}

}  // namespace
