// crc16.hpp - CRC-16/CCITT-FALSE: polynomial 1021h, start FFFFh, most significant bit first.
// Depends on   core/arith.hpp.
// Source       ITU-T V.41 polynomial; check value of "123456789" is 29B1h (Crc16.CheckValue).
// Cost         two tables of 256 bytes, by halves of the word: an 8085 then indexes bytes.
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
    uint8_t high = 0;
    uint8_t low = 0;
    if (__builtin_is_constant_evaluated()) {
        high = link::kCrc16Table.high[index];
        low = link::kCrc16Table.low[index];
    } else {
        // The tables begin pages of memory: the index is the low byte of the address in both.
        const auto* const entry = reinterpret_cast<const uint8_t*>(
            reinterpret_cast<uintptr_t>(&link::kCrc16Table) | index);
        high = *entry;
        low = *(entry + sizeof link::kCrc16Table.high);
    }
    high = bit_xor(high, narrow_wrap_u8(crc));
    return bit_or(shift_left_wrap<8>(widen_u16(high)), widen_u16(low));
}

/// The check of a message longer by `size` bytes. Four a turn: a turn costs half a byte.
[[gnu::noinline]] constexpr uint16_t crc16_add(uint16_t crc, const uint8_t* bytes, uint8_t size) {
    for (; bit_and(size, uint8_t{3}) != 0; --size) crc = crc16_add(crc, *bytes++);
    for (size = shift_floor<2>(size); size != 0; --size) {
        crc = crc16_add(crc, *bytes++);
        crc = crc16_add(crc, *bytes++);
        crc = crc16_add(crc, *bytes++);
        crc = crc16_add(crc, *bytes++);
    }
    return crc;
}

}  // namespace rover
