// battery_area.hpp - the battery-backed bytes that outlive a reset: places, and records that are
// whole or invalid.
// Depends on   link/crc16.hpp.
// Normative    docs/spec/memory-map.md
// Design note  docs/design/executive.md     Tests  tests/firmware/executive/battery_area_test.cpp
#pragma once

#include "firmware/link/crc16.hpp"

namespace rover {

/// Offsets in the area (hal::rb85::kCheckpointFirst).
namespace battery {
inline constexpr uint8_t kResetCount = 0x00;  ///< u16
inline constexpr uint8_t kMark = 0x02;        ///< RunMark: what the last run was doing
inline constexpr uint8_t kQuietTicks = 0x03;  ///< ticks since the watchdog's last edge, saturates
inline constexpr uint8_t kFaults = 0x04;      ///< u16, BoardFault bits of this run
inline constexpr uint8_t kSlotA = 0x20;       ///< checkpoints
inline constexpr uint8_t kSlotB = 0x40;
inline constexpr uint8_t kCalibration = 0x60;
inline constexpr uint8_t kOtherSlot = kSlotA ^ kSlotB;
}  // namespace battery

/// What the last run was doing; anything else: nothing is known.
enum class RunMark : uint8_t {
    running = 0x52,       ///< the main loop
    warm_restart = 0x57,  ///< waits for the watchdog, as the ground asked
    cold_restart = 0x43,  ///< the same, and the checkpoints are to be dropped
};

/// A record: state, sequence number, content, CRC-16 of sequence number and content (low byte
/// first). The state is kRecordValid only while all the rest is whole.
inline constexpr uint8_t kRecordValid = 0xA5;
inline constexpr uint8_t kRecordOverhead = 4;

/// Replaces a record. Behind any of its stores the record is the old one untouched, invalid, or the
/// new one complete.
/// @tparam Byte  volatile on the target: the order of the stores is what protects the record
/// @param place  kRecordOverhead + `size` bytes
template <class Byte, class Content>
constexpr void write_record(Byte* place, uint8_t sequence, const Content* content, uint8_t size) {
    Byte* state = place;
    *state = uint8_t{0};
    *++place = sequence;
    uint16_t crc = crc16_add(kCrc16Start, sequence);
    for (; size != 0; --size) {
        const uint8_t byte = *content++;
        *++place = byte;
        crc = crc16_add(crc, byte);
    }
    *++place = narrow_wrap_u8(crc);
    *++place = narrow_wrap_u8(shift_floor<8>(crc));
    *state = kRecordValid;
}

/// Is the record whole?
template <class Byte>
[[gnu::noinline]] constexpr bool record_is_valid(const Byte* place, uint8_t size) {
    if (uint8_t{*place} != kRecordValid) return false;
    uint16_t crc = kCrc16Start;
    for (uint8_t left = add_wrap(size, uint8_t{1}); left != 0; --left) {
        crc = crc16_add(crc, uint8_t{*++place});
    }
    const uint8_t low = *++place;
    const uint8_t high = *++place;
    return low == narrow_wrap_u8(crc) && high == narrow_wrap_u8(shift_floor<8>(crc));
}

/// Where the content of a record begins.
inline constexpr uint8_t kRecordContent = 2;

}  // namespace rover
