// controller.hpp - the 10 Hz control step: RawInputs in, Commands out, one state.
// Depends on   firmware/inputs, firmware/estimation, firmware/link; hal/io.hpp.
// Flow         inputs -> angles, odometer -> linkage -> slip and sinkage -> estimates -> commands.
// Bounds       at most one slip-and-sinkage cycle a step; no heap, no recursion, no globals.
// Design note  docs/design/controller.md     Tests  tests/firmware/executive/controller_test.cpp
#pragma once

#include "firmware/estimation/map_grid.hpp"
#include "firmware/executive/estimates.hpp"
#include "firmware/inputs/angles.hpp"
#include "firmware/inputs/linkage.hpp"
#include "firmware/inputs/odometer.hpp"
#include "firmware/link/telemetry.hpp"
#include "hal/calibration.hpp"
#include "hal/io.hpp"

namespace rover {

/// Range scans as they arrive.
struct ScanWatch {
    uint8_t last_scan_count = 0;
    uint8_t age_steps = kScanStaleSteps;  ///< since the last new scan, saturating at the limit
    bool seen = false;                    ///< a scan has ever arrived
};

/// Everything the controller remembers.
struct Controller {
    hal::Calibration calibration;
    uint16_t calibration_fault = 0;  ///< kFaultCalibration when nominal values are in use
    Estimates estimates;
    StuckWatch stuck;
    Odometer odometer;
    ScanWatch scan;
    MapGrid map;
    bool started = false;
    uint16_t sensor_faults = 0;      ///< tachometer fault of the last cycle
    int32_t cycle_travel_q4_mm = 0;  ///< odometer at which the next forward cycle is due
    int32_t last_travel_q4_mm = 0;   ///< odometer at the last cycle
    int32_t last_turn_q4_mm = 0;
    int16_t odometer_rest_q6 = 0;  ///< remainder of the conversion to 1/64 bin, [0, 24]
    Side side = Side::none;        ///< side whose linkage made the map
    bool resting = false;
    int16_t rest_middle_q4_mm = 0, rest_front_q4_mm = 0;  ///< heights when the wheels stopped
};

/// Can the record be used? Its version is known and no value makes a computation meaningless.
constexpr bool is_valid(const hal::Calibration& calibration) {
    return calibration.version == hal::kCalibrationVersion &&
           calibration.tach_q16_mm_per_count != 0 && calibration.tach_counts_per_turn != 0 &&
           calibration.wheel_radius_q4_mm != 0;
}

/// Puts the controller into its state after reset. A calibration record that is not valid is
/// replaced by the nominal one and reported as kFaultCalibration in every step.
constexpr void controller_reset(Controller& controller, const hal::Calibration& calibration) {
    controller = Controller{};
    if (is_valid(calibration)) {
        controller.calibration = calibration;
    } else {
        controller.calibration_fault = kFaultCalibration;
    }
}

namespace executive {

constexpr void set_event(Estimates& estimates, Event event) {
    estimates.events = bit_or(estimates.events, static_cast<uint8_t>(event));
}
constexpr void set_available(Estimates& estimates, Available available) {
    estimates.available = bit_or(estimates.available, static_cast<uint8_t>(available));
}
constexpr void set_fault(Estimates& estimates, Fault fault) {
    estimates.faults = bit_or(estimates.faults, static_cast<uint16_t>(fault));
}

/// Counts scans; true while the last one is fresh enough to use.
constexpr bool watch_scan(ScanWatch& scan, const hal::RawInputs& inputs) {
    const bool present = inputs.range_present != 0;
    const bool is_new = present && (!scan.seen || inputs.range_scan_count != scan.last_scan_count);
    if (is_new) {
        scan.seen = true;
        scan.age_steps = 0;
    } else if (scan.age_steps < kScanStaleSteps) {
        ++scan.age_steps;
    }
    scan.last_scan_count = inputs.range_scan_count;
    return present && scan.seen && scan.age_steps <= kScanFreshSteps;
}

/// Fills in the look-ahead part of a cycle's input and of the estimates.
constexpr void add_look_ahead(Controller& controller, const hal::RawInputs& inputs,
                              const LinkagePose& pose, int16_t pitch_brad, MapGridInput& input) {
    for (uint8_t i = 0; i < vehicle::kLookAheadCount; ++i) {
        if (bit_and(shift_floor(inputs.range_present, i), uint8_t{1}) == 0) continue;
        const int16_t range_q1_mm =
            sub_sat(inputs.range_q1_mm[i], controller.calibration.range_offset_q1_mm);
        const GroundPoint point = ground_point(pose, pitch_brad, i, range_q1_mm,
                                               controller.calibration.wheel_radius_q4_mm);
        input.ahead_height_q4_mm[input.ahead_count] = point.height_q4_mm;
        input.ahead_distance_q6_bin[input.ahead_count] = point.distance_q6_bin;
        ++input.ahead_count;
        controller.estimates.height_ahead_q4_mm[i] = point.height_q4_mm;
    }
}

/// Rim travel since the last cycle in 1/64 bin; the remainder is carried to the next.
constexpr int16_t cycle_odometer_q6_bin(Controller& controller) {
    const int32_t travel_q4_mm =
        sub_wrap(controller.odometer.travel_q4_mm, controller.last_travel_q4_mm);
    controller.last_travel_q4_mm = controller.odometer.travel_q4_mm;
    const int32_t scaled =
        add_wrap(shift_left_wrap<2>(travel_q4_mm), widen_s32(controller.odometer_rest_q6));
    const int32_t whole = div_floor(scaled, int32_t{25});
    controller.odometer_rest_q6 = narrow_wrap_s16(sub_wrap(scaled, mul_wrap(whole, int32_t{25})));
    return narrow_sat_s16(whole);
}

/// Which cycle, if any, is due after this step's odometry?
constexpr bool cycle_due(const Controller& controller, CycleMotion& motion) {
    const int32_t since = sub_wrap(controller.odometer.travel_q4_mm, controller.cycle_travel_q4_mm);
    if (since >= 0) {
        motion = CycleMotion::forward;
        return true;
    }
    if (since <= -2 * int32_t{kCycleTravelQ4Mm}) {
        motion = CycleMotion::reverse;
        return true;
    }
    const int32_t turn = sub_wrap(controller.odometer.turn_q4_mm, controller.last_turn_q4_mm);
    motion = CycleMotion::turn;
    return abs_u32(turn) >= uint32_t{kCycleTravelQ4Mm};
}

/// Has somebody moved the vehicle while its wheels stood still?
constexpr bool moved_at_rest(Controller& controller, const LinkagePose& pose, bool moving) {
    if (moving || pose.side == Side::none || pose.side != controller.side) {
        controller.resting = false;
        return false;
    }
    if (!controller.resting) {
        controller.resting = true;
        controller.rest_middle_q4_mm = pose.middle_height_q4_mm;
        controller.rest_front_q4_mm = pose.front_height_q4_mm;
        return false;
    }
    const bool moved =
        abs_u16(sub_sat(pose.middle_height_q4_mm, controller.rest_middle_q4_mm)) > kMovedQ4Mm ||
        abs_u16(sub_sat(pose.front_height_q4_mm, controller.rest_front_q4_mm)) > kMovedQ4Mm;
    if (moved) controller.resting = false;
    return moved;
}

/// Runs one slip-and-sinkage cycle.
constexpr void run_cycle(Controller& controller, const hal::RawInputs& inputs,
                         const LinkagePose& pose, int16_t pitch_brad, bool scan_fresh,
                         CycleMotion motion) {
    Estimates& estimates = controller.estimates;
    MapGridInput input;
    input.motion = motion;
    input.odometer_q6_bin = cycle_odometer_q6_bin(controller);
    controller.cycle_travel_q4_mm =
        motion == CycleMotion::forward
            ? add_wrap(controller.cycle_travel_q4_mm, int32_t{kCycleTravelQ4Mm})
            : add_wrap(controller.odometer.travel_q4_mm, int32_t{kCycleTravelQ4Mm});
    if (controller.odometer.travel_q4_mm >= controller.cycle_travel_q4_mm) {
        set_event(estimates, kEventOverspeed);  // more than a cycle in one step
        controller.cycle_travel_q4_mm =
            add_wrap(controller.odometer.travel_q4_mm, int32_t{kCycleTravelQ4Mm});
    }
    controller.last_turn_q4_mm = controller.odometer.turn_q4_mm;
    if (pose.side != Side::none) {
        // A map made by one side says nothing about the ground of the other.
        if (controller.side != Side::none && controller.side != pose.side) {
            slip::drop_map(controller.map);
        }
        controller.side = pose.side;
        input.linkage = true;
        input.middle_height_q4_mm = pose.middle_height_q4_mm;
        input.front_height_q4_mm = pose.front_height_q4_mm;
        input.middle_distance_q6_bin = pose.middle_distance_q6_bin;
        input.front_distance_q6_bin = pose.front_distance_q6_bin;
        if (scan_fresh) add_look_ahead(controller, inputs, pose, pitch_brad, input);
    }
    map_grid_step(controller.map, input);
    if (motion != CycleMotion::moved) {
        watch_cycle(controller.stuck, inputs);
        const bool disagree =
            tachometers_disagree(controller.odometer, inputs.tach_present, controller.calibration);
        controller.sensor_faults = disagree ? uint16_t{kFaultTachometer} : uint16_t{0};
    }
    estimates.cycle_count = add_wrap(estimates.cycle_count, uint16_t{1});
    set_event(estimates, kEventCycle);
    if (controller.map.lost_lock) set_event(estimates, kEventLostLock);
}

/// 1/64 bin to mm Q4: times 25/4, rounded down.
constexpr int32_t q4_mm_from_q6_bin(int32_t value) {
    return shift_floor<2>(mul_wrap(value, int32_t{25}));
}

/// Copies what the estimator knows into the estimates.
constexpr void report_map(Controller& controller, int16_t odometer_since_cycle_q4_mm) {
    Estimates& estimates = controller.estimates;
    const MapGrid& map = controller.map;
    estimates.mode = map.mode;
    // Between cycles the position runs on with the learned share of the odometer.
    const int32_t share = mul_wide(odometer_since_cycle_q4_mm, map.mean_q12_bin);
    const int16_t run_on = odometer_since_cycle_q4_mm < 0
                               ? odometer_since_cycle_q4_mm
                               : narrow_sat_s16(div_floor(share, int32_t{slip::kMeanNoSlipQ12Bin}));
    estimates.position_q4_mm = add_wrap(q4_mm_from_q6_bin(map.travelled_q6_bin), widen_s32(run_on));
    estimates.odometer_q4_mm = controller.odometer.travel_q4_mm;
    estimates.position_sigma_q4_mm = position_sigma_q4_mm(map);
    estimates.advance_q4_mm = narrow_sat_s16(q4_mm_from_q6_bin(widen_s32(map.advance_q6_bin)));
    estimates.slip_percent = slip::slip_percent(map);
    estimates.match_cost_q4 = shift_floor<6>(map.match_cost_q10);
    estimates.sinkage_q4_mm = map.sinkage_q4_mm;
    if (map.has_map && map.measured) set_available(estimates, kAvailableSlip);
    if (map.sinkage_valid) set_available(estimates, kAvailableSinkage);
    if (map.slip_alarm) set_event(estimates, kEventSlipAlarm);
    if (map.sinkage_valid && map.sinkage_alarm) set_event(estimates, kEventSinkageAlarm);
}

/// Angles and linkage into the estimates.
constexpr void report_attitude(Estimates& estimates, const Angles& angles,
                               const LinkagePose& pose) {
    const AngleReading& pitch = angles[hal::AngleChannel::pitch];
    const AngleReading& roll = angles[hal::AngleChannel::roll];
    estimates.pitch_brad = pitch.brad;
    estimates.roll_brad = roll.brad;
    if (pitch.valid && roll.valid) set_available(estimates, kAvailableAttitude);
    estimates.rocker_brad = pose.rocker_brad;
    estimates.bogie_brad = pose.bogie_brad;
    estimates.height_middle_q4_mm = pose.middle_height_q4_mm;
    estimates.height_front_q4_mm = pose.front_height_q4_mm;
    if (pose.side != Side::none) set_available(estimates, kAvailableLinkage);
}

/// Drive ahead; slower while an alarm is up. Telemetry carries all estimates.
constexpr void command(const Estimates& estimates, hal::Commands& commands) {
    const uint8_t alarms = static_cast<uint8_t>(kEventSlipAlarm | kEventSinkageAlarm);
    const bool caution = bit_and(estimates.events, alarms) != 0;
    for (int8_t& drive : commands.drive_percent) drive = caution ? kCautionPercent : kCruisePercent;
    commands.telemetry_size = write_telemetry(estimates, commands.telemetry);
}

/// Step, tick and gap bookkeeping; clears what is per step.
constexpr void begin_step(Controller& controller, const hal::RawInputs& inputs) {
    Estimates& estimates = controller.estimates;
    estimates.events = 0;
    estimates.available = 0;
    estimates.faults = controller.calibration_fault;
    if (controller.started) {
        estimates.step_count = add_wrap(estimates.step_count, uint16_t{1});
        const uint16_t passed = sub_wrap(inputs.tick_count, estimates.tick_count);
        if (passed > kTicksPerStep) set_event(estimates, kEventTickGap);
    } else {
        controller.cycle_travel_q4_mm = kCycleTravelQ4Mm;
    }
    controller.started = true;
    estimates.tick_count = inputs.tick_count;
}

}  // namespace executive

/// One control step, every 100 ms.
/// @param controller  changed in place; controller_reset() before the first step
/// @param inputs      any values
/// @return            what the vehicle is to do until the next step
/// @context           main line; not re-entrant
constexpr hal::Commands controller_step(Controller& controller, const hal::RawInputs& inputs) {
    using namespace executive;
    Estimates& estimates = controller.estimates;
    begin_step(controller, inputs);
    Angles angles;
    estimates.faults = bit_or(
        estimates.faults, read_angles(inputs, controller.calibration, controller.stuck, angles));
    const LinkagePose pose = linkage_pose(angles);
    const OdometerStep travel = odometer_step(controller.odometer, inputs, controller.calibration);
    if (travel.valid) set_available(estimates, kAvailableOdometry);
    const bool scan_fresh = watch_scan(controller.scan, inputs);
    if (scan_fresh && pose.side != Side::none) set_available(estimates, kAvailableLookAhead);
    if (controller.scan.seen && controller.scan.age_steps >= kScanStaleSteps) {
        set_fault(estimates, kFaultRangeStale);
    }
    report_attitude(estimates, angles, pose);
    CycleMotion motion = CycleMotion::moved;
    if (moved_at_rest(controller, pose, travel.moving) || cycle_due(controller, motion)) {
        run_cycle(controller, inputs, pose, angles[hal::AngleChannel::pitch].brad, scan_fresh,
                  motion);
    }
    estimates.faults = bit_or(estimates.faults, controller.sensor_faults);
    if (estimates.faults != 0) set_event(estimates, kEventSensorFault);
    report_map(controller, narrow_sat_s16(sub_wrap(controller.odometer.travel_q4_mm,
                                                   controller.last_travel_q4_mm)));
    hal::Commands commands;
    command(estimates, commands);
    return commands;
}

}  // namespace rover
