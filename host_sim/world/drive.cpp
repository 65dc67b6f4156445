// drive.cpp - order of a step: wheels, hand moves, linkage, sensors, faults.
#include "host_sim/world/drive.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace host_sim {

namespace {

constexpr double kBehindStartCm = 100.0;

bool finite_positive(double value) {
    return value > 0 && std::isfinite(value);
}

void check_ground(const DriveOptions& options, const Terrain& ground) {
    const double reach_cm = options.vehicle.rocker_cm + options.vehicle.bogie_arm_cm;
    if (options.start_cm < ground.begin_cm() ||
        options.start_cm + options.length_cm + reach_cm > ground.end_cm()) {
        throw InputError(
            "drive: the ground does not reach from the start to the front wheel at the "
            "end; shorten the course or make more ground");
    }
}

DriveOptions checked(DriveOptions options) {
    if (!finite_positive(options.vehicle.rocker_cm) ||
        !finite_positive(options.vehicle.speed_cm_per_s)) {
        throw InputError("drive: the vehicle has no description; load one");
    }
    if (!finite_positive(options.length_cm)) {
        throw InputError("drive: the length must be above 0");
    }
    if (!std::isfinite(options.start_cm)) throw InputError("drive: the start is not finite");
    if (!(options.max_time_s >= 0)) throw InputError("drive: the time limit must not be negative");
    const AdvanceModel& advance = options.advance;
    if (!std::isfinite(advance.mean_cm) || !(advance.sigma_cm >= 0) ||
        !(advance.half_width_cm >= 0)) {
        throw InputError("drive: the advance needs a finite mean and a spread not below 0");
    }
    for (const HandMove& move : options.hand_moves) {
        if (!(move.at_s >= 0) || !std::isfinite(move.by_cm)) {
            throw InputError(
                "drive: a move by hand needs a time not below 0 and a finite distance");
        }
    }
    check_ground(options, options.left.ground());
    if (options.right) check_ground(options, options.right->ground());
    if (options.max_time_s == 0) {
        options.max_time_s = 20.0 * options.length_cm / options.vehicle.speed_cm_per_s;
    }
    std::sort(options.hand_moves.begin(), options.hand_moves.end(),
              [](const HandMove& a, const HandMove& b) { return a.at_s < b.at_s; });
    return options;
}

}  // namespace

Drive::Drive(DriveOptions options)
    : options_(checked(std::move(options))),
      sensors_(options_.vehicle, options_.sensors, options_.seed),
      faults_(options_.faults, options_.vehicle, options_.seed),
      advance_random_(stream(options_.seed, "advance")) {
    state_.last_slip = std::numeric_limits<double>::quiet_NaN();
    stand();
    begin_cycle(false);
}

void Drive::begin_cycle(bool backwards) {
    const double base_cm = options_.vehicle.rocker_cm + options_.vehicle.bogie_arm_cm;
    const double slope = (backwards ? -1.0 : 1.0) * state_.left.z_front_cm / base_cm;
    cycle_advance_cm_ =
        draw_advance_cm(options_.advance, slope, state_.sinkage_front_cm, advance_random_);
    if (options_.ramp_cm > 0 && rear_x_cm() < 0) cycle_advance_cm_ = kCycleCm;
    cycle_travel_cm_ = 0;
}

void Drive::travel(double odometer_cm) {
    const double sign = odometer_cm < 0 ? -1.0 : 1.0;
    double left_cm = std::abs(odometer_cm);
    while (left_cm > 0) {
        const double part_cm = std::min(left_cm, kCycleCm - cycle_travel_cm_);
        state_.position_cm += sign * part_cm * cycle_advance_cm_ / kCycleCm;
        cycle_travel_cm_ += part_cm;
        left_cm -= part_cm;
        if (cycle_travel_cm_ < kCycleCm - 1e-9) continue;
        state_.last_slip = 1.0 - cycle_advance_cm_ / kCycleCm;
        options_.left.set_slip(state_.last_slip);
        if (options_.right) options_.right->set_slip(state_.last_slip);
        begin_cycle(sign < 0);
    }
    state_.odometer_cm += odometer_cm;
}

void Drive::turn_wheels(const hal::Commands& commands) {
    double sum_cm = 0;
    for (std::size_t wheel = 0; wheel < hal::kWheelCount; ++wheel) {
        const int percent = std::clamp<int>(commands.drive_percent[wheel], -100, 100);
        const double rim_cm = 0.01 * percent * options_.vehicle.speed_cm_per_s * kStepSeconds;
        state_.rim_travel_cm[wheel] += rim_cm;
        sum_cm += rim_cm;
    }
    travel(sum_cm / hal::kWheelCount);
}

void Drive::move_by_hand() {
    std::vector<HandMove>& moves = options_.hand_moves;
    while (next_move_ < moves.size() && moves[next_move_].at_s <= state_.time_s + 1e-9) {
        state_.position_cm += moves[next_move_].by_cm;
        // Put down, not driven: the wheels sink as at slip 0.
        options_.left.set_slip(0);
        if (options_.right) options_.right->set_slip(0);
        ++next_move_;
    }
}

void Drive::stand() {
    const LinkageGeometry geometry{options_.vehicle.rocker_cm, options_.vehicle.bogie_arm_cm};
    const double x_cm = rear_x_cm();
    Track& left = options_.left;
    const auto on_left = [&left](double at_cm) { return left.bearing_cm(at_cm); };
    state_.left = solve_linkage(geometry, on_left, x_cm, state_.left);
    state_.sinkage_front_cm = left.sinkage_cm(state_.left.x_front_cm);
    double lift_cm = 0;  // of the left body pivot above the right one
    if (options_.right) {
        Track& right = *options_.right;
        const auto on_right = [&right](double at_cm) { return right.bearing_cm(at_cm); };
        state_.right = solve_linkage(geometry, on_right, x_cm, state_.right);
        lift_cm = left.bearing_cm(x_cm) - right.bearing_cm(x_cm) +
                  options_.vehicle.body_reference_cm *
                      (std::sin(state_.left.rocker_rad) - std::sin(state_.right.rocker_rad));
        right.roll_to(state_.right.x_front_cm);
    } else {
        state_.right = state_.left;
    }
    left.roll_to(state_.left.x_front_cm);
    state_.pitch_rad = 0.5 * (state_.left.rocker_rad + state_.right.rocker_rad);
    state_.roll_rad = std::atan2(lift_cm, options_.vehicle.track_width_cm);
}

SensedState Drive::sense() const {
    SensedState sensed;
    const auto set = [&sensed](hal::AngleChannel channel, double angle_rad) {
        sensed.angle_rad[static_cast<std::size_t>(channel)] = angle_rad;
    };
    set(hal::AngleChannel::bogie_left, state_.left.bogie_rad - state_.left.rocker_rad);
    set(hal::AngleChannel::bogie_right, state_.right.bogie_rad - state_.right.rocker_rad);
    set(hal::AngleChannel::differential, 0.5 * (state_.left.rocker_rad - state_.right.rocker_rad));
    set(hal::AngleChannel::pitch, state_.pitch_rad);
    set(hal::AngleChannel::roll, state_.roll_rad);
    sensed.rim_travel_cm = state_.rim_travel_cm;

    const Vehicle& vehicle = options_.vehicle;
    const Track& left = options_.left;
    const RangeView view{rear_x_cm(),      left.bearing_cm(rear_x_cm()), state_.left.rocker_rad,
                         state_.pitch_rad, vehicle.body_reference_cm,    vehicle.wheel_radius_cm};
    const auto ground = [&left](double at_cm) { return left.ground_cm(at_cm); };
    for (std::size_t i = 0; i < vehicle.range_sample_cm.size(); ++i) {
        const double ahead_cm = vehicle.range_sample_cm[i] - vehicle.body_reference_cm;
        const RangeSight sight = look_ahead(view, ahead_cm, ground);
        if (!sight.seen || sight.x_cm > left.ground().end_cm()) continue;
        sensed.range_height_cm[i] = sight.height_cm;
        sensed.range_seen = static_cast<std::uint8_t>(sensed.range_seen | 1u << i);
    }
    return sensed;
}

Truth Drive::truth() const {
    Truth truth;
    const double front_cm = state_.left.x_front_cm;
    truth.position_mm = 10.0 * state_.position_cm;
    truth.surface_rear_mm = 10.0 * options_.left.bearing_cm(rear_x_cm());
    truth.surface_front_mm = 10.0 * options_.left.bearing_cm(front_cm);
    truth.ground_front_mm = 10.0 * options_.left.ground_cm(front_cm);
    truth.sinkage_mm = 10.0 * state_.sinkage_front_cm;
    truth.slip = state_.last_slip;
    return truth;
}

DriveStep Drive::step(const hal::Commands& commands) {
    state_.time_s = static_cast<double>(step_count_) * kStepSeconds;
    if (step_count_ > 0 && !finished()) {
        turn_wheels(commands);
        move_by_hand();
        stand();
        if (state_.position_cm >= options_.length_cm) {
            end_ = DriveEnd::reached;
        } else if (state_.position_cm < -kBehindStartCm) {
            end_ = DriveEnd::left_course;
        } else if (state_.time_s >= options_.max_time_s) {
            end_ = DriveEnd::out_of_time;
        }
    }
    ++step_count_;
    DriveStep result{sensors_.read(sense()), truth()};
    faults_.apply(state_.time_s, result.inputs);
    return result;
}

hal::Commands full_speed_ahead() {
    hal::Commands commands;
    for (std::int8_t& percent : commands.drive_percent) percent = 100;
    return commands;
}

double drivable_length_cm(const Vehicle& vehicle, const Terrain& ground, double start_cm) {
    // A body that noses up looks a little further ahead than a level one.
    const double base_cm = vehicle.rocker_cm + vehicle.bogie_arm_cm;
    const double ahead_cm =
        vehicle.range_sample_cm.empty()
            ? base_cm
            : std::max(base_cm, vehicle.range_sample_cm.back() + vehicle.wheel_radius_cm);
    return std::max(0.0, ground.end_cm() - start_cm - ahead_cm);
}

}  // namespace host_sim
