// controller.hpp - the 10 Hz control step: RawInputs in, Commands out, one state.
// Depends on   firmware/inputs, firmware/estimation, firmware/link; hal/io.hpp.
// Flow         inputs -> angles, odometer -> linkage -> slip and sinkage -> estimates -> commands.
// Parts        controller_state.hpp (state, reset), cycle.hpp (when and how a cycle runs),
//              reporting.hpp (estimates and commands).
// Bounds       one part of a slip-and-sinkage cycle a step; no heap, no recursion, no globals.
// Design note  docs/design/controller.md     Tests  tests/firmware/executive/controller_test.cpp
#pragma once

#include "firmware/executive/cycle.hpp"
#include "firmware/link/telemetry.hpp"

namespace rover {

/// One control step, every 100 ms. Telemetry is what controller.estimates is then.
/// @param controller  changed in place; controller_reset() before the first step
/// @param inputs      any values
/// @param commands    what the vehicle is to do until the next step, but for telemetry
/// @context           main line; not re-entrant
constexpr void control_step(Controller& controller, const hal::RawInputs& inputs,
                            hal::Commands& commands) {
    using namespace executive;
    Estimates& estimates = controller.estimates;
    const bool first = !controller.started;
    begin_step(controller, inputs);
    Angles& angles = controller.angles;
    read_angles(inputs, controller.calibration, controller.stuck, angles);
    estimates.faults = bit_or(estimates.faults, widen_u16(angles.faults));
    LinkagePose& pose = controller.pose;
    linkage_pose(angles, pose);
    OdometerStep& travel = controller.travel;
    odometer_step(controller.odometer, inputs, controller.calibration, travel);
    controller.since_cycle_q4_mm = add_wrap(controller.since_cycle_q4_mm, travel.travel_q4_mm);
    controller.past_due_q4_mm = add_wrap(controller.past_due_q4_mm, travel.travel_q4_mm);
    if (travel.valid) set_available(estimates, kAvailableOdometry);
    if (abs_u16(travel.travel_q4_mm) > kOverspeedQ4Mm) {
        set_event(estimates, kEventOverspeed);
    }
    // Samples lie ahead of the left wheels.
    const bool looks_ahead = watch_scan(controller.scan, inputs) && pose.side == Side::left;
    if (looks_ahead) set_available(estimates, kAvailableLookAhead);
    if (controller.scan.age_steps == kScanStaleSteps) set_fault(estimates, kFaultRangeStale);
    report_attitude(estimates, angles, pose);
    if (first) {
        take_position(controller);
        report_cycle(controller);
    }
    cycle_step(controller, inputs, looks_ahead);
    estimates.faults = bit_or(estimates.faults, controller.sensor_faults);
    if (estimates.faults != 0) set_event(estimates, kEventSensorFault);
    report_map(controller);
    command(estimates, commands);
}

/// The same with the telemetry frame, whose bytes behind telemetry_size stay as they were.
constexpr void controller_step(Controller& controller, const hal::RawInputs& inputs,
                               hal::Commands& commands) {
    control_step(controller, inputs, commands);
    commands.telemetry_size = write_telemetry(controller.estimates, commands.telemetry);
}

/// The same, with what it returns all new.
constexpr hal::Commands controller_step(Controller& controller, const hal::RawInputs& inputs) {
    hal::Commands commands;
    controller_step(controller, inputs, commands);
    return commands;
}

}  // namespace rover
