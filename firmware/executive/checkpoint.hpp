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

/// Which record is the newest. Lives in RAM, set by find_checkpoint() first of all.
struct CheckpointPlace {
    uint8_t slot = 0;      ///< offset of the newest
    uint8_t sequence = 0;  ///< its number, modulo 2^8
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

/// Can a slot be used: is it whole, and of this format?
template <class Byte>
[[gnu::noinline]] constexpr bool checkpoint_is_valid(const Byte* area, uint8_t slot) {
    const Byte* place = area + slot;
    return record_is_valid(place, sizeof(PoseRecord)) &&
           uint8_t{place[kRecordContent + sizeof(PoseRecord) - 1]} == kPoseFormat;
}

/// Finds the newest valid checkpoint. Its record is at area + newest.slot + kRecordContent.
/// @param newest  set so that the next save_checkpoint() replaces an older or an invalid one
/// @return        false: there is none
template <class Byte>
constexpr bool find_checkpoint(const Byte* area, CheckpointPlace& newest) {
    const uint8_t in_a = area[battery::kSlotA + 1];
    const uint8_t in_b = area[battery::kSlotB + 1];
    const bool a_first = narrow_wrap_s8(sub_wrap(in_b, in_a)) < 0;
    newest.slot = a_first ? battery::kSlotA : battery::kSlotB;
    if (!checkpoint_is_valid(area, newest.slot)) {
        newest.slot = bit_xor(newest.slot, battery::kOtherSlot);
        if (!checkpoint_is_valid(area, newest.slot)) return false;
    }
    newest.sequence = area[add_wrap(newest.slot, uint8_t{1})];
    return true;
}

/// Drops both checkpoints.
template <class Byte>
constexpr void drop_checkpoints(Byte* area) {
    area[battery::kSlotA] = uint8_t{0};
    area[battery::kSlotB] = uint8_t{0};
}

}  // namespace rover
