// crc16.hpp - CRC-16/CCITT-FALSE: polynomial 1021h, start FFFFh, most significant bit first.
// Depends on   core/arith.hpp.
// Source       ITU-T V.41 polynomial; check value of "123456789" is 29B1h (Crc16.CheckValue).
#pragma once

#include "firmware/core/arith.hpp"

namespace rover {

inline constexpr uint16_t kCrc16Start = 0xFFFF;

/// 1021h times each nibble: two look-ups a byte instead of eight shifts.
inline constexpr uint16_t kCrc16Nibble[16] = {0x0000, 0x1021, 0x2042, 0x3063, 0x4084, 0x50A5,
                                              0x60C6, 0x70E7, 0x8108, 0x9129, 0xA14A, 0xB16B,
                                              0xC18C, 0xD1AD, 0xE1CE, 0xF1EF};

/// The check of a message one byte longer.
constexpr uint16_t crc16_add(uint16_t crc, uint8_t byte) {
    for (uint8_t half = 0; half < 2; ++half) {
        const uint8_t nibble = half == 0 ? shift_floor<4>(byte) : bit_and(byte, uint8_t{15});
        const uint8_t index = bit_xor(narrow_wrap_u8(shift_floor<12>(crc)), nibble);
        crc = bit_xor(shift_left_wrap<4>(crc), kCrc16Nibble[index]);
    }
    return crc;
}

}  // namespace rover
