// The record from whole logs: zero, gain and their stated errors against known truth; refusals.
#include "host_sim/calibration/calibrate.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/host_sim/calibration/synthetic_swing.hpp"

namespace {

using namespace host_sim;
using hal::AngleChannel;
using host_sim::test::SwingTruth;
using host_sim::test::SyntheticSwing;

/// A log in which channel i shows readings[i]; channels without readings are absent.
Log log_of(const std::vector<std::vector<Reading>>& readings) {
    Log log;
    for (std::size_t channel = 0; channel < readings.size(); ++channel) {
        for (std::size_t i = 0; i < readings[channel].size(); ++i) {
            if (i == log.steps.size()) {
                log.steps.emplace_back();
                log.steps[i].time_ms = static_cast<std::uint32_t>(100 * (i + 1));
                std::ranges::fill(log.steps[i].inputs.adc_q4_count, hal::kAdcAbsent);
            }
            log.steps[i].inputs.adc_q4_count[channel] = readings[channel][i].q4_count;
        }
    }
    return log;
}

std::vector<Reading> swing_of(const SwingTruth& truth) {
    return SyntheticSwing(truth).record();
}

CalibrateOptions only(AngleChannel channel) {
    CalibrateOptions options;
    options.swung = {channel};
    return options;
}

TEST(Calibrate, RecoversThreeDifferentPotentiometers) {
    const SwingTruth left = {.zero_q4_count = 33111, .gain_q16 = 15800, .seed = 1};
    const SwingTruth right = {.zero_q4_count = 31000, .gain_q16 = 17100, .seed = 2};
    const SwingTruth middle = {
        .zero_q4_count = 32500, .gain_q16 = 16500, .stop_deg = 18, .inverted = true, .seed = 3};
    CalibrateOptions options;
    options.differential_stop_deg = 18;
    Log log = log_of({swing_of(left), swing_of(right), swing_of(middle)});
    log.head.calibration.wheel_radius_q4_mm = 1041;
    const CalibrationResult result = calibrate(log, options);
    ASSERT_EQ(result.channels.size(), 3U);
    const SwingTruth* truths[] = {&left, &right, &middle};
    for (std::size_t i = 0; i < 3; ++i) {
        const ChannelCalibration& found = result.channels[i];
        EXPECT_NEAR(found.zero_q4_count, truths[i]->zero_q4_count, 4 * found.zero_error_q4_count);
        EXPECT_NEAR(found.gain_q16, truths[i]->gain_q16, 4 * found.gain_error_q16);
        EXPECT_EQ(result.record.angle[i].zero_q4_count, std::lround(found.zero_q4_count));
        EXPECT_EQ(result.record.angle[i].gain_q16, std::lround(found.gain_q16));
    }
    EXPECT_EQ(result.record.wheel_radius_q4_mm, 1041) << "the rest of the record stays";
    EXPECT_EQ(result.record.angle[3].zero_q4_count, 32760);
}

struct Coverage {
    double rms = 0;
    double within_two = 0;  ///< share
};

/// Errors of zero and gain over many random swings, in stated standard errors.
Coverage coverage(SwingTruth truth, int runs) {
    Coverage covered;
    for (int run = 1; run <= runs; ++run) {
        truth.seed = static_cast<std::uint64_t>(run);
        truth.zero_q4_count = 32760 + std::remainder(run * 777.7, 3000);
        truth.gain_q16 = 16384 + std::remainder(run * 333.3, 2000);
        const ChannelCalibration found =
            calibrate(log_of({swing_of(truth)}), only(AngleChannel::bogie_left)).channels.at(0);
        for (const double deviation :
             {(found.zero_q4_count - truth.zero_q4_count) / found.zero_error_q4_count,
              (found.gain_q16 - truth.gain_q16) / found.gain_error_q16}) {
            covered.rms += deviation * deviation / (2 * runs);
            covered.within_two += (std::abs(deviation) < 2) / (2.0 * runs);
        }
    }
    covered.rms = std::sqrt(covered.rms);
    return covered;
}

// The stated error is neither too small nor useless, whatever dominates: readings that never vary,
// the board's ordinary noise, noisy readings, or stops that do not repeat.
TEST(Calibrate, StatedErrorsAreTrue) {
    const SwingTruth cases[] = {
        {.conversion_noise_codes = 0, .reading_noise_q4_count = 0},
        {.conversion_noise_codes = 0.5, .reading_noise_q4_count = 3},
        {.conversion_noise_codes = 0.5, .reading_noise_q4_count = 12},
        {.conversion_noise_codes = 0.5, .reading_noise_q4_count = 3, .stop_scatter_q4_count = 25},
    };
    for (const SwingTruth& truth : cases) {
        const Coverage covered = coverage(truth, 150);
        SCOPED_TRACE(testing::Message() << "noise " << truth.reading_noise_q4_count << " scatter "
                                        << truth.stop_scatter_q4_count << " rms " << covered.rms
                                        << " within two " << covered.within_two);
        EXPECT_LT(covered.rms, 1.5);
        EXPECT_GT(covered.rms, 0.05);
        EXPECT_GT(covered.within_two, 0.9);
    }
}

TEST(Calibrate, PolarityStaysUnlessFlipped) {
    Log log = log_of({swing_of({})});
    CalibrateOptions options = only(AngleChannel::bogie_left);
    EXPECT_FALSE(calibrate(log, options).record.angle[0].inverted);
    log.head.calibration.angle[0].inverted = true;
    EXPECT_TRUE(calibrate(log, options).record.angle[0].inverted);
    options.flip[0] = true;
    EXPECT_FALSE(calibrate(log, options).record.angle[0].inverted);
}

std::vector<Reading> constant(std::uint16_t first, std::uint16_t second) {
    std::vector<Reading> readings;
    for (std::uint32_t i = 0; i < 120; ++i) {
        readings.push_back({100 * (i + 1), i < 60 ? first : second});
    }
    return readings;
}

CalibrateOptions level_only(bool turned) {
    CalibrateOptions options;
    options.swung.clear();
    options.level_span = TimeSpan{0, 5};
    if (turned) options.turned_span = TimeSpan{7, 12};
    return options;
}

TEST(Calibrate, LevelStretchGivesTheInclinometerZero) {
    const Log log = log_of({{}, {}, {}, constant(32800, 0), constant(32700, 0)});
    const CalibrationResult result = calibrate(log, level_only(false));
    EXPECT_EQ(result.record.angle[3].zero_q4_count, 32800);
    EXPECT_EQ(result.record.angle[4].zero_q4_count, 32700);
    EXPECT_EQ(result.record.angle[3].gain_q16, hal::kInclinometerGainQ16);
    EXPECT_EQ(result.record.angle[0].zero_q4_count, 32760) << "not swung: untouched";
}

// Turned by half a turn the ground's slope changes sign and the instrument's offset does not.
TEST(Calibrate, TwoHeadingsRemoveTheGroundsSlope) {
    Log log = log_of({{}, {}, {}, constant(32800 + 874, 32800 - 874), constant(32700, 32700)});
    CalibrationResult result = calibrate(log, level_only(true));
    EXPECT_EQ(result.record.angle[3].zero_q4_count, 32800);
    EXPECT_NEAR(result.ground_pitch_deg, 2.0, 0.001);  // 874 Q4 counts of 150 deg / 65536
    EXPECT_NEAR(result.channels[0].zero_error_q4_count, 16 / std::sqrt(12.0) / std::sqrt(2.0),
                1e-9);
    log.head.calibration.angle[3].inverted = true;
    EXPECT_NEAR(calibrate(log, level_only(true)).ground_pitch_deg, -2.0, 0.001);
}

std::string refusal(const Log& log, const CalibrateOptions& options) {
    try {
        (void)calibrate(log, options);
        return "";
    } catch (const CalibrationError& error) {
        return error.what();
    }
}

void expect_refusal(const Log& log, const CalibrateOptions& options, std::string_view phrase) {
    EXPECT_NE(refusal(log, options).find(phrase), std::string::npos) << refusal(log, options);
}

TEST(CalibrateRefuses, AnImplausibleGainSuchAsARestHalfwayTakenForAStop) {
    SyntheticSwing swing({.rest_halfway = false});
    for (int visit = 0; visit < 4; ++visit) {
        swing.visit_stop(-1);
        swing.move_to(2, 1.5);
        swing.hold(2, 1.5);
    }
    expect_refusal(log_of({swing.readings()}), only(AngleChannel::bogie_left),
                   "bogie_left: the gain would be +8");
    CalibrateOptions wrong_stops = only(AngleChannel::bogie_left);
    wrong_stops.bogie_stop_deg = 20;
    expect_refusal(log_of({swing_of({})}), wrong_stops, "the gain would be -33 %");
}

TEST(CalibrateRefuses, AnImplausibleZero) {
    SwingTruth truth;
    truth.zero_q4_count = 32760 + 9000;
    expect_refusal(log_of({swing_of(truth)}), only(AngleChannel::bogie_left), "the zero would be");
    const Log tilted = log_of({{}, {}, {}, constant(32760 + 5000, 0), constant(32760, 0)});
    expect_refusal(tilted, level_only(false), "pitch: the zero would be 11.4 deg off");
}

TEST(CalibrateRefuses, AnAbsentSensorByName) {
    expect_refusal(log_of({swing_of({})}), {}, "bogie_right: the sensor is absent");
    expect_refusal(log_of({swing_of({})}), level_only(false), "pitch: the sensor is absent");
    expect_refusal({}, {}, "bogie_left: the sensor is absent");
}

TEST(CalibrateRefuses, OptionsThatMakeNoSense) {
    const Log log = log_of({swing_of({})});
    CalibrateOptions options = only(AngleChannel::bogie_left);
    options.bogie_stop_deg = 45;
    expect_refusal(log, options, "outside (0, 45)");
    options = only(AngleChannel::pitch);
    expect_refusal(log, options, "no stops");
    options = only(AngleChannel::bogie_left);
    options.turned_span = TimeSpan{0, 5};
    expect_refusal(log, options, "needs the level stretch");
    options = {};
    options.swung.clear();
    expect_refusal(log, options, "nothing to estimate");
    options = only(AngleChannel::bogie_left);
    options.swing.visits_min = 1;
    expect_refusal(log, options, "visits at least 2");
}

TEST(Describe, NamesEveryChannelAndWhatTheErrorsLeaveOut) {
    CalibrateOptions options = only(AngleChannel::bogie_left);
    const auto lines = describe(calibrate(log_of({swing_of({})}), options), options);
    ASSERT_EQ(lines.size(), 2U);
    EXPECT_TRUE(lines[0].starts_with("bogie_left")) << lines[0];
    EXPECT_NE(lines[1].find("+-30 deg"), std::string::npos) << lines[1];
}

}  // namespace
