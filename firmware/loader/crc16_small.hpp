// crc16_small.hpp - CRC-16/CCITT-FALSE without a table.
// Depends on   core/arith.hpp.
// Why          link/crc16.hpp has 512 bytes of tables, a third of the loader's place.
// Tests        tests/firmware/loader/crc16_small_test.cpp: equal to crc16_add() for every argument.
#pragma once

#include "firmware/core/arith.hpp"

namespace rover::loader {

/// The check of a message one byte longer. 1021h is x^12 + x^5 + 1, so with x the byte shifted out,
/// folded once onto itself (x ^ x >> 4), the new bits are x << 12, x << 5 and x.
/// @cost  about 170 T
constexpr uint16_t crc16_add_small(uint16_t crc, uint8_t byte) {
    uint8_t x = bit_xor(narrow_wrap_u8(shift_floor<8>(crc)), byte);
    x = bit_xor(x, shift_floor<4>(x));
    const uint8_t high =
        bit_xor(bit_xor(narrow_wrap_u8(crc), shift_left_wrap<4>(x)), shift_floor<3>(x));
    const uint8_t low = bit_xor(shift_left_wrap<5>(x), x);
    return bit_or(shift_left_wrap<8>(widen_u16(high)), widen_u16(low));
}

}  // namespace rover::loader
