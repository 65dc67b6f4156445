// rom_check.hpp - the image's check: CRC-16 of its bytes, the check's own two counted as zero.
// Depends on   link/crc16.hpp.
// Design note  docs/design/boot.md     Tests  tests/firmware/boot/rom_check_test.cpp
#pragma once

#include "firmware/link/crc16.hpp"

namespace rover {

/// CRC of ROM bytes, going on from `crc`.
/// @param alive  called before every 256 bytes
template <class Byte, class Alive>
[[gnu::noinline]] uint16_t rom_crc(uint16_t crc, const Byte* from, uint16_t count, Alive alive) {
    const uint8_t odd = narrow_wrap_u8(count);
    if (odd != 0) crc = crc16_block(crc, from, odd);
    from += odd;
    for (uint8_t blocks = narrow_wrap_u8(shift_floor<8>(count)); blocks != 0; --blocks) {
        alive();
        crc = crc16_block(crc, from, 0);
        from += 256;
    }
    return crc;
}

inline constexpr uint8_t kTwoZeros[2] = {};

/// Is the CRC of bytes 0 to size - 1 the one that stands in it?
/// @param rom       first byte of ROM
/// @param size      bytes of the image
/// @param check_at  offset of the two check bytes, low byte first
template <class Byte, class Alive>
bool rom_is_intact(const Byte* rom, uint16_t size, uint16_t check_at, Alive alive) {
    const uint16_t behind = add_wrap(check_at, uint16_t{2});
    if (size < behind) return false;
    uint16_t crc = rom_crc(kCrc16Start, rom, check_at, alive);
    crc = crc16_block<Byte>(crc, kTwoZeros, sizeof kTwoZeros);
    crc = rom_crc(crc, rom + behind, sub_wrap(size, behind), alive);
    const Byte* check = rom + check_at;
    const uint8_t low = *check++;
    const uint8_t high = *check;
    return low == narrow_wrap_u8(crc) && high == narrow_wrap_u8(shift_floor<8>(crc));
}

}  // namespace rover
