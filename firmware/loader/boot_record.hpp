// boot_record.hpp - is there an image that may be started?
// Depends on   config/eeprom_layout.hpp, loader/crc16_small.hpp.
// Normative    docs/spec/loader.md     Tests  tests/firmware/loader/boot_record_test.cpp
#pragma once

#include "firmware/config/eeprom_layout.hpp"
#include "firmware/link/crc16.hpp"
#include "firmware/loader/crc16_small.hpp"

namespace rover::loader {

/// CRC of bytes, going on from `crc`. @param count  [1, 256]: 256 is given as 0
template <class Byte>
[[gnu::noinline]] constexpr uint16_t crc16_small(uint16_t crc, const Byte* from, uint8_t count) {
    do {
        crc = crc16_add_small(crc, uint8_t{*from++});
    } while (--count != 0);
    return crc;
}

/// Is the record at `record` whole?
/// @tparam Byte  volatile on the target
template <class Byte>
[[gnu::noinline]] constexpr bool record_is_whole(const Byte* record) {
    const uint16_t crc = crc16_small(kCrc16Start, record, kBootRecordChecked);
    const uint8_t low = record[kBootRecordChecked];
    const uint8_t high = record[kBootRecordChecked + 1];
    if (low != narrow_wrap_u8(crc) || high != narrow_wrap_u8(shift_floor<8>(crc))) return false;
    for (const uint8_t letter : kRecordMagic) {
        if (uint8_t{*record++} != letter) return false;
    }
    return true;
}

}  // namespace rover::loader
