// eeprom.hpp - writes a page of the 28C256: unlock, load, poll, read back.
// Source       Atmel AT28C256 data sheet: Page Write, DATA Polling, Software Data Protection.
// Depends on   config/eeprom_layout.hpp.
// Must run     from RAM, with interrupts disabled: the part cannot be read while it writes, and a
//              fetch in between would end the load.
// Tests        tests/firmware/loader/eeprom_test.cpp, tests/system/loader
#pragma once

#include "firmware/config/eeprom_layout.hpp"
#include "firmware/core/arith.hpp"

namespace rover::loader {

/// Polls of a write cycle: at 53 T each 27 ms, more than twice the longest cycle.
inline constexpr uint16_t kPollsMax = 1600;

/// @tparam Memory  cells by address: static get(address), put(address, byte)
template <class Memory>
struct EepromWriter {
    static constexpr uint16_t kUnlock0 = 0x5555;
    static constexpr uint16_t kUnlock1 = 0x2AAA;

    /// Programs 64 bytes. What lies between two stores is far below the 150 us of the load time.
    /// The part protects itself again behind the cycle.
    /// @param page   the first address of a page
    /// @param bytes  kPageSize of them
    /// @return  false: the write cycle did not end
    static bool write(uint16_t page, const uint8_t* bytes) {
        Memory::put(kUnlock0, 0xAA);
        Memory::put(kUnlock1, 0x55);
        Memory::put(kUnlock0, 0xA0);
        uint8_t last = 0;
        uint16_t at = page;
        for (uint8_t left = kPageSize; left != 0; --left) {
            last = *bytes++;
            Memory::put(at, last);
            at = add_wrap(at, uint16_t{1});
        }
        return cycle_ends(sub_wrap(at, uint16_t{1}), last);
    }

private:
    /// DATA polling: bit 7 of the last byte is its complement until the cycle has ended.
    static bool cycle_ends(uint16_t at, uint8_t last) {
        for (uint16_t left = kPollsMax; left != 0; --left) {
            const uint8_t bits = bit_xor(Memory::get(at), last);
            if (bit_and(bits, uint8_t{0x80}) == 0) return true;
        }
        return false;
    }
};

}  // namespace rover::loader
