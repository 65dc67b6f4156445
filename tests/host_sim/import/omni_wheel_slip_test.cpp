// Omni-wheel runs: kinematics, synthetic runs whose truth is known, refusals, the real recordings.
#include "host_sim/import/omni_wheel_slip.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>
#include <numbers>
#include <sstream>

#include "host_sim/log/log_io.hpp"

namespace {

using namespace host_sim;

constexpr double kDeg = std::numbers::pi / 180;
constexpr double kMmPerTick = 2 * std::numbers::pi * 40 / 32000;

/// Rim speed of the three wheels for a body velocity, as the data set's own set values have it:
/// (0.1, 0) m/s -> (-34.641, 0, 34.641) rad/s, (0, 0.1) -> (20, -40, 20) at gear 16, radius 40 mm.
std::array<double, 3> rim_mm(double x_mm, double y_mm, double turn_rad) {
    const double c = std::sqrt(3.0) / 2;
    return {-c * x_mm + y_mm / 2 + 125 * turn_rad, -y_mm + 125 * turn_rad,
            c * x_mm + y_mm / 2 + 125 * turn_rad};
}

TEST(OmniKinematics, MatchTheDataSetsSetValues) {
    const double to_motor_rad = 16 / 40.0;
    EXPECT_NEAR(rim_mm(100, 0, 0)[0] * to_motor_rad, -34.641, 1e-3);
    EXPECT_NEAR(rim_mm(100, 0, 0)[2] * to_motor_rad, 34.641, 1e-3);
    EXPECT_NEAR(rim_mm(0, 100, 0)[1] * to_motor_rad, -40, 1e-9);
}

double weighted(const OmniMapping::Channel& channel, const std::array<double, 3>& rim) {
    double sum = 0;
    for (std::size_t i = 0; i < 3; ++i) sum += channel.ticks_forward[i] * rim[i];
    return sum;
}

// Whatever the direction: each channel, times its radius over 40 mm, says how far the robot went.
TEST(OmniMapping, EveryChannelMeasuresTheTravelAlongTheDirection) {
    for (int direction = -180; direction <= 360; direction += 5) {
        const OmniMapping mapping = omni_mapping(direction);
        const auto rim =
            rim_mm(100 * std::cos(direction * kDeg), 100 * std::sin(direction * kDeg), 0);
        ASSERT_FALSE(mapping.channels.empty());
        for (const auto& channel : mapping.channels) {
            EXPECT_NEAR(weighted(channel, rim) * mapping.wheel_radius_mm / 40, 100, 1e-9)
                << direction;
        }
    }
}

TEST(OmniMapping, TurningOnTheSpotAddsNothingToTheMean) {
    for (int direction = 0; direction < 360; direction += 5) {
        const OmniMapping mapping = omni_mapping(direction);
        double mean = 0;
        for (const auto& channel : mapping.channels) mean += weighted(channel, rim_mm(0, 0, 0.1));
        EXPECT_NEAR(mean, 0, 1e-9) << direction;
    }
}

TEST(OmniMapping, RollingAcrossTheDirectionAddsNothing) {
    for (int direction = 0; direction < 360; direction += 5) {
        const OmniMapping mapping = omni_mapping(direction);
        const auto rim =
            rim_mm(-100 * std::sin(direction * kDeg), 100 * std::cos(direction * kDeg), 0);
        double mean = 0;
        for (const auto& channel : mapping.channels) mean += weighted(channel, rim);
        EXPECT_NEAR(mean, 0, 1e-9) << direction;
    }
}

TEST(OmniMapping, MultiplesOfSixtyDegreesUseTwoRawEncodersOneOnEachSide) {
    using enum hal::Wheel;
    const std::map<int, std::array<hal::Wheel, 2>> expected = {{0, {front_left, front_right}},
                                                               {60, {rear_left, rear_right}},
                                                               {120, {front_right, front_left}},
                                                               {180, {rear_right, rear_left}}};
    for (const auto& [direction, wheels] : expected) {
        const OmniMapping mapping = omni_mapping(direction);
        ASSERT_EQ(mapping.channels.size(), 2U) << direction;
        int left = 0;
        for (const auto& channel : mapping.channels) {
            double magnitude = 0;
            for (const double weight : channel.ticks_forward) magnitude += std::abs(weight);
            EXPECT_EQ(magnitude, 1.0);
            left += channel.wheel == front_left || channel.wheel == rear_left;
            // A turn to the left drives left wheels back.
            const double turning = weighted(channel, rim_mm(0, 0, 0.1));
            EXPECT_EQ(turning < 0, channel.wheel == front_left || channel.wheel == rear_left);
        }
        EXPECT_EQ(left, 1);
        for (const hal::Wheel wheel : wheels) {
            EXPECT_TRUE(std::ranges::any_of(mapping.channels, [&](const auto& c) {
                return c.wheel == wheel;
            })) << direction;
        }
    }
    EXPECT_NEAR(omni_mapping(0).wheel_radius_mm, 46.188, 1e-3);
    EXPECT_EQ(omni_mapping(90).wheel_radius_mm, 40.0);
    ASSERT_EQ(omni_mapping(90).channels.size(), 1U);
    EXPECT_EQ(omni_mapping(90).channels[0].wheel, middle_left);
}

/// A synthetic run: constant rim speed along `direction`, the robot making (1 - slip) of it while
/// its heading turns, seen by a camera that has `heading` 0 up and counter-clockwise positive.
std::string synthetic(double direction_deg, double slip, double heading0_deg, double turn_deg_s) {
    std::ostringstream text;
    text.precision(12);
    text << kOmniHeader << "\n";
    double x_px = 900, y_px = 800, body_x = 0, turned = 0, before = 0;
    for (int row = 0; row <= 200; ++row) {
        const double t = row * 31.0 + (row % 3) * 4;
        const double dt = (t - before) / 1000;
        before = t;
        const double heading = heading0_deg + turn_deg_s * t / 1000;
        body_x += 100 * dt;
        turned = turn_deg_s * t / 1000 * kDeg;
        const double course = (heading + direction_deg) * kDeg;  // backward difference: exact
        x_px += -std::sin(course) * 100 * dt * (1 - slip) / kOmniCameraMmPerPixel;
        y_px += -std::cos(course) * 100 * dt * (1 - slip) / kOmniCameraMmPerPixel;
        const auto rim = rim_mm(body_x * std::cos(direction_deg * kDeg),
                                body_x * std::sin(direction_deg * kDeg), turned);
        text << t << "," << 0.1 * std::cos(direction_deg * kDeg) << ","
             << 0.1 * std::sin(direction_deg * kDeg) << ",0,0,0,0";
        for (const double mm : rim) text << "," << std::round(mm / kMmPerTick);
        text << ",0,0,0,0,0,0,0,0,0," << x_px << "," << y_px << "," << std::fmod(heading + 720, 360)
             << ",0,0,0\n";
    }
    return text.str();
}

Log import_text(const std::string& text) {
    return import_omni(parse_numeric_table(text, "run.csv", kOmniHeader));
}

/// Odometry since the first step: mean over the present wheels, by the record in the head.
std::vector<double> odometry_mm(const Log& log) {
    std::vector<double> odometry = {0};
    for (std::size_t step = 1; step < log.steps.size(); ++step) {
        double sum = 0;
        int present = 0;
        for (std::size_t wheel = 0; wheel < hal::kWheelCount; ++wheel) {
            if ((log.steps[step].inputs.tach_present >> wheel & 1) == 0) continue;
            ++present;
            sum += static_cast<std::int16_t>(
                static_cast<std::uint16_t>(log.steps[step].inputs.tach_count[wheel] -
                                           log.steps[step - 1].inputs.tach_count[wheel]));
        }
        odometry.push_back(odometry.back() +
                           sum / present * log.head.calibration.tach_q16_mm_per_count / 65536.0);
    }
    return odometry;
}

TEST(Omni, OdometryTruthAndSlipOfKnownRuns) {
    for (const double direction : {0.0, 60.0, 90.0, 180.0, 25.0}) {
        for (const double heading : {0.0, 270.0}) {
            const Log log = import_text(synthetic(direction, 0.4, heading, 5));
            ASSERT_GT(log.steps.size(), 60U);
            const std::vector<double> odometry = odometry_mm(log);
            for (std::size_t step = 0; step < log.steps.size(); ++step) {
                const double driven = log.steps[step].time_ms * 0.1;
                // A prescaled count is 0.145 mm; floors at both ends.
                ASSERT_NEAR(odometry[step], driven, 0.35) << direction << " " << step;
                ASSERT_NEAR(log.steps[step].truth->position_mm, 0.6 * driven, 0.01);
                if (step < 6) {
                    ASSERT_TRUE(std::isnan(log.steps[step].truth->slip));
                } else if (step > 6) {
                    ASSERT_NEAR(log.steps[step].truth->slip, 0.4, 0.001);
                }
            }
        }
    }
}

TEST(Omni, OnlyWhatTheVehicleHasIsPresent) {
    const Log log = import_text(synthetic(0, 0, 0, 0));
    EXPECT_EQ(log.steps[0].time_ms, 0U);
    EXPECT_EQ(log.steps[1].inputs.tick_count, 10);
    for (const LogStep& step : log.steps) {
        for (const std::uint16_t count : step.inputs.adc_q4_count) {
            EXPECT_EQ(count, hal::kAdcAbsent);
        }
        EXPECT_EQ(step.inputs.tach_present, 0b000011);
        EXPECT_EQ(step.inputs.range_present, 0);
        ASSERT_TRUE(step.truth.has_value());
        EXPECT_TRUE(std::isnan(step.truth->sinkage_mm));
        EXPECT_TRUE(std::isnan(step.truth->surface_rear_mm));
        EXPECT_TRUE(std::isnan(step.truth->surface_front_mm));
        EXPECT_TRUE(std::isnan(step.truth->ground_front_mm));
        EXPECT_FALSE(step.commands.has_value());
    }
}

/// Replaces one field of one line (1-based) and says where the run is refused; 0: accepted.
std::size_t refused_line(std::size_t line, std::size_t field, const std::string& value) {
    std::istringstream in(synthetic(0, 0, 0, 0));
    std::string text, row;
    for (std::size_t number = 1; std::getline(in, row); ++number) {
        if (number == line) {
            std::size_t from = 0;
            for (std::size_t i = 0; i < field; ++i) from = row.find(',', from) + 1;
            row.replace(from, row.find(',', from) - from, value);
        }
        text += row + "\n";
    }
    try {
        (void)import_text(text);
        return 0;
    } catch (const LogError& error) {
        return error.line();
    }
}

TEST(Omni, RefusesWhatIsNotAStraightWholeRun) {
    EXPECT_EQ(refused_line(9, 10, "1"), 0U) << "unused column";
    EXPECT_EQ(refused_line(9, 1, "0.2"), 9U) << "command changes";
    EXPECT_EQ(refused_line(9, 3, "0.1"), 9U) << "command turns";
    EXPECT_EQ(refused_line(9, 7, "12.5"), 9U) << "half a tick";
    EXPECT_EQ(refused_line(9, 8, "200000"), 9U) << "jump";
    EXPECT_EQ(refused_line(9, 0, "100"), 9U) << "time goes back";
    EXPECT_EQ(refused_line(9, 0, "800"), 9U) << "gap";
    EXPECT_EQ(refused_line(2, 0, "1.5"), 2U) << "late start";
    EXPECT_EQ(refused_line(9, 19, "nan"), 9U);
    EXPECT_EQ(refused_line(9, 19, "1e6"), 9U);
}

class OmniRuns : public testing::Test {
protected:
    void SetUp() override {
        folder_ = std::filesystem::path(ROVER_SOURCE_DIR) / "../shared/data/omni-wheel-slip";
        if (!std::filesystem::exists(folder_)) {
            GTEST_SKIP() << "data set omni-wheel-slip is not here";
        }
    }
    std::filesystem::path folder_;
};

// The data set's index gives the camera displacement from the dx/dy columns. Those lose a frame
// now and then (the pixels jump twice as far), so the pixels may say up to 6 % more, never less.
TEST_F(OmniRuns, AllImportWithTheIndexedDurationAndDisplacement) {
    std::ifstream index(folder_ / "index.csv");
    std::string line;
    std::getline(index, line);
    int runs = 0;
    while (std::getline(index, line)) {
        std::istringstream fields(line);
        std::vector<std::string> field;
        for (std::string one; std::getline(fields, one, ',');) field.push_back(one);
        const Log log = import_omni(folder_ / "runs" / field.at(0));
        ++runs;
        const double duration_s = std::stod(field.at(5));  // rounded to 0.01 s
        EXPECT_NEAR(static_cast<double>(log.steps.size()), duration_s * 10 + 0.5, 0.6) << line;
        const double camera_mm = std::stod(field.at(6)) * 1000;
        const double position_mm = log.steps.back().truth->position_mm;
        const bool two_gaps = field.at(0) == "gray_3_000.csv";
        EXPECT_GT(position_mm, camera_mm * 0.985 - 10) << line;
        EXPECT_LT(position_mm, camera_mm * (two_gaps ? 1.10 : 1.06)) << line;
        const double odometer_mm = odometry_mm(log).back();
        EXPECT_GT(odometer_mm, position_mm) << line;
        // The motors stay 8 to 10 % under the command, more where they labour, and start late.
        const double commanded_mm = std::stod(field.at(2)) * duration_s * 1000;
        EXPECT_GT(odometer_mm, 0.7 * commanded_mm) << line;
        EXPECT_LT(odometer_mm, commanded_mm) << line;
    }
    EXPECT_EQ(runs, 44);
}

TEST_F(OmniRuns, SlipOrdersTheSurfaces) {
    const auto slip = [&](const std::string& name) {
        const Log log = import_omni(folder_ / "runs" / name);
        return 1 - log.steps.back().truth->position_mm / odometry_mm(log).back();
    };
    const double table = slip("table_1_000.csv");
    const double brown = slip("brown_1_000.csv");
    const double gray = slip("gray_1_000.csv");
    const double green = slip("green_1_000.csv");
    EXPECT_NEAR(table, 0.10, 0.02);
    EXPECT_NEAR(brown, 0.19, 0.02);
    EXPECT_NEAR(gray, 0.36, 0.02);
    EXPECT_NEAR(green, 0.77, 0.02);
}

}  // namespace
