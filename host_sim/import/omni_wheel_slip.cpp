#include "host_sim/import/omni_wheel_slip.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "host_sim/import/board_counts.hpp"
#include "host_sim/log/log_io.hpp"

namespace host_sim {
namespace {

enum Column : std::size_t {
    kTime = 0,
    kSetX = 1,
    kSetY = 2,
    kSetRotation = 3,
    kTicks = 7,
    kXPixel = 19,
    kYPixel = 20,
    kHeading = 21
};

constexpr double kRadPerDeg = std::numbers::pi / 180;
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
/// Where the wheels stand, counter-clockwise from the robot's x axis. A wheel's forward count
/// rolls along (-sin, cos): found from the commanded motor speeds of the runs.
constexpr std::array<double, 3> kWheelAngleDeg = {60, 180, 300};

[[noreturn]] void refuse(const NumericTable& run, std::size_t row, std::string_view what,
                         std::string_view advice) {
    throw LogError(run.name, {.line = NumericTable::line(row)}, what, advice);
}

void check_command(const NumericTable& run) {
    if (std::hypot(run.at(0, kSetX), run.at(0, kSetY)) < 0.01) {
        refuse(run, 0, "the commanded speed is below 0.01 m/s", "give a driving run");
    }
    for (std::size_t row = 0; row < run.row_count(); ++row) {
        if (run.at(row, kSetRotation) != 0) {
            refuse(run, row, "the command turns: no single direction of motion",
                   "give a straight run");
        }
        if (run.at(row, kSetX) != run.at(0, kSetX) || run.at(row, kSetY) != run.at(0, kSetY)) {
            refuse(run, row, "the commanded velocity changes", "cut the run at this row");
        }
    }
}

void check_run(const NumericTable& run) {
    check_time_column(run, kTime, 1.0, 500, "ms");
    check_command(run);
    for (std::size_t row = 0; row < run.row_count(); ++row) {
        for (std::size_t motor = 0; motor < 3; ++motor) {
            const double ticks = run.at(row, kTicks + motor);
            if (ticks != std::floor(ticks) || std::abs(ticks) > 1e9) {
                refuse(run, row, fmt::format("m{}_ticks {} is not a count", motor + 1, ticks),
                       "repair or drop the run");
            }
            const double before = run.at(row == 0 ? 0 : row - 1, kTicks + motor);
            if (std::abs(ticks - before) > 100000) {
                refuse(run, row, fmt::format("m{}_ticks jumps by {}", motor + 1, ticks - before),
                       "the encoder was reset: cut the run at this row");
            }
        }
    }
    check_magnitude(run, kXPixel, 1e5, "camera x");
    check_magnitude(run, kYPixel, 1e5, "camera y");
    check_magnitude(run, kHeading, 1e5, "camera heading");
}

/// Weights that make the three encoders' ticks into rim travel along a direction, in ticks: least
/// squares, so that turning on the spot adds nothing.
std::array<double, 3> projection_weights(double direction_deg) {
    std::array<double, 3> weight{};
    for (std::size_t motor = 0; motor < 3; ++motor) {
        weight[motor] = -std::sin((kWheelAngleDeg[motor] - direction_deg) * kRadPerDeg) * 2 / 3;
    }
    return weight;
}

double weighted(const std::array<double, 3>& weight, const std::array<double, 3>& ticks) {
    return weight[0] * ticks[0] + weight[1] * ticks[1] + weight[2] * ticks[2];
}

/// Values of the run between its rows, taken as linear. Times must not decrease.
class Between {
public:
    explicit Between(const NumericTable& run) : run_(run) {}

    /// False: the run has ended before this time. A time before the first row counts as the first
    /// row's; that row is within 1 ms of the start.
    bool move_to(double time_ms) {
        while (row_ + 1 < run_.row_count() && run_.at(row_ + 1, kTime) <= time_ms) ++row_;
        const double since_ms = std::max(0.0, time_ms - run_.at(row_, kTime));
        if (row_ + 1 == run_.row_count()) {
            share_ = 0;
            return since_ms == 0;
        }
        share_ = since_ms / (run_.at(row_ + 1, kTime) - run_.at(row_, kTime));
        return true;
    }

    template <class ValueOfRow>
    double value(const ValueOfRow& of_row) const {
        const double here = of_row(row_);
        return share_ == 0 ? here : here + (of_row(row_ + 1) - here) * share_;
    }

private:
    const NumericTable& run_;
    std::size_t row_ = 0;
    double share_ = 0;
};

/// Distance along the commanded direction of the body since the first row, row by row. The pixel
/// axes are right and down; heading 0 is up, counter-clockwise positive.
std::vector<double> camera_track_mm(const NumericTable& run, double direction_deg) {
    std::vector<double> track_mm = {0};
    for (std::size_t row = 1; row < run.row_count(); ++row) {
        const double angle = (run.at(row, kHeading) + direction_deg) * kRadPerDeg;
        const double right_px = run.at(row, kXPixel) - run.at(row - 1, kXPixel);
        const double down_px = run.at(row, kYPixel) - run.at(row - 1, kYPixel);
        const double advance_px = -right_px * std::sin(angle) - down_px * std::cos(angle);
        track_mm.push_back(track_mm.back() + advance_px * kOmniCameraMmPerPixel);
    }
    return track_mm;
}

/// Slip of each step over the shortest stretch of at least 60 mm of odometry that ends with it.
void set_slip(Log& log, const std::vector<double>& odometry_mm) {
    std::size_t start = 0;
    for (std::size_t step = 0; step < log.steps.size(); ++step) {
        Truth& truth = *log.steps[step].truth;
        while (start < step && odometry_mm[step] - odometry_mm[start + 1] >= kOmniSlipWindowMm) {
            ++start;
        }
        const double driven_mm = odometry_mm[step] - odometry_mm[start];
        if (driven_mm < kOmniSlipWindowMm) continue;
        truth.slip = 1 - (truth.position_mm - log.steps[start].truth->position_mm) / driven_mm;
    }
}

LogHead make_head(const NumericTable& run, double direction_deg, const OmniMapping& mapping) {
    LogHead head;
    head.vehicle = "name = \"Festo Robotino 2\"\n";
    head.calibration = wheel_calibration(mapping.wheel_radius_mm);
    head.notes["source"] =
        fmt::format("omni-wheel slip, {}", std::filesystem::path(run.name).filename().string());
    head.notes["vehicle"] = "Festo Robotino 2: three omni wheels, flat floor, no suspension";
    // To [0, 360) without "-0" or "360" from a command that is a rounding error off an axis.
    const double direction_in_turn_deg = std::fmod(std::round(direction_deg * 10) / 10 + 360, 360);
    head.notes["command"] =
        fmt::format("{:.3f} m/s at {:.1f} deg from the robot's x axis",
                    std::hypot(run.at(0, kSetX), run.at(0, kSetY)), direction_in_turn_deg);
    head.notes["tachometers"] =
        mapping.channels.size() == 2
            ? "two encoders, every 16th tick; radius is 40 mm / cos 30 deg, along the motion"
            : "one channel: the three encoders projected on the motion, every 16th tick";
    head.notes["truth"] = "overhead camera: position along the commanded direction, and slip";
    head.notes["absent"] = "suspension, inclinometer, range, steering, gyro, motor current";
    return head;
}

LogStep make_step(std::size_t index, const OmniMapping& mapping, const std::array<double, 3>& ticks,
                  double position_mm) {
    LogStep step;
    step.time_ms = static_cast<std::uint32_t>(index) * kStepMs;
    step.inputs = absent_inputs();
    step.inputs.tick_count = static_cast<std::uint16_t>(index * kTicksPerStep);
    for (const OmniMapping::Channel& channel : mapping.channels) {
        const double forward = weighted(channel.ticks_forward, ticks);
        set_tach(step.inputs, channel.wheel, counter_value(forward / kOmniPrescale));
    }
    step.truth = Truth{position_mm, kNaN, kNaN, kNaN, kNaN, kNaN};
    return step;
}

}  // namespace

OmniMapping omni_mapping(double direction_deg) {
    const bool between_wheels = std::abs(std::remainder(direction_deg, 60.0)) < 0.5;
    OmniMapping mapping;
    mapping.wheel_radius_mm =
        between_wheels ? kOmniWheelRadiusMm / std::cos(30 * kRadPerDeg) : kOmniWheelRadiusMm;
    if (!between_wheels) {
        mapping.channels = {{hal::Wheel::middle_left, projection_weights(direction_deg)}};
        return mapping;
    }
    for (std::size_t motor = 0; motor < 3; ++motor) {
        // Seen from the direction of motion: (0, 180) deg is the left side, |.| < 90 deg the front.
        const double side_deg = std::remainder(kWheelAngleDeg[motor] - direction_deg, 360.0);
        if (std::abs(std::sin(side_deg * kRadPerDeg)) < 0.5) continue;  // rolls across the motion
        const bool left = side_deg > 0;
        const bool front = std::abs(side_deg) < 90;
        using enum hal::Wheel;
        OmniMapping::Channel channel = {
            front ? (left ? front_left : front_right) : (left ? rear_left : rear_right), {}};
        channel.ticks_forward[motor] = left ? -1 : 1;
        mapping.channels.push_back(channel);
    }
    return mapping;
}

Log import_omni(const NumericTable& run) {
    check_run(run);
    const double direction_deg = std::atan2(run.at(0, kSetY), run.at(0, kSetX)) / kRadPerDeg;
    const OmniMapping mapping = omni_mapping(direction_deg);
    const std::array<double, 3> weight = projection_weights(direction_deg);
    const double mm_per_tick = 2 * std::numbers::pi * kOmniWheelRadiusMm / kOmniTicksPerTurn;
    const std::vector<double> track_mm = camera_track_mm(run, direction_deg);

    Log log;
    log.head = make_head(run, direction_deg, mapping);
    std::vector<double> odometry_mm;
    Between at(run);
    for (std::size_t step = 0; at.move_to(static_cast<double>(step * kStepMs)); ++step) {
        std::array<double, 3> ticks{};
        for (std::size_t motor = 0; motor < 3; ++motor) {
            ticks[motor] = at.value([&](std::size_t row) { return run.at(row, kTicks + motor); });
        }
        odometry_mm.push_back(mm_per_tick * weighted(weight, ticks));
        const double position_mm = at.value([&](std::size_t row) { return track_mm[row]; });
        log.steps.push_back(make_step(step, mapping, ticks, position_mm));
    }
    set_slip(log, odometry_mm);
    return log;
}

Log import_omni(const std::filesystem::path& path) {
    return import_omni(read_numeric_table(path, kOmniHeader));
}

}  // namespace host_sim
