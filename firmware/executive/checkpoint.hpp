// checkpoint.hpp - the pose in battery-backed memory: two records in turn, the newest valid one
// counts.
// Depends on   executive/battery_area.hpp, pose_record.hpp.
// Invariant    a reset or a loss of supply at any instruction leaves the record before or the new
//              one: the older of the two is written, and is invalid until it is whole.
// Normative    docs/spec/memory-map.md
// Design note  docs/design/executive.md     Tests  tests/firmware/executive/checkpoint_test.cpp
#pragma once

#include "firmware/executive/battery_area.hpp"
#include "firmware/executive/pose_record.hpp"

namespace rover {

/// Which record is the newest. Lives in RAM, made anew by find_checkpoint().
struct CheckpointPlace {
    uint8_t slot = battery::kSlotB;  ///< offset of the newest
    uint8_t sequence = 0;            ///< its number, modulo 2^8
};

/// Writes a checkpoint into the slot that does not hold the newest one.
/// @param area  the battery-backed area
template <class Byte>
constexpr void save_checkpoint(Byte* area, CheckpointPlace& newest, const PoseRecord& record) {
    newest.slot = bit_xor(newest.slot, battery::kOtherSlot);
    newest.sequence = add_wrap(newest.sequence, uint8_t{1});
    write_record(area + newest.slot, newest.sequence, reinterpret_cast<const uint8_t*>(&record),
                 sizeof record);
}

/// Reads one slot. @return false: not valid, or of another format
template <class Byte>
constexpr bool read_checkpoint(const Byte* area, uint8_t slot, PoseRecord& record) {
    return read_record(area + slot, reinterpret_cast<uint8_t*>(&record), sizeof record) &&
           record.format == kPoseRecordFormat;
}

/// Finds the newest valid checkpoint.
/// @param newest  set so that the next save_checkpoint() replaces an older or an invalid one
/// @return        false: there is none, and `record` holds anything
template <class Byte>
constexpr bool find_checkpoint(const Byte* area, CheckpointPlace& newest, PoseRecord& record) {
    const uint8_t in_a = area[battery::kSlotA + 1];
    const uint8_t in_b = area[battery::kSlotB + 1];
    newest.slot = battery::kSlotB;
    if (narrow_wrap_s8(sub_wrap(in_a, in_b)) > 0) newest.slot = battery::kSlotA;
    if (!read_checkpoint(area, newest.slot, record)) {
        newest.slot = bit_xor(newest.slot, battery::kOtherSlot);
        if (!read_checkpoint(area, newest.slot, record)) return false;
    }
    newest.sequence = newest.slot == battery::kSlotA ? in_a : in_b;
    return true;
}

/// Drops both checkpoints.
template <class Byte>
constexpr void drop_checkpoints(Byte* area) {
    area[battery::kSlotA] = uint8_t{0};
    area[battery::kSlotB] = uint8_t{0};
}

}  // namespace rover
