// rom_check.hpp - the image's check: CRC-16 of its bytes, the check's own two counted as zero.
// Depends on   link/crc16.hpp.
// Design note  docs/design/boot.md     Tests  tests/firmware/boot/rom_check_test.cpp
#pragma once

#include "firmware/link/crc16.hpp"

namespace rover {

inline constexpr uint8_t kZeroByte = 0;

/// Is the CRC of bytes 0 to size - 1 the one that stands in it?
/// @param rom       first byte of ROM
/// @param size      bytes of the image; 0 is 65536
/// @param check_at  offset of the two check bytes, low byte first
/// @param alive     called for every byte
/// @cost            a call of crc16_block() a byte: boot has time
template <class Byte, class Alive>
bool rom_is_intact(const Byte* rom, uint16_t size, uint16_t check_at, Alive alive) {
    uint16_t crc = kCrc16Start;
    uint16_t at = 0;
    uint16_t left = size;
    do {
        alive();
        const bool in_check = sub_wrap(at, check_at) < 2;
        crc = crc16_block<Byte>(crc, in_check ? &kZeroByte : rom + at, 1);
        at = add_wrap(at, uint16_t{1});
    } while (--left != 0);
    const uint8_t low = rom[check_at];
    const uint8_t high = rom[add_wrap(check_at, uint16_t{1})];
    return crc == bit_or(widen_u16(low), shift_left_wrap<8>(widen_u16(high)));
}

}  // namespace rover
