// cycle.hpp - when a slip-and-sinkage cycle is due, of which motion, and how it is run: in four
// successive steps, so that no step is much longer than the others.
// Depends on   executive/reporting.hpp (events), estimation/map_grid.hpp, firmware/inputs.
// Bounds       one part of a cycle a step; the next cycle begins behind the last part.
// Design note  docs/design/controller.md     Tests  tests/firmware/executive/cycle_test.cpp
#pragma once

#include "firmware/estimation/map_grid.hpp"
#include "firmware/executive/reporting.hpp"

namespace rover::executive {

/// The samples of a scan that this vehicle uses.
inline constexpr uint8_t kLookAheadBits = (1u << vehicle::kLookAheadCount) - 1u;

/// Counts scans; true while the last one is fresh enough to use.
constexpr bool watch_scan(ScanWatch& scan, const hal::RawInputs& inputs) {
    const bool present = bit_and(inputs.range_present, kLookAheadBits) != 0;
    const bool is_new = inputs.range_scan_count != scan.last_scan_count;
    scan.last_scan_count = inputs.range_scan_count;
    if (present && (is_new || scan.age_steps == kNoScanYet)) {
        scan.age_steps = 0;
    } else if (scan.age_steps < kScanStaleSteps) {
        ++scan.age_steps;
    }
    return present && scan.age_steps <= kScanFreshSteps;
}

/// Joins a range sample to the pose, as the next one of the begun cycle.
/// @param height_q4_mm  the same, for the estimates
[[gnu::noinline]] constexpr void add_sample(Controller& controller, const LookAhead& view,
                                            int16_t range_q1_mm, int16_t& height_q4_mm) {
    const hal::Calibration& calibration = controller.calibration;
    GroundPoint point;
    ground_point(view, sub_sat(range_q1_mm, calibration.range_offset_q1_mm),
                 calibration.wheel_radius_q4_mm, point);
    MapGridInput& input = controller.cycle;
    const uint8_t seen = bit_and(input.ahead_count, uint8_t{1});
    input.ahead_height_q4_mm[seen] = point.height_q4_mm;
    input.ahead_distance_q6_bin[seen] = point.distance_q6_bin;
    ++input.ahead_count;
    height_q4_mm = point.height_q4_mm;
}

/// Fills in the look-ahead part of the begun cycle and of the estimates.
[[gnu::noinline]] constexpr void add_look_ahead(Controller& controller,
                                                const hal::RawInputs& inputs) {
    static_assert(vehicle::kLookAheadCount == 2);
    int16_t* const height_q4_mm = controller.estimates.height_ahead_q4_mm;
    LookAhead view;
    look_ahead(controller.pose, controller.angles[hal::AngleChannel::pitch], view);
    if (bit_and(inputs.range_present, uint8_t{1}) != 0) {
        add_sample(controller, view, inputs.range_q1_mm[0], height_q4_mm[0]);
    }
    if (bit_and(inputs.range_present, uint8_t{2}) != 0) {
        look_further(view);
        add_sample(controller, view, inputs.range_q1_mm[1], height_q4_mm[1]);
    }
}

/// Rim travel since the last cycle began in 1/64 bin, rounded down; the remainder is carried to the
/// next. 1/16 mm times 4/25. More than 1 m is taken as 1 m.
[[gnu::noinline]] constexpr int16_t cycle_odometer_q6_bin(Controller& controller) {
    constexpr uint16_t kMetreQ4Mm = 16000;  // four of them fit 16 bits
    const bool back = controller.in_cycle_q4_mm < 0;
    const uint16_t way_q4_mm = min(abs_u16(controller.in_cycle_q4_mm), kMetreQ4Mm);
    const uint8_t before_q6 = controller.odometer_rest_q6;
    const uint8_t carried_q6 = back ? sub_wrap(uint8_t{24}, before_q6) : before_q6;
    const uint16_t way_q6 = add_wrap(shift_left_wrap<2>(way_q4_mm), widen_u16(carried_q6));
    // 1/25 is 2621.44 in Q16: at most one too few.
    uint16_t whole = narrow_wrap_u16(shift_floor<16>(mul_wide(way_q6, uint16_t{2621})));
    uint8_t rest_q6 =
        sub_wrap(narrow_wrap_u8(way_q6), mul_wrap(narrow_wrap_u8(whole), uint8_t{25}));
    if (rest_q6 >= 25) {
        rest_q6 = sub_wrap(rest_q6, uint8_t{25});
        whole = add_wrap(whole, uint16_t{1});
    }
    controller.odometer_rest_q6 = back ? sub_wrap(uint8_t{24}, rest_q6) : rest_q6;
    const int16_t result = narrow_wrap_s16(whole);
    return back ? neg_wrap(result) : result;
}

/// Which cycle, if any, is due after this step's odometry?
constexpr bool cycle_due(const Controller& controller, CycleMotion& motion) {
    if (controller.past_due_q4_mm >= 0) {
        motion = CycleMotion::forward;
        return true;
    }
    if (controller.past_due_q4_mm <= -2 * kCycleTravelQ4Mm) {
        motion = CycleMotion::reverse;
        return true;
    }
    motion = CycleMotion::turn;
    return abs_u16(controller.odometer.turn_q4_mm) >= uint16_t{kCycleTravelQ4Mm};
}

/// Sets when the next forward cycle is due. Forward it counts from the last due point, so that
/// cycles come every 60.0 mm on average; after a step of more than a whole cycle, and in every
/// other motion, from here.
constexpr void schedule_next(Controller& controller, CycleMotion motion) {
    int16_t past_due_q4_mm = sub_wrap(controller.past_due_q4_mm, kCycleTravelQ4Mm);
    if (motion != CycleMotion::forward || past_due_q4_mm >= 0) past_due_q4_mm = -kCycleTravelQ4Mm;
    controller.past_due_q4_mm = past_due_q4_mm;
    controller.odometer.turn_q4_mm = 0;
}

/// Are two heights more than kMovedQ4Mm apart?
constexpr bool has_moved(int16_t height_q4_mm, int16_t rest_q4_mm) {
    const uint16_t apart = narrow_wrap_u16(sub_wrap(height_q4_mm, rest_q4_mm));
    return add_wrap(apart, kMovedQ4Mm) > 2 * kMovedQ4Mm;
}

/// Has somebody moved the vehicle while its wheels stood still?
/// @pre  controller.travel is this step's
constexpr bool moved_at_rest(Controller& controller) {
    const LinkagePose& pose = controller.pose;
    if (controller.travel.moving || pose.side == Side::none || pose.side != controller.side) {
        controller.resting = false;
        return false;
    }
    if (!controller.resting) {
        controller.resting = true;
        controller.rest_middle_q4_mm = pose.middle_height_q4_mm;
        controller.rest_front_q4_mm = pose.front_height_q4_mm;
        return false;
    }
    const bool moved = has_moved(pose.middle_height_q4_mm, controller.rest_middle_q4_mm) ||
                       has_moved(pose.front_height_q4_mm, controller.rest_front_q4_mm);
    if (moved) controller.resting = false;
    return moved;
}

/// Books way that no cycle measures: before a turn or a move by hand cut it short, or beyond a
/// cycle's range. It was driven, and the position has already been reported with it.
[[gnu::noinline]] constexpr void book_unmeasured_way(Controller& controller,
                                                     int16_t odometer_q6_bin) {
    const int16_t advance = learned_advance(controller, odometer_q6_bin);
    slip::move_by(controller.map, advance);
    slip::add_odometry_doubt(controller.map, advance);
}

/// The odometry of this cycle for the estimator, 1/64 bin. What lies beyond its range is booked as
/// driven beforehand.
constexpr int16_t forward_odometer(Controller& controller, int16_t odometer_q6_bin) {
    if (odometer_q6_bin <= kCycleOdometerMaxQ6Bin) return odometer_q6_bin;
    book_unmeasured_way(controller, sub_wrap(odometer_q6_bin, kCycleOdometerMaxQ6Bin));
    return kCycleOdometerMaxQ6Bin;
}

/// First part: takes the measurements of a cycle.
/// @param looks_ahead  the samples can be joined to the pose: fresh, and ahead of the left wheels
[[gnu::noinline]] constexpr void measure_cycle(Controller& controller, const hal::RawInputs& inputs,
                                               bool looks_ahead, CycleMotion motion) {
    MapGridInput& input = controller.cycle;
    LinkagePose& pose = controller.pose;
    input.motion = motion;
    controller.in_cycle_q4_mm = controller.since_cycle_q4_mm;
    input.odometer_q6_bin = cycle_odometer_q6_bin(controller);
    schedule_next(controller, motion);
    input.ahead_count = 0;
    controller.changed_side = false;
    input.linkage = pose.side != Side::none;
    if (!input.linkage) return;
    controller.changed_side = controller.side != Side::none && controller.side != pose.side;
    controller.side = pose.side;
    input.middle_height_q4_mm = pose.middle_height_q4_mm;
    input.front_height_q4_mm = pose.front_height_q4_mm;
    add_distances(pose);
    input.middle_distance_q6_bin = pose.middle_distance_q6_bin;
    input.front_distance_q6_bin = pose.front_distance_q6_bin;
    if (looks_ahead) add_look_ahead(controller, inputs);
}

/// Second part: moves the position on to where the measurements were taken.
constexpr void match_cycle(Controller& controller) {
    MapGridInput& input = controller.cycle;
    // A map made by one side says nothing about the ground of the other.
    if (controller.changed_side) slip::drop_map(controller.map);
    if (input.motion == CycleMotion::turn || input.motion == CycleMotion::moved) {
        book_unmeasured_way(controller, input.odometer_q6_bin);
    } else {
        input.odometer_q6_bin = forward_odometer(controller, input.odometer_q6_bin);
    }
    map_grid_match(controller.map, input);
    controller.since_cycle_q4_mm =
        sub_wrap(controller.since_cycle_q4_mm, controller.in_cycle_q4_mm);
    take_position(controller);
}

/// Last part: sinkage; the sensors are compared, and the results reported.
constexpr void close_cycle(Controller& controller, const hal::RawInputs& inputs) {
    Estimates& estimates = controller.estimates;
    map_grid_sinkage(controller.map, controller.cycle.motion);
    if (controller.cycle.motion != CycleMotion::moved) {
        watch_cycle(controller.stuck, inputs);
        const bool disagree = tachometers_disagree(controller.odometer, controller.calibration);
        controller.sensor_faults = disagree ? uint16_t{kFaultTachometer} : uint16_t{0};
    }
    estimates.cycle_count = add_wrap(estimates.cycle_count, uint16_t{1});
    set_event(estimates, kEventCycle);
    if (controller.map.lost_lock) set_event(estimates, kEventLostLock);
    report_cycle(controller);
}

/// This step's part of a slip-and-sinkage cycle, if one has begun or is due.
constexpr void cycle_step(Controller& controller, const hal::RawInputs& inputs, bool looks_ahead) {
    if (controller.travel.moving) controller.resting = false;
    switch (controller.stage) {
        case CycleStage::none: {
            CycleMotion motion = CycleMotion::moved;
            if (!moved_at_rest(controller) && !cycle_due(controller, motion)) return;
            measure_cycle(controller, inputs, looks_ahead, motion);
            controller.stage = CycleStage::match;
            return;
        }
        case CycleStage::match:
            match_cycle(controller);
            controller.stage = CycleStage::extend;
            return;
        case CycleStage::extend:
            map_grid_extend(controller.map, controller.cycle);
            controller.stage = CycleStage::close;
            return;
        case CycleStage::close:
            close_cycle(controller, inputs);
            controller.stage = CycleStage::none;
            return;
    }
}

}  // namespace rover::executive
