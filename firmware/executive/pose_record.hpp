// pose_record.hpp - what a warm start takes over from before the reset, and how.
// Depends on   executive/reporting.hpp (what position is reported), config/slip_tuning.hpp.
// Taken over   position, odometer, learned slip and their doubts. The map starts anew.
// Layout       24 bytes without padding on host and target; docs/spec/memory-map.md (normative).
// Design note  docs/design/executive.md     Tests  tests/firmware/executive/pose_record_test.cpp
#pragma once

#include "firmware/core/isqrt.hpp"
#include "firmware/executive/controller_state.hpp"

namespace rover {

/// Another layout or meaning gets another number: a record of an older image is then refused.
inline constexpr uint8_t kPoseRecordFormat = 1;

struct PoseRecord {
    int32_t travelled_q6_bin = 0;   ///< place of the last match
    int32_t odometer_q4_mm = 0;     ///< wheel odometry
    uint32_t variance_q12 = 0;      ///< of the position, (1/64 bin)^2
    uint32_t drift_q12_bin = 0;     ///< systematic part of the position uncertainty
    int16_t since_cycle_q4_mm = 0;  ///< odometry that no match has measured yet
    int16_t turn_q4_mm = 0;         ///< turn since the last cycle
    int16_t mean_q12_bin = slip::kMeanNoSlipQ12Bin;  ///< learned advance of a 6 cm cycle
    uint8_t learned = 0;                             ///< cycles behind it, [0, slip::kLearnSteps]
    uint8_t format = kPoseRecordFormat;
};
static_assert(sizeof(PoseRecord) == 24, "the same bytes on host and target");

/// What a warm start needs to go on from here.
constexpr PoseRecord pose_record(const Controller& controller) {
    const MapGrid& map = controller.map;
    const Odometer& odometer = controller.odometer;
    PoseRecord record;
    record.travelled_q6_bin = map.travelled_q6_bin;
    record.odometer_q4_mm = odometer.travel_q4_mm;
    record.variance_q12 = map.variance_q12;
    record.drift_q12_bin = map.drift_q12_bin;
    record.since_cycle_q4_mm = controller.since_cycle_q4_mm;
    record.turn_q4_mm = odometer.turn_q4_mm;
    record.mean_q12_bin = map.mean_q12_bin;
    record.learned = map.learned;
    return record;
}

/// Goes on from a record: the next step reports the position and odometer of the record, plus what
/// it sees itself. The position is doubted by kDriftPerMoveQ12Bin more: nobody counted the wheels
/// between the record and this start.
/// @param controller  behind controller_reset()
/// @param record      any values; what the estimator cannot have learned is clamped
constexpr void controller_resume(Controller& controller, const PoseRecord& record) {
    MapGrid& map = controller.map;
    Odometer& odometer = controller.odometer;
    map.travelled_q6_bin = record.travelled_q6_bin;
    map.variance_q12 = record.variance_q12;
    map.spread_q6_bin = isqrt(map.variance_q12);
    map.drift_q12_bin = add_sat(record.drift_q12_bin, uint32_t{slip::kDriftPerMoveQ12Bin});
    map.mean_q12_bin = clamp(record.mean_q12_bin, slip::kMeanMinQ12Bin, slip::kMeanNoSlipQ12Bin);
    map.learned = min(record.learned, slip::kLearnSteps);
    odometer.travel_q4_mm = record.odometer_q4_mm;
    odometer.turn_q4_mm = record.turn_q4_mm;
    controller.since_cycle_q4_mm = record.since_cycle_q4_mm;
    controller.past_due_q4_mm = sub_sat(record.since_cycle_q4_mm, kCycleTravelQ4Mm);
}

}  // namespace rover
