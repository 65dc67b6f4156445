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
    loader = 0x4C,        ///< the same, and the loader is to stay; it makes a warm restart of it
};

/// A record: state, sequence number, content, CRC-16 of sequence number and content (low byte
/// first). The state is kRecordValid only while all the rest is whole.
inline constexpr uint8_t kRecordValid = 0xA5;
inline constexpr uint8_t kRecordOverhead = 4;

/// Where the content of a record begins.
inline constexpr uint8_t kRecordContent = 2;

/// CRC of sequence number and content.
/// @param size  of the content, [1, 254]
template <class Byte>
constexpr uint16_t record_crc(const Byte* place, uint8_t size) {
    return crc16_block(kCrc16Start, place + 1, add_wrap(size, uint8_t{1}));
}

/// @param count  [1, 256]: 256 is given as 0
template <class Byte, class Content>
constexpr void copy_bytes(Byte* to, const Content* from, uint8_t count) {
    do {
        *to++ = uint8_t{*from++};
    } while (--count != 0);
}

/// Replaces a record. Behind any of its stores the record is the old one untouched, invalid, or the
/// new one complete.
/// @tparam Byte  volatile on the target: the order of the stores is what protects the record
/// @param place  kRecordOverhead + `size` bytes
/// @param size   of the content, [1, 251]
template <class Byte, class Content>
[[gnu::noinline]] constexpr void write_record(Byte* place, uint8_t sequence, const Content* content,
                                              uint8_t size) {
    *place = uint8_t{0};
    place[1] = sequence;
    copy_bytes(place + kRecordContent, content, size);
    const uint16_t crc = record_crc(place, size);
    Byte* check = place + add_wrap(size, kRecordContent);
    *check++ = narrow_wrap_u8(crc);
    *check = narrow_wrap_u8(shift_floor<8>(crc));
    *place = kRecordValid;
}

/// Is the record whole?
template <class Byte>
[[gnu::noinline]] constexpr bool record_is_valid(const Byte* place, uint8_t size) {
    if (uint8_t{*place} != kRecordValid) return false;
    const uint16_t crc = record_crc(place, size);
    place += add_wrap(size, kRecordContent);
    const uint8_t low = *place++;
    const uint8_t high = *place;
    return low == narrow_wrap_u8(crc) && high == narrow_wrap_u8(shift_floor<8>(crc));
}

}  // namespace rover
