#include "host_sim/import/borealtc.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "host_sim/import/board_counts.hpp"
#include "host_sim/log/log_io.hpp"

namespace host_sim {
namespace {

// Columns of the two files.
enum Imu : std::size_t { kImuTime = 0, kAx = 4, kAy = 5, kAz = 6 };
enum Pro : std::size_t { kProTime = 0, kVelLeft = 3, kVelRight = 4 };

constexpr double kImuPeriodS = 0.010;
constexpr double kImuJitterS = 0.001;
constexpr double kStepS = 0.1;

void check_imu(const NumericTable& imu) {
    check_time_column(imu, kImuTime, kImuJitterS, kImuPeriodS + kImuJitterS, "s");
    for (std::size_t row = 0; row < imu.row_count(); ++row) {
        const double nominal_s = static_cast<double>(row) * kImuPeriodS;
        if (std::abs(imu.at(row, kImuTime) - nominal_s) > kImuJitterS) {
            throw LogError(imu.name, {.line = NumericTable::line(row)},
                           fmt::format("time {} s is not {:.2f} s: rows are not 10 ms apart",
                                       imu.at(row, kImuTime), nominal_s),
                           "give the 100 Hz file");
        }
        if (imu.at(row, kAx) == 0 && imu.at(row, kAy) == 0 && imu.at(row, kAz) == 0) {
            throw LogError(imu.name, {.line = NumericTable::line(row)},
                           "the acceleration has no direction", "repair or drop the run");
        }
    }
    for (const std::size_t column : {kAx, kAy, kAz}) {
        check_magnitude(imu, column, 500, "acceleration");
    }
}

void check_pro(const NumericTable& pro) {
    check_time_column(pro, kProTime, 0.2, 0.5, "s");
    for (const std::size_t column : {kVelLeft, kVelRight}) {
        check_magnitude(pro, column, 5, "wheel speed");
    }
}

/// Distance travelled by a wheel since its first row: the integral of the speed taken as linear
/// between rows. Call with times that do not decrease.
class Travel {
public:
    Travel(const NumericTable& pro, std::size_t column) : pro_(pro), column_(column) {}

    double at_m(double time_s) {
        while (row_ + 2 < pro_.row_count() && pro_.at(row_ + 1, kProTime) <= time_s) {
            const double span_s = pro_.at(row_ + 1, kProTime) - pro_.at(row_, kProTime);
            whole_m_ += span_s * (speed(row_) + speed(row_ + 1)) / 2;
            ++row_;
        }
        const double since_s = time_s - pro_.at(row_, kProTime);
        const double span_s = pro_.at(row_ + 1, kProTime) - pro_.at(row_, kProTime);
        const double slope = (speed(row_ + 1) - speed(row_)) / span_s;
        return whole_m_ + since_s * (speed(row_) + slope * since_s / 2);
    }

private:
    [[nodiscard]] double speed(std::size_t row) const { return pro_.at(row, column_); }
    const NumericTable& pro_;
    std::size_t column_;
    std::size_t row_ = 0;
    double whole_m_ = 0;
};

/// Sums the inclinometer codes of the ten rows that end with `last_row`.
void set_inclination(const NumericTable& imu, std::size_t last_row, hal::RawInputs& inputs) {
    std::array<std::uint16_t, kTicksPerStep> pitch{};
    std::array<std::uint16_t, kTicksPerStep> roll{};
    for (std::size_t i = 0; i < kTicksPerStep; ++i) {
        const std::size_t row = last_row + 1 - kTicksPerStep + i;
        const double ax = imu.at(row, kAx);
        const double ay = imu.at(row, kAy);
        const double az = imu.at(row, kAz);
        // x forward, y left, z up: with the nose up the specific force leans forward (ax > 0),
        // with the right side down it leans left (ay > 0).
        pitch[i] = inclinometer_code(std::atan2(ax, std::hypot(ay, az)) * 180 / std::numbers::pi);
        roll[i] = inclinometer_code(std::atan2(ay, az) * 180 / std::numbers::pi);
    }
    inputs.adc_q4_count[static_cast<std::size_t>(hal::AdcChannel::pitch)] =
        sum_of_16_q4_count(pitch);
    inputs.adc_q4_count[static_cast<std::size_t>(hal::AdcChannel::roll)] = sum_of_16_q4_count(roll);
}

LogHead make_head(const NumericTable& imu, const NumericTable& pro) {
    LogHead head;
    head.vehicle = "name = \"Clearpath Husky A200\"\n";
    head.calibration = wheel_calibration(kHuskyWheelRadiusMm);
    head.notes["source"] =
        fmt::format("BorealTC, {} and {}", std::filesystem::path(imu.name).filename().string(),
                    std::filesystem::path(pro.name).filename().string());
    head.notes["vehicle"] = "Clearpath Husky A200: four wheels, skid steer, rigid suspension";
    head.notes["tachometers"] =
        "integral of the recorded side speeds, 2000 counts a turn; both wheels of a side are "
        "driven "
        "by one motor and carry the same count";
    head.notes["inclinometer"] =
        "quasi-static angle of the accelerometer, ten conversions a step scaled to sixteen";
    head.notes["absent"] = "suspension, range, steering, gyro, motor current, true position";
    return head;
}

}  // namespace

Log import_borealtc(const NumericTable& imu, const NumericTable& pro) {
    check_imu(imu);
    check_pro(pro);
    Log log;
    log.head = make_head(imu, pro);
    const double pulses_per_m =
        kTachCountsPerTurn / (2 * std::numbers::pi * kHuskyWheelRadiusMm / 1000);
    Travel left(pro, kVelLeft);
    Travel right(pro, kVelRight);
    const std::size_t imu_steps = (imu.row_count() - 1) / kTicksPerStep;
    for (std::size_t step = 1; step <= imu_steps && pro.row_count() >= 2; ++step) {
        const double time_s = static_cast<double>(step) * kStepS;
        if (time_s > pro.at(pro.row_count() - 1, kProTime)) break;
        LogStep row;
        row.time_ms = static_cast<std::uint32_t>(step) * kStepMs;
        row.inputs = absent_inputs();
        row.inputs.tick_count = static_cast<std::uint16_t>(step * kTicksPerStep);
        set_inclination(imu, step * kTicksPerStep, row.inputs);
        const std::uint16_t left_count = counter_value(left.at_m(time_s) * pulses_per_m);
        const std::uint16_t right_count = counter_value(right.at_m(time_s) * pulses_per_m);
        set_tach(row.inputs, hal::Wheel::front_left, left_count);
        set_tach(row.inputs, hal::Wheel::rear_left, left_count);
        set_tach(row.inputs, hal::Wheel::front_right, right_count);
        set_tach(row.inputs, hal::Wheel::rear_right, right_count);
        log.steps.push_back(row);
    }
    if (log.steps.empty()) {
        throw LogError(pro.row_count() < 2 ? pro.name : imu.name, {},
                       "shorter than one control step of 100 ms", "give a whole run");
    }
    return log;
}

Log import_borealtc(const std::filesystem::path& imu_path, const std::filesystem::path& pro_path) {
    return import_borealtc(read_numeric_table(imu_path, kBorealtcImuHeader),
                           read_numeric_table(pro_path, kBorealtcProHeader));
}

}  // namespace host_sim
