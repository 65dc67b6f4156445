// sensors_test.cpp - against the converter's definition and the stated noise.
#include "host_sim/world/sensors.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <fstream>
#include <map>
#include <numbers>
#include <sstream>
#include <vector>

namespace host_sim {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;

// What the calibration record says an input means, hal/calibration.hpp.
double decoded_rad(std::uint16_t adc_q4_count, const hal::AngleCalibration& calibration) {
    const double brad = (adc_q4_count - static_cast<double>(calibration.zero_q4_count)) *
                        calibration.gain_q16 / 65536.0;
    return brad / 65536.0 * 2 * std::numbers::pi;
}

double variance_of(const std::vector<double>& values) {
    double mean = 0;
    for (const double value : values) mean += value / static_cast<double>(values.size());
    double sum = 0;
    for (const double value : values) sum += (value - mean) * (value - mean);
    return sum / static_cast<double>(values.size());
}

double correlation_of(const std::vector<double>& a, const std::vector<double>& b) {
    std::vector<double> sum(a.size());
    for (std::size_t i = 0; i < a.size(); ++i) sum[i] = a[i] + b[i];
    return (variance_of(sum) - variance_of(a) - variance_of(b)) /
           (2 * std::sqrt(variance_of(a) * variance_of(b)));
}

TEST(Convert12Bit, FloorsAndHoldsTheRails) {
    EXPECT_EQ(convert_12bit(-1e9), 0u);
    EXPECT_EQ(convert_12bit(-0.001), 0u);
    EXPECT_EQ(convert_12bit(0.999), 0u);
    EXPECT_EQ(convert_12bit(1.0), 1u);
    EXPECT_EQ(convert_12bit(2047.9999), 2047u);
    EXPECT_EQ(convert_12bit(4094.999), 4094u);
    EXPECT_EQ(convert_12bit(4095.0), 4095u);
    EXPECT_EQ(convert_12bit(1e300), 4095u);
    EXPECT_EQ(convert_12bit(std::nan("")), 0u);
}

TEST(Sensors, NoiselessAnglesAreSixteenTimesTheFlooredCount) {
    Sensors sensors(rocky32(), SensorModel::noiseless(), 1);
    for (double degrees = -100; degrees <= 100; degrees += 0.37) {
        SensedState state;
        state.angle_rad.fill(degrees * kDegree);
        const hal::RawInputs inputs = sensors.read(state);
        for (std::size_t i = 0; i < 5; ++i) {
            const double span_deg = i < 3 ? 90.0 : 150.0;
            double count = std::floor((degrees / span_deg + 0.5) * 4096.0 + 1e-12);
            count = std::min(4095.0, std::max(0.0, count));
            ASSERT_EQ(inputs.adc_q4_count[i], 16 * count) << degrees << " channel " << i;
        }
    }
}

TEST(Sensors, ChannelsThatAreNotModelledAreAbsent) {
    Sensors sensors(rocky32(), SensorModel{}, 1);
    const hal::RawInputs inputs = sensors.read({});
    for (std::size_t i = 5; i < hal::kAdcChannelCount; ++i) {
        EXPECT_EQ(inputs.adc_q4_count[i], hal::kAdcAbsent);
    }
    EXPECT_EQ(inputs.command_size, 0);
    EXPECT_EQ(inputs.detector_bits, 0);
    EXPECT_EQ(inputs.tach_present, 0x3F);
}

// The converter floors, so a dithered sum lies half a count low; the record's zero accounts for it.
TEST(Sensors, DitheredReadingHasNoBiasUnderTheNominalCalibration) {
    Sensors sensors(rocky32(), SensorModel{}, 2);
    const hal::Calibration calibration = nominal_calibration(rocky32());
    Random random = stream(2, "angles");
    constexpr int kReads = 20000;
    double error[5] = {};
    for (int i = 0; i < kReads; ++i) {
        SensedState state;
        for (double& angle : state.angle_rad) angle = random.uniform(-0.5, 0.5);
        const hal::RawInputs inputs = sensors.read(state);
        for (std::size_t k = 0; k < 5; ++k) {
            error[k] +=
                decoded_rad(inputs.adc_q4_count[k], calibration.angle[k]) - state.angle_rad[k];
        }
    }
    // One reading has a sigma of about 0.1 mrad; 5 sigma of the mean, and the gain's rounding.
    for (const double sum : error) EXPECT_NEAR(sum / kReads, 0, 5 * 1.2e-4 / std::sqrt(kReads));
}

// Wilcox 1994: 0.04 mm for the elevation difference of the wheels.
TEST(Sensors, DefaultNoiseIsThePapers) {
    Sensors sensors(rocky32(), SensorModel{}, 3);
    const hal::Calibration calibration = nominal_calibration(rocky32());
    Random random = stream(3, "angles");
    std::vector<double> middle_mm;
    std::vector<double> range_mm;
    for (int i = 0; i < 20000; ++i) {
        SensedState state;
        for (double& angle : state.angle_rad) angle = random.uniform(-0.1, 0.1);
        state.range_seen = 1;
        state.range_height_cm[0] = random.uniform(-10, 10);
        const hal::RawInputs inputs = sensors.read(state);
        double seen[5];
        for (std::size_t k = 0; k < 5; ++k) {
            seen[k] = decoded_rad(inputs.adc_q4_count[k], calibration.angle[k]);
        }
        const auto z1_mm = [](double pitch, double differential, double bogie) {
            const double rho = pitch + differential;
            return 375 * std::sin(rho) - 125 * std::sin(rho + bogie);
        };
        middle_mm.push_back(z1_mm(seen[3], seen[2], seen[0]) -
                            z1_mm(state.angle_rad[3], state.angle_rad[2], state.angle_rad[0]));
        range_mm.push_back(inputs.range_q1_mm[0] / 2.0 - 10 * state.range_height_cm[0]);
    }
    EXPECT_NEAR(std::sqrt(variance_of(middle_mm)), 0.04, 0.003);
    EXPECT_NEAR(std::sqrt(variance_of(range_mm)), 2.0, 0.05);
}

SensorModel common_noise_only() {
    SensorModel model = SensorModel::noiseless();
    model.potentiometer_noise_rad = 0.02;  // 50 counts, so that quantisation does not matter
    model.inclinometer_noise_rad = 0.02;
    return model;
}

TEST(Sensors, CommonNoiseHasTheStatedCorrelations) {
    for (const double wanted : {-0.9, 0.0, 0.9}) {
        SensorModel model = common_noise_only();
        model.linkage_correlation = wanted;
        Sensors sensors(rocky32(), model, 5);
        std::vector<double> left;
        std::vector<double> right;
        std::vector<double> differential;
        std::vector<double> pitch;
        for (int i = 0; i < 20000; ++i) {
            const hal::RawInputs inputs = sensors.read({});
            left.push_back(inputs.adc_q4_count[0]);
            right.push_back(inputs.adc_q4_count[1]);
            differential.push_back(inputs.adc_q4_count[2]);
            pitch.push_back(inputs.adc_q4_count[3]);
        }
        EXPECT_NEAR(correlation_of(left, differential), wanted, 0.04);
        EXPECT_NEAR(correlation_of(right, differential), wanted, 0.04);
        EXPECT_NEAR(correlation_of(pitch, differential), 0, 0.04);
        const double sigma_rad = std::sqrt(variance_of(left)) * 90 * kDegree / 65536;
        EXPECT_NEAR(sigma_rad, 0.02, 0.0006);
    }
}

TEST(Sensors, CommonNoiseHasTheStatedMemoryAndKeepsItsSize) {
    SensorModel model = common_noise_only();
    model.noise_memory = 0.8;
    Sensors sensors(rocky32(), model, 6);
    std::vector<double> now;
    std::vector<double> next;
    double before = sensors.read({}).adc_q4_count[2];
    for (int i = 0; i < 50000; ++i) {
        const double value = sensors.read({}).adc_q4_count[2];
        now.push_back(before);
        next.push_back(value);
        before = value;
    }
    EXPECT_NEAR(correlation_of(now, next), 0.8, 0.03);
    EXPECT_NEAR(std::sqrt(variance_of(now)) * 90 * kDegree / 65536, 0.02, 0.001);
}

TEST(Sensors, WrongZeroAndGainShiftAndStretchTheReading) {
    SensorModel model = SensorModel::noiseless();
    model.angle_error[2] = {2.0 * kDegree, 1.05};
    Sensors sensors(rocky32(), model, 1);
    SensedState state;
    state.angle_rad.fill(12.0 * kDegree);
    const hal::RawInputs inputs = sensors.read(state);
    // (12 - 2) * 1.05 = 10.5 degrees on the differential, 12 on the bogie.
    EXPECT_EQ(inputs.adc_q4_count[2], 16 * std::floor((10.5 / 90 + 0.5) * 4096));
    EXPECT_EQ(inputs.adc_q4_count[0], 16 * std::floor((12.0 / 90 + 0.5) * 4096));
}

TEST(Sensors, TachometersCountPulsesModulo65536BothWays) {
    Sensors sensors(rocky32(), SensorModel{}, 1);
    const double turn_cm = 2 * std::numbers::pi * 6.5;
    for (const double turns : {0.0, 0.25, 1.0, 32.75, 33.0, 1000.5, -0.25, -33.0}) {
        SensedState state;
        state.rim_travel_cm.fill(turns * turn_cm + 1e-6);
        const hal::RawInputs inputs = sensors.read(state);
        const long pulses = std::lround(turns * 2000);
        for (const std::uint16_t count : inputs.tach_count) {
            EXPECT_EQ(count, static_cast<std::uint16_t>(pulses & 0xFFFF)) << turns;
        }
    }
}

TEST(Sensors, TachometerSpreadIsDrawnOnceAndHasTheStatedSize) {
    SensorModel model;
    model.tach_spread = 0.02;
    std::vector<double> scale;
    for (std::uint64_t seed = 1; seed <= 500; ++seed) {
        Sensors sensors(rocky32(), model, seed);
        SensedState state;
        state.rim_travel_cm.fill(500);
        const hal::RawInputs first = sensors.read(state);
        const hal::RawInputs second = sensors.read(state);
        for (std::size_t wheel = 0; wheel < hal::kWheelCount; ++wheel) {
            ASSERT_EQ(first.tach_count[wheel], second.tach_count[wheel]);
            scale.push_back(first.tach_count[wheel] * rocky32().cm_per_pulse() / 500);
        }
    }
    EXPECT_NEAR(std::sqrt(variance_of(scale)), 0.02, 0.002);
}

TEST(Sensors, LookAheadComesInHalfMillimetresWithItsScanCounter) {
    SensorModel model = SensorModel::noiseless();
    model.range_scan_steps = 3;
    Sensors sensors(rocky32(), model, 1);
    SensedState state;
    state.range_seen = 0b101;
    state.range_height_cm = {1.23, 5.0, -0.26, 0, 0, 0, 0, 0};
    const hal::RawInputs first = sensors.read(state);
    EXPECT_EQ(first.range_scan_count, 1);
    EXPECT_EQ(first.range_present, 0b101);
    EXPECT_EQ(first.range_q1_mm[0], 25);  // 12.3 mm -> 24.6
    EXPECT_EQ(first.range_q1_mm[1], 0);
    EXPECT_EQ(first.range_q1_mm[2], -5);
    state.range_height_cm[0] = 1e6;
    EXPECT_EQ(sensors.read(state).range_scan_count, 1);
    const hal::RawInputs stale = sensors.read(state);
    EXPECT_EQ(stale.range_scan_count, 1);
    EXPECT_EQ(stale.range_q1_mm[0], 25);
    const hal::RawInputs fresh = sensors.read(state);
    EXPECT_EQ(fresh.range_scan_count, 2);
    EXPECT_EQ(fresh.range_q1_mm[0], 32767);
}

TEST(Sensors, TicksRunTenAStepAndWrap) {
    Sensors sensors(rocky32(), SensorModel::noiseless(), 1);
    for (int i = 0; i < 14000; ++i) {
        ASSERT_EQ(sensors.read({}).tick_count, static_cast<std::uint16_t>(10 * i & 0xFFFF));
    }
}

TEST(Sensors, FollowFromTheSeedAndStreamsAreIndependent) {
    SensorModel louder;
    louder.range_noise_mm = 20;
    Sensors one(rocky32(), SensorModel{}, 8);
    Sensors same(rocky32(), SensorModel{}, 8);
    Sensors range_differs(rocky32(), louder, 8);
    Sensors other(rocky32(), SensorModel{}, 9);
    int differing = 0;
    SensedState state;
    state.range_seen = 3;
    for (int i = 0; i < 200; ++i) {
        const hal::RawInputs a = one.read(state);
        const hal::RawInputs b = same.read(state);
        const hal::RawInputs c = range_differs.read(state);
        const hal::RawInputs d = other.read(state);
        ASSERT_EQ(std::memcmp(a.adc_q4_count, b.adc_q4_count, sizeof a.adc_q4_count), 0);
        ASSERT_EQ(std::memcmp(a.range_q1_mm, b.range_q1_mm, sizeof a.range_q1_mm), 0);
        ASSERT_EQ(std::memcmp(a.adc_q4_count, c.adc_q4_count, sizeof a.adc_q4_count), 0);
        differing +=
            std::memcmp(a.adc_q4_count, d.adc_q4_count, sizeof a.adc_q4_count) != 0 ? 1 : 0;
    }
    EXPECT_GT(differing, 190);
}

TEST(Sensors, RefuseModelsOutOfRange) {
    const auto refused = [](auto change) {
        SensorModel model;
        change(model);
        EXPECT_THROW(Sensors(rocky32(), model, 1), InputError);
    };
    refused([](SensorModel& m) { m.conversion_noise_count = -1; });
    refused([](SensorModel& m) { m.potentiometer_noise_rad = std::nan(""); });
    refused([](SensorModel& m) { m.inclinometer_noise_rad = -1; });
    refused([](SensorModel& m) { m.noise_memory = 1; });
    refused([](SensorModel& m) { m.linkage_correlation = 1.1; });
    refused([](SensorModel& m) { m.range_noise_mm = -2; });
    refused([](SensorModel& m) { m.range_scan_steps = 0; });
    refused([](SensorModel& m) { m.tach_spread = 0.5; });
    refused([](SensorModel& m) { m.angle_error[1].gain = INFINITY; });
}

// Repeats in one pose (same site and drive) of the three suspension potentiometers; exposures that
// appear more than once count once.
TEST(SpiritData, RepeatabilityOfThePotentiometersIsAsStated) {
    const std::string path =
        ROVER_SOURCE_DIR "/../shared/data/mer-spirit-suspension/chassis_state.csv";
    std::ifstream file(path);
    if (!file) GTEST_SKIP() << path << " is not there";
    std::map<std::string, std::map<std::string, std::vector<double>>> poses;
    std::string line;
    std::getline(file, line);
    while (std::getline(file, line)) {
        std::vector<std::string> fields;
        std::istringstream row(line);
        for (std::string field; std::getline(row, field, ',');) fields.push_back(field);
        ASSERT_GE(fields.size(), 13u);
        poses[fields[4] + "/" + std::to_string(std::stoi(fields[5]))][fields[2]] = {
            std::stod(fields[10]), std::stod(fields[11]), std::stod(fields[12])};
    }
    double squares = 0;
    double freedom = 0;
    for (const auto& [pose, readings] : poses) {
        if (readings.size() < 2) continue;
        for (std::size_t k = 0; k < 3; ++k) {
            std::vector<double> values;
            for (const auto& [clock, reading] : readings) values.push_back(reading[k]);
            squares += variance_of(values) * static_cast<double>(values.size());
            freedom += static_cast<double>(values.size()) - 1;
        }
    }
    ASSERT_GT(freedom, 0);
    std::printf("potentiometer repeatability %.3f mrad\n", 1000 * std::sqrt(squares / freedom));
    EXPECT_NEAR(std::sqrt(squares / freedom), kSpiritPotentiometerNoiseRad, 0.1e-3);
}

}  // namespace
}  // namespace host_sim
