// crc16.hpp - CRC-16/CCITT-FALSE: polynomial 1021h, start FFFFh, most significant bit first.
// Depends on   core/arith.hpp.
// Source       ITU-T V.41 polynomial; check value of "123456789" is 29B1h (Crc16.CheckValue).
// Cost         512 bytes at a page, by halves of the word: an index is then a low address byte.
#pragma once

#include "firmware/core/arith.hpp"

namespace rover {

inline constexpr uint16_t kCrc16Start = 0xFFFF;

namespace link {

/// 1021h times every byte, the halves apart.
struct Crc16Table {
    uint8_t high[256] = {};
    uint8_t low[256] = {};

    constexpr Crc16Table() {
        for (uint16_t byte = 0; byte < 256; ++byte) {
            uint16_t crc = shift_left_wrap<8>(byte);
            for (uint8_t bit = 0; bit < 8; ++bit) {
                const bool carry = bit_and(crc, uint16_t{0x8000}) != 0;
                crc = shift_left_wrap<1>(crc);
                if (carry) crc = bit_xor(crc, uint16_t{0x1021});
            }
            high[byte] = narrow_wrap_u8(shift_floor<8>(crc));
            low[byte] = narrow_wrap_u8(crc);
        }
    }
};
alignas(256) inline constexpr Crc16Table kCrc16Table;

}  // namespace link

/// The check of a message one byte longer.
constexpr uint16_t crc16_add(uint16_t crc, uint8_t byte) {
    const uint8_t index = bit_xor(narrow_wrap_u8(shift_floor<8>(crc)), byte);
    const uint8_t high = bit_xor(narrow_wrap_u8(crc), link::kCrc16Table.high[index]);
    return bit_or(shift_left_wrap<8>(widen_u16(high)), widen_u16(link::kCrc16Table.low[index]));
}

namespace link {

/// crc16_block() with the check by halves: so 8085 code has everything in registers where the loop
/// wants it.
template <class Byte>
[[gnu::noinline]] constexpr uint16_t crc16_bytes(const Byte* from, uint8_t high, uint8_t count,
                                                 uint8_t low) {
    do {
        const uint8_t index = bit_xor(high, uint8_t{*from++});
        high = bit_xor(low, kCrc16Table.high[index]);
        low = kCrc16Table.low[index];
    } while (--count != 0);
    return bit_or(shift_left_wrap<8>(widen_u16(high)), widen_u16(low));
}

}  // namespace link

/// The check of a message longer by a block.
/// @tparam Byte  may be volatile, or convert to uint8_t
/// @param count  [1, 256]: 256 is given as 0
/// @cost         71 T a byte
template <class Byte>
constexpr uint16_t crc16_block(uint16_t crc, const Byte* from, uint8_t count) {
    return link::crc16_bytes(from, narrow_wrap_u8(shift_floor<8>(crc)), count, narrow_wrap_u8(crc));
}

}  // namespace rover
