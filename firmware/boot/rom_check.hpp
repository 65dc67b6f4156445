// rom_check.hpp - the image's check: CRC-16 of its bytes, the check's own two counted as zero.
// Depends on   link/crc16.hpp.
// Design note  docs/design/boot.md     Tests  tests/firmware/boot/rom_check_test.cpp
#pragma once

#include "firmware/link/crc16.hpp"

namespace rover {

/// CRC of ROM bytes, going on from `crc`.
/// @param alive  called before the first byte and then every 256 bytes
template <class Byte, class Alive>
[[gnu::noinline]] uint16_t rom_crc(uint16_t crc, const Byte* from, uint16_t count, Alive alive) {
    uint8_t until_alive = 1;
    for (; count != 0; count = sub_wrap(count, uint16_t{1})) {
        until_alive = sub_wrap(until_alive, uint8_t{1});
        if (until_alive == 0) alive();
        crc = crc16_add(crc, uint8_t{*from++});
    }
    return crc;
}

/// Is the CRC of bytes 0 to size - 1 the one that stands in it?
/// @param rom       first byte of ROM
/// @param size      bytes of the image
/// @param check_at  offset of the two check bytes, low byte first
template <class Byte, class Alive>
bool rom_is_intact(const Byte* rom, uint16_t size, uint16_t check_at, Alive alive) {
    const uint16_t behind = add_wrap(check_at, uint16_t{2});
    if (size < behind) return false;
    uint16_t crc = rom_crc(kCrc16Start, rom, check_at, alive);
    crc = crc16_add(crc16_add(crc, 0), 0);
    crc = rom_crc(crc, rom + behind, sub_wrap(size, behind), alive);
    const Byte* check = rom + check_at;
    const uint8_t low = *check++;
    const uint8_t high = *check;
    return low == narrow_wrap_u8(crc) && high == narrow_wrap_u8(shift_floor<8>(crc));
}

}  // namespace rover
