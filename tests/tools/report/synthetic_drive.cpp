#include "synthetic_drive.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace report_test {
namespace {

constexpr double kLengthMm = 62500.0;
constexpr double kWheelbaseMm = 500.0;

double ground_mm(double x_mm) {
    return 90.0 * std::sin(x_mm / 5200.0) + 35.0 * std::sin(x_mm / 1700.0 + 1.0) +
           14.0 * std::sin(x_mm / 410.0 + 2.0) + 4.0 * std::sin(x_mm / 97.0);
}

double bump(double x_mm, double from_mm, double to_mm) {
    if (x_mm < from_mm || x_mm > to_mm) return 0;
    return std::sin(std::numbers::pi * (x_mm - from_mm) / (to_mm - from_mm));
}

double sinkage_mm(double x_mm) {
    return 6.0 + 3.0 * std::sin(x_mm / 1300.0) + 14.0 * bump(x_mm, 19000, 24000) +
           34.0 * bump(x_mm, 39000, 43000);
}

double slip_at(double x_mm) {
    return 0.15 + 0.04 * std::sin(x_mm / 2100.0) + 0.55 * bump(x_mm, 19000, 24000) +
           0.1 * bump(x_mm, 39000, 43000);
}

/// A repeatable number in [-1, 1) without a generator: good enough for the eye.
double jitter(std::size_t step, unsigned channel) {
    auto mixed = static_cast<std::uint32_t>(step) * 2654435761u + channel * 40503u;
    mixed ^= mixed >> 15;
    mixed *= 2246822519u;
    mixed ^= mixed >> 13;
    return mixed / 2147483648.0 - 1.0;
}

std::int16_t q4(double value_mm) {
    return static_cast<std::int16_t>(std::lround(16.0 * value_mm));
}
std::int16_t brad(double angle_rad) {
    return static_cast<std::int16_t>(std::lround(angle_rad * 65536.0 / (2.0 * std::numbers::pi)));
}

void set_inputs(std::size_t step, double wheel_mm, const hal::Calibration& calibration,
                hal::RawInputs& inputs) {
    inputs.tick_count = static_cast<std::uint16_t>(10 * step);
    for (auto& count : inputs.adc_q4_count) count = 32760;
    const auto pulses =
        static_cast<long long>(wheel_mm * 65536.0 / calibration.tach_q16_mm_per_count);
    for (auto& count : inputs.tach_count) count = static_cast<std::uint16_t>(pulses);
    inputs.tach_present = 0x3F;
    inputs.range_scan_count = static_cast<std::uint8_t>(step);
    inputs.range_present = 0x03;
}

host_sim::Truth truth_at(double x_mm) {
    host_sim::Truth truth;
    const double front_mm = x_mm + kWheelbaseMm;
    truth.position_mm = x_mm;
    truth.surface_rear_mm = ground_mm(x_mm) - sinkage_mm(x_mm);
    truth.surface_front_mm = ground_mm(front_mm) - sinkage_mm(front_mm);
    truth.ground_front_mm = ground_mm(front_mm);
    truth.sinkage_mm = sinkage_mm(front_mm);
    truth.slip = slip_at(x_mm);
    return truth;
}

rover::Estimates estimates_at(std::size_t step, std::size_t step_count,
                              const host_sim::Truth& truth, double wheel_mm) {
    using namespace rover;
    const double x_mm = truth.position_mm;
    Estimates e;
    e.step_count = static_cast<std::uint16_t>(step);
    e.cycle_count = static_cast<std::uint16_t>(wheel_mm / 60.0);
    e.available = kAvailableOdometry | kAvailableAttitude;
    if (x_mm > 500)
        e.available |= kAvailableLinkage | kAvailableSlip | kAvailableLookAhead | kAvailableSinkage;
    e.mode = x_mm > 500 ? SlipMode::tracking : SlipMode::odometry_only;
    const double drift_mm = 0.0017 * x_mm + 30.0 * std::sin(x_mm / 3000.0) * x_mm / kLengthMm;
    e.position_q4_mm = static_cast<std::int32_t>(16.0 * (x_mm + drift_mm));
    e.odometer_q4_mm = static_cast<std::int32_t>(16.0 * wheel_mm);
    e.position_sigma_q4_mm = static_cast<std::uint16_t>(16.0 * (4.0 + 0.6 * std::sqrt(x_mm)));
    e.slip_percent = static_cast<std::int8_t>(100.0 * truth.slip + 4.0 * jitter(step / 60, 1));
    e.sinkage_q4_mm = q4(std::max(0.0, truth.sinkage_mm + 2.5 * jitter(step / 60, 2)));
    const double pitch_rad = (truth.surface_front_mm - truth.surface_rear_mm) / kWheelbaseMm;
    e.pitch_brad = brad(pitch_rad + 0.002 * jitter(step, 3));
    e.roll_brad = brad(0.05 * std::sin(x_mm / 4000.0));
    e.rocker_brad = brad(0.9 * pitch_rad);
    e.bogie_brad = brad(1.3 * pitch_rad + 0.05 * std::sin(x_mm / 300.0));
    e.height_middle_q4_mm = q4(ground_mm(x_mm + 250) - ground_mm(x_mm));
    e.height_front_q4_mm = q4(truth.surface_front_mm - truth.surface_rear_mm);
    e.height_ahead_q4_mm[0] = q4(ground_mm(x_mm + 600) - ground_mm(x_mm) + 2 * jitter(step, 4));
    e.height_ahead_q4_mm[1] = q4(ground_mm(x_mm + 800) - ground_mm(x_mm) + 2 * jitter(step, 5));
    if (x_mm > 20000 && x_mm < 23000) {
        e.events |= kEventSlipAlarm;
        if (x_mm < 22000) e.mode = SlipMode::reacquiring;
    }
    if (x_mm > 40000 && x_mm < 42000) e.events |= kEventSinkageAlarm;
    if (step == step_count * 4 / 5) e.events |= kEventSlipAlarm | kEventTickGap;
    if (step == step_count / 3) e.events |= kEventLostLock;
    return e;
}

}  // namespace

host_sim::Log full_drive(std::size_t step_count) {
    host_sim::Log log;
    log.head.vehicle = "name = \"Rocky 3.2\"\nwheel_diameter_cm = 13.0\nwheelbase_cm = 50.0\n";
    log.head.image_identity = "0.1.0 (host build)";
    log.head.notes = {{"source", "synthetic drive of the report's test"},
                      {"seed", "none: formulas only"},
                      {"terrain", "four sines, two soft patches"},
                      {"seams", "none"}};
    log.steps.resize(step_count);
    double wheel_mm = 0;
    double before_mm = 0;
    for (std::size_t step = 0; step < step_count; ++step) {
        const double x_mm =
            kLengthMm * static_cast<double>(step) / static_cast<double>(step_count - 1);
        wheel_mm += (x_mm - before_mm) / (1.0 - slip_at(x_mm));
        before_mm = x_mm;
        host_sim::LogStep& row = log.steps[step];
        row.time_ms = static_cast<std::uint32_t>(100 * step);
        set_inputs(step, wheel_mm, log.head.calibration, row.inputs);
        row.truth = truth_at(x_mm);
        row.estimates = estimates_at(step, step_count, *row.truth, wheel_mm);
        if (x_mm > 30000 && x_mm < 31500) {
            row.inputs.range_present = 0;
            row.estimates->faults |= rover::kFaultRangeStale;
            row.estimates->available &=
                static_cast<std::uint8_t>(~(rover::kAvailableLookAhead | rover::kAvailableSinkage));
        }
        if (x_mm > 55000) {
            row.inputs.adc_q4_count[1] = hal::kAdcAbsent;
            row.estimates->faults |= rover::kFaultBogieRight;
        }
    }
    return log;
}

host_sim::Log bare_drive(std::size_t step_count) {
    host_sim::Log log;
    log.head.vehicle = "name = \"Two-wheel robot\"\n";
    log.head.image_identity = "0.1.0 (host build)";
    log.head.notes = {{"source", "synthetic drive without suspension"}};
    log.steps.resize(step_count);
    for (std::size_t step = 0; step < step_count; ++step) {
        host_sim::LogStep& row = log.steps[step];
        row.time_ms = static_cast<std::uint32_t>(100 * step);
        const double wheel_mm = 30.0 * static_cast<double>(step);
        set_inputs(step, wheel_mm, log.head.calibration, row.inputs);
        row.inputs.tach_present = 0x03;
        row.inputs.range_present = 0;
        for (unsigned channel = 0; channel < 3; ++channel) {
            row.inputs.adc_q4_count[channel] = hal::kAdcAbsent;
        }
        rover::Estimates e;
        e.available = rover::kAvailableOdometry | rover::kAvailableAttitude;
        e.position_q4_mm = e.odometer_q4_mm = static_cast<std::int32_t>(16.0 * wheel_mm);
        e.faults = rover::kFaultBogieLeft | rover::kFaultBogieRight | rover::kFaultDifferential |
                   rover::kFaultRangeStale;
        e.pitch_brad = brad(0.1 * std::sin(static_cast<double>(step) / 90.0));
        e.roll_brad = brad(0.05 * std::cos(static_cast<double>(step) / 130.0));
        row.estimates = e;
    }
    return log;
}

}  // namespace report_test
