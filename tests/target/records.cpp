// records.cpp - every field of the mailbox's structs, in the order of their declarations.
#include "tests/target/records.hpp"

namespace target_test {

namespace {

void add(Record& record, const hal::Calibration& value) {
    record.field("calibration.version", value.version);
    for (const hal::AngleCalibration& angle : value.angle) {
        record.field("calibration.angle.zero_q4_count", angle.zero_q4_count);
        record.field("calibration.angle.gain_q16", angle.gain_q16);
        record.field("calibration.angle.inverted", angle.inverted);
    }
    record.field("calibration.wheel_radius_q4_mm", value.wheel_radius_q4_mm);
    record.field("calibration.tach_counts_per_turn", value.tach_counts_per_turn);
    record.field("calibration.tach_q16_mm_per_count", value.tach_q16_mm_per_count);
    record.field("calibration.range_offset_q1_mm", value.range_offset_q1_mm);
}

void add(Record& record, const rover::Estimates& value) {
    record.field("estimates.step_count", value.step_count);
    record.field("estimates.tick_count", value.tick_count);
    record.field("estimates.available", value.available);
    record.field("estimates.events", value.events);
    record.field("estimates.faults", value.faults);
    record.field("estimates.mode", value.mode);
    record.field("estimates.cycle_count", value.cycle_count);
    record.field("estimates.position_q4_mm", value.position_q4_mm);
    record.field("estimates.odometer_q4_mm", value.odometer_q4_mm);
    record.field("estimates.position_sigma_q4_mm", value.position_sigma_q4_mm);
    record.field("estimates.advance_q4_mm", value.advance_q4_mm);
    record.field("estimates.slip_percent", value.slip_percent);
    record.field("estimates.match_cost_q4", value.match_cost_q4);
    record.field("estimates.sinkage_q4_mm", value.sinkage_q4_mm);
    record.field("estimates.pitch_brad", value.pitch_brad);
    record.field("estimates.roll_brad", value.roll_brad);
    record.field("estimates.rocker_brad", value.rocker_brad);
    record.field("estimates.bogie_brad", value.bogie_brad);
    record.field("estimates.height_middle_q4_mm", value.height_middle_q4_mm);
    record.field("estimates.height_front_q4_mm", value.height_front_q4_mm);
    record.field("estimates.height_ahead_q4_mm", value.height_ahead_q4_mm);
}

void add(Record& record, const rover::Odometer& value) {
    for (const rover::OdometerWheel& wheel : value.wheel) {
        record.field("odometer.wheel.last_count", wheel.last_count);
        record.field("odometer.wheel.ahead_count", wheel.ahead_count);
        record.field("odometer.wheel.drift_count", wheel.drift_count);
    }
    for (const rover::OdometerSide& side : value.side) {
        record.field("odometer.side.pulses", side.pulses);
        record.field("odometer.side.odd_pulse", side.odd_pulse);
    }
    record.field("odometer.present", value.present);
    record.field("odometer.drift_max_count", value.drift_max_count);
    record.field("odometer.rest_q20_mm", value.rest_q20_mm);
    record.field("odometer.turn_rest_q20_mm", value.turn_rest_q20_mm);
    record.field("odometer.travel_q4_mm", value.travel_q4_mm);
    record.field("odometer.turn_q4_mm", value.turn_q4_mm);
}

void add(Record& record, const rover::MapGridInput& value) {
    record.field("cycle.motion", value.motion);
    record.field("cycle.linkage", value.linkage);
    record.field("cycle.odometer_q6_bin", value.odometer_q6_bin);
    record.field("cycle.middle_height_q4_mm", value.middle_height_q4_mm);
    record.field("cycle.front_height_q4_mm", value.front_height_q4_mm);
    record.field("cycle.middle_distance_q6_bin", value.middle_distance_q6_bin);
    record.field("cycle.front_distance_q6_bin", value.front_distance_q6_bin);
    record.field("cycle.ahead_count", value.ahead_count);
    record.field("cycle.ahead_height_q4_mm", value.ahead_height_q4_mm);
    record.field("cycle.ahead_distance_q6_bin", value.ahead_distance_q6_bin);
}

void add(Record& record, const rover::MapGrid& value) {
    record.field("map.surface_q4_mm", value.surface_q4_mm);
    record.field("map.ahead.height_q4_mm", value.ahead.height_q4_mm);
    record.field("map.ahead.fraction_q8", value.ahead.fraction_q8);
    record.field("map.travelled_q6_bin", value.travelled_q6_bin);
    record.field("map.odometer_q4_mm", value.odometer_q4_mm);
    record.field("map.variance_q12", value.variance_q12);
    record.field("map.drift_q12_bin", value.drift_q12_bin);
    record.field("map.since_cycle_q4_mm", value.since_cycle_q4_mm);
    record.field("map.turn_q4_mm", value.turn_q4_mm);
    record.field("map.mean_q12_bin", value.mean_q12_bin);
    record.field("map.learned", value.learned);
    record.field("map.format", value.format);
    record.field("map.has_map", value.has_map);
    record.field("map.measured", value.measured);
    record.field("map.lowest_q6_bin", value.lowest_q6_bin);
    record.field("map.measured_from_q6_bin", value.measured_from_q6_bin);
    record.field("map.front_place_q6_bin", value.front_place_q6_bin);
    record.field("map.front_height_q4_mm", value.front_height_q4_mm);
    record.field("map.front_height_before_q4_mm", value.front_height_before_q4_mm);
    record.field("map.place_q6_bin", value.place_q6_bin);
    record.field("map.advance_q6_bin", value.advance_q6_bin);
    record.field("map.rough_q8_mm", value.rough_q8_mm);
    record.field("map.match_cost_q10", value.match_cost_q10);
    record.field("map.rough_count", value.rough_count);
    record.field("map.matched", value.matched);
    record.field("map.cost_q3", value.cost_q3);
    record.field("map.added_variance_q12", value.added_variance_q12);
    record.field("map.spread_q6_bin", value.spread_q6_bin);
    record.field("map.spread_rest_q12", value.spread_rest_q12);
    record.field("map.front_is_new", value.front_is_new);
    record.field("map.passed_bin", value.passed_bin);
    record.field("map.has_behind", value.has_behind);
    record.field("map.behind_place_q8_bin", value.behind_place_q8_bin);
    record.field("map.behind_height_q4_mm", value.behind_height_q4_mm);
    record.field("map.sinkage_count", value.sinkage_count);
    record.field("map.sinkage_valid", value.sinkage_valid);
    record.field("map.sinkage_smooth_q5_mm", value.sinkage_smooth_q5_mm);
    record.field("map.sinkage_size_q11_mm", value.sinkage_size_q11_mm);
    record.field("map.sinkage_q4_mm", value.sinkage_q4_mm);
    record.field("map.mode", value.mode);
    record.field("map.slip_alarm", value.slip_alarm);
    record.field("map.sinkage_alarm", value.sinkage_alarm);
    record.field("map.lost_lock", value.lost_lock);
}

}  // namespace

std::string Record::name_at(std::size_t offset) const {
    std::size_t first = offset;
    while (first > 0 && names_[first - 1] == names_[offset]) --first;
    return std::string(names_[offset]) + " + " + std::to_string(offset - first);
}

Record record_of(const hal::Calibration& calibration) {
    Record record;
    add(record, calibration);
    return record;
}

Record record_of(const hal::RawInputs& inputs) {
    Record record;
    record.field("tick_count", inputs.tick_count);
    record.field("adc_q4_count", inputs.adc_q4_count);
    record.field("tach_count", inputs.tach_count);
    record.field("tach_present", inputs.tach_present);
    record.field("detector_bits", inputs.detector_bits);
    record.field("range_scan_count", inputs.range_scan_count);
    record.field("range_present", inputs.range_present);
    record.field("range_q1_mm", inputs.range_q1_mm);
    record.field("command_size", inputs.command_size);
    record.field("command", inputs.command);
    return record;
}

Record record_of(const hal::Commands& commands) {
    Record record;
    record.field("drive_percent", commands.drive_percent);
    record.field("steer_brad", commands.steer_brad);
    record.field("laser_bits", commands.laser_bits);
    record.field("telemetry_size", commands.telemetry_size);
    record.field("mast_brad", commands.mast_brad);
    record.field("telemetry", commands.telemetry);
    return record;
}

Record record_of(const rover::Controller& controller) {
    Record record;
    add(record, controller.map);
    add(record, controller.calibration);
    record.field("calibration_fault", controller.calibration_fault);
    add(record, controller.estimates);
    record.field("stuck.last_q4_count", controller.stuck.last_q4_count);
    record.field("stuck.same_cycles", controller.stuck.same_cycles);
    record.field("stuck.stuck", controller.stuck.stuck);
    record.field("angles.brad", controller.angles.brad);
    record.field("angles.valid", controller.angles.valid);
    record.field("angles.faults", controller.angles.faults);
    record.field("angles.stuck", controller.angles.stuck);
    record.field("pose.side", controller.pose.side);
    record.field("pose.rocker_brad", controller.pose.rocker_brad);
    record.field("pose.bogie_brad", controller.pose.bogie_brad);
    record.field("pose.middle_height_q4_mm", controller.pose.middle_height_q4_mm);
    record.field("pose.front_height_q4_mm", controller.pose.front_height_q4_mm);
    record.field("pose.middle_distance_q6_bin", controller.pose.middle_distance_q6_bin);
    record.field("pose.front_distance_q6_bin", controller.pose.front_distance_q6_bin);
    record.field("travel.travel_q4_mm", controller.travel.travel_q4_mm);
    record.field("travel.moving", controller.travel.moving);
    record.field("travel.valid", controller.travel.valid);
    add(record, controller.odometer);
    record.field("scan.last_scan_count", controller.scan.last_scan_count);
    record.field("scan.age_steps", controller.scan.age_steps);
    record.field("started", controller.started);
    record.field("sensor_faults", controller.sensor_faults);
    record.field("past_due_q4_mm", controller.past_due_q4_mm);
    record.field("since_cycle_q4_mm", controller.since_cycle_q4_mm);
    record.field("in_cycle_q4_mm", controller.in_cycle_q4_mm);
    record.field("stage", controller.stage);
    record.field("changed_side", controller.changed_side);
    add(record, controller.cycle);
    record.field("odometer_rest_q6", controller.odometer_rest_q6);
    record.field("cycle_position_q4_mm", controller.cycle_position_q4_mm);
    record.field("share_q15", controller.share_q15);
    record.field("side", controller.side);
    record.field("resting", controller.resting);
    record.field("rest_middle_q4_mm", controller.rest_middle_q4_mm);
    record.field("rest_front_q4_mm", controller.rest_front_q4_mm);
    return record;
}

}  // namespace target_test
