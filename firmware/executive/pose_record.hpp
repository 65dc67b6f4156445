// pose_record.hpp - what a warm start takes over from before the reset, and how.
// Depends on   executive/controller_state.hpp, config/slip_tuning.hpp.
// Taken over   position, odometer, learned slip and their doubts. The map starts anew.
// Layout       pose.hpp.
// Design note  docs/design/executive.md     Tests  tests/firmware/executive/pose_record_test.cpp
#pragma once

#include "firmware/estimation/map_grid.hpp"
#include "firmware/executive/controller_state.hpp"

namespace rover {

using PoseRecord = Pose;
static_assert(sizeof(PoseRecord) == 24, "the same bytes on host and target");

/// Puts into a pose what the estimator's has from outside: the odometer's state.
constexpr void add_odometry(const Controller& controller, Pose& pose) {
    pose.odometer_q4_mm = controller.odometer.travel_q4_mm;
    pose.since_cycle_q4_mm = controller.since_cycle_q4_mm;
    pose.turn_q4_mm = controller.odometer.turn_q4_mm;
}

/// What a warm start needs to go on from here.
constexpr PoseRecord pose_record(const Controller& controller) {
    PoseRecord record = controller.map;
    add_odometry(controller, record);
    return record;
}

/// Finds the root of the variance as the estimator follows it: a multiple of kSpreadStepQ6Bin, and
/// what it leaves.
constexpr void find_spread(MapGrid& map) {
    uint16_t high = narrow_wrap_u16(shift_floor<16>(map.variance_q12));
    uint16_t rest = narrow_wrap_u16(map.variance_q12);
    uint16_t next = 64;  // (s + 8)^2 - s^2 is 16 s + 64
    // Just below the square of kSpreadMaxQ6Bin, behind which the estimator does not look either.
    constexpr uint16_t kHighMax = (1ul * slip::kSpreadMaxQ6Bin * slip::kSpreadMaxQ6Bin >> 16) - 1;
    if (high > kHighMax) high = kHighMax;
    for (;;) {
        if (rest < next) {
            if (high == 0) break;
            --high;
        }
        rest = sub_wrap(rest, next);
        next = add_wrap(next, uint16_t{128});
    }
    map.spread_q6_bin = sub_wrap(shift_floor<4>(next), uint16_t{4});
    map.spread_rest_q12 = rest;
}

/// Goes on from a record: the next step reports the position and odometer of the record, plus what
/// it sees itself. The position is doubted by kDriftPerMoveQ12Bin more: nobody counted the wheels
/// between the record and this start.
/// @param controller  behind controller_reset()
/// @param record      any values; what the estimator cannot have learned is clamped
constexpr void controller_resume(Controller& controller, const PoseRecord& record) {
    MapGrid& map = controller.map;
    Odometer& odometer = controller.odometer;
    static_cast<Pose&>(map) = record;
    find_spread(map);
    slip::add_odometry_doubt(map, int16_t{slip::kDriftPerMoveQ12Bin / 16});
    if (map.mean_q12_bin < slip::kMeanMinQ12Bin || map.mean_q12_bin > slip::kMeanNoSlipQ12Bin ||
        map.learned > slip::kLearnSteps) {
        map.mean_q12_bin = slip::kMeanNoSlipQ12Bin;
        map.learned = 0;
    }
    odometer.travel_q4_mm = map.odometer_q4_mm;
    odometer.turn_q4_mm = map.turn_q4_mm;
    controller.since_cycle_q4_mm = map.since_cycle_q4_mm;
    controller.past_due_q4_mm = sub_wrap(map.since_cycle_q4_mm, kCycleTravelQ4Mm);
}

}  // namespace rover
