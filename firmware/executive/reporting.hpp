// reporting.hpp - what the controller knows, put into estimates and commands.
// Depends on   executive/controller_state.hpp, estimation/map_grid.hpp, hal/io.hpp.
// Bounds       no loop but the six wheels.
// Design note  docs/design/controller.md     Tests  tests/firmware/executive/reporting_test.cpp
#pragma once

#include "firmware/estimation/map_grid.hpp"
#include "firmware/executive/controller_state.hpp"
#include "hal/io.hpp"

namespace rover::executive {

constexpr void set_event(Estimates& estimates, Event event) {
    estimates.events = bit_or(estimates.events, static_cast<uint8_t>(event));
}
constexpr void set_available(Estimates& estimates, Available available) {
    estimates.available = bit_or(estimates.available, static_cast<uint8_t>(available));
}
constexpr void set_fault(Estimates& estimates, Fault fault) {
    estimates.faults = bit_or(estimates.faults, static_cast<uint16_t>(fault));
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
    }
    controller.started = true;
    estimates.tick_count = inputs.tick_count;
}

/// What the vehicle is taken to have advanced in a rim travel: the learned share forward, all of it
/// backwards. The same in s16 Q4 mm and s16 1/64 bin; rounded down, one LSB at most from the share.
[[gnu::noinline]] constexpr int16_t learned_advance(const Controller& controller,
                                                    int16_t rim_travel) {
    if (rim_travel <= 0) return rim_travel;
    const uint16_t twice = shift_left_wrap<1>(narrow_wrap_u16(rim_travel));
    return narrow_wrap_s16(narrow_wrap_u16(shift_floor<16>(mul_wide(twice, controller.share_q15))));
}

/// 1/64 bin to mm Q4, rounded towards zero. Less than 5 m either way: a cycle's odometry is cut at
/// one.
constexpr int16_t advance_q4_mm(int16_t q6_bin) {
    const uint16_t size = q4_mm_from_q6_bin(abs_u16(q6_bin));
    return q6_bin < 0 ? neg_wrap(narrow_wrap_s16(size)) : narrow_wrap_s16(size);
}

/// Takes over the estimator's position.
[[gnu::noinline]] constexpr void take_position(Controller& controller) {
    // 1/64 bin is 25/4 units of 1/16 mm, rounded down.
    const S32 twice = shift_left_wrap<1>(controller.map.travelled_q6_bin);
    controller.cycle_position_q4_mm = add_wrap(add_wrap(twice, shift_left_wrap<1>(twice)),
                                               shift_floor<2>(controller.map.travelled_q6_bin));
}

/// What only a cycle changes, but the position: copies what the estimator knows into the estimates.
[[gnu::noinline]] constexpr void report_cycle(Controller& controller) {
    Estimates& estimates = controller.estimates;
    const MapGrid& map = controller.map;
    estimates.mode = map.mode;
    controller.share_q15 = slip::learned_share_q15(map);
    estimates.position_sigma_q4_mm = position_sigma_q4_mm(map);
    estimates.advance_q4_mm = advance_q4_mm(map.advance_q6_bin);
    estimates.slip_percent = slip::slip_percent(controller.share_q15);
    estimates.match_cost_q4 = shift_floor<6>(map.match_cost_q10);
    estimates.sinkage_q4_mm = map.sinkage_q4_mm;
}

/// Position, and what the estimates of this step are worth. Without linkage in this step, slip and
/// sinkage count as not available and raise no alarm: nothing would ever take it back.
[[gnu::noinline]] constexpr void report_map(Controller& controller) {
    Estimates& estimates = controller.estimates;
    const MapGrid& map = controller.map;
    // Between cycles the position runs on with the learned share of the odometer.
    estimates.position_q4_mm =
        add_wrap(controller.cycle_position_q4_mm,
                 widen_s32(learned_advance(controller, controller.since_cycle_q4_mm)));
    estimates.odometer_q4_mm = controller.odometer.travel_q4_mm;
    if (bit_and(estimates.available, uint8_t{kAvailableLinkage}) == 0) return;
    // Backwards no new ground is felt: the sinkage would be that of another place.
    const bool sinkage = map.sinkage_valid && map.mode != SlipMode::reversing;
    if (map.has_map && map.measured) set_available(estimates, kAvailableSlip);
    if (sinkage) set_available(estimates, kAvailableSinkage);
    if (map.slip_alarm) set_event(estimates, kEventSlipAlarm);
    if (sinkage && map.sinkage_alarm) set_event(estimates, kEventSinkageAlarm);
}

/// Angles and linkage into the estimates.
constexpr void report_attitude(Estimates& estimates, const Angles& angles,
                               const LinkagePose& pose) {
    using enum hal::AngleChannel;
    estimates.pitch_brad = angles[pitch];
    estimates.roll_brad = angles[roll];
    if (angles.has(pitch) && angles.has(roll)) set_available(estimates, kAvailableAttitude);
    estimates.rocker_brad = pose.rocker_brad;
    estimates.bogie_brad = pose.bogie_brad;
    estimates.height_middle_q4_mm = pose.middle_height_q4_mm;
    estimates.height_front_q4_mm = pose.front_height_q4_mm;
    if (pose.side != Side::none) set_available(estimates, kAvailableLinkage);
}

/// Drive ahead; slower while an alarm is up. Steering, mast and lasers are left as they are:
/// nothing commands them yet.
constexpr void command(const Estimates& estimates, hal::Commands& commands) {
    const uint8_t alarms = static_cast<uint8_t>(kEventSlipAlarm | kEventSinkageAlarm);
    const bool caution = bit_and(estimates.events, alarms) != 0;
    const int8_t percent = caution ? kCautionPercent : kCruisePercent;
    for (int8_t& drive : commands.drive_percent) drive = percent;
}

}  // namespace rover::executive
