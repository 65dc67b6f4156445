// i82c55a.hpp - driver of the 82C55A parallel ports in mode 0.
// Source       Intel 82C55A data sheet (231256).
// Depends on   nothing. Bus: docs/design/hal.md
// Page         docs/chips/i82c55a.md
#pragma once

#include <stdint.h>

namespace hal {

/// @tparam kPort  port A; ports B and C and the control register follow
template <class Bus, uint8_t kPort>
struct I82c55a {
    static constexpr uint8_t kPortA = kPort;
    static constexpr uint8_t kPortB = kPort + 1;
    static constexpr uint8_t kPortC = kPort + 2;
    static constexpr uint8_t kControl = kPort + 3;

    /// Sets directions. All outputs fall to 0.
    /// @tparam kWord  bit 7 is 1
    /// @ref  "Mode Selection", mode definition format
    template <uint8_t kWord>
    static void set_mode() {
        static_assert((kWord & 0x80) != 0, "bit 7 of a mode word is 1");
        Bus::template out<kControl>(kWord);
    }

    static uint8_t read_a() { return Bus::template in<kPortA>(); }
    static uint8_t read_b() { return Bus::template in<kPortB>(); }
    /// Inputs, and outputs as they were written.
    static uint8_t read_c() { return Bus::template in<kPortC>(); }
    static void write_a(uint8_t value) { Bus::template out<kPortA>(value); }
    static void write_b(uint8_t value) { Bus::template out<kPortB>(value); }
    static void write_c(uint8_t value) { Bus::template out<kPortC>(value); }

    /// Some bits of port C, all outputs; the others keep their levels. @context interrupts disabled
    template <uint8_t kMask>
    static void replace_c(uint8_t value) {
        write_c((read_c() & static_cast<uint8_t>(~kMask)) | (value & kMask));
    }

    /// One bit of port C; the others keep their levels, also against an interrupt in between.
    /// @tparam kMask  the bit's mask, one of the eight powers of two
    /// @ref  "Single Bit Set/Reset Feature"
    template <uint8_t kMask>
    static void put_c(bool level) {
        command_c(level ? kClearWord<kMask> | 1 : kClearWord<kMask>);
    }
    template <uint8_t kMask>
    static void set_c() {
        put_c<kMask>(true);
    }
    template <uint8_t kMask>
    static void clear_c() {
        put_c<kMask>(false);
    }

    /// The same by control word: kClearWord, or that with bit 0 set.
    static void command_c(uint8_t word) { Bus::template out<kControl>(word); }

private:
    template <uint8_t kMask>
    static constexpr uint8_t bit_word() {
        static_assert(kMask != 0 && (kMask & (kMask - 1)) == 0, "one bit");
        uint8_t word = 0;
        for (uint8_t rest = kMask; rest != 1; rest >>= 1) word += 2;
        return word;
    }

public:
    /// Control word that clears a bit of port C: its number in bits 3 to 1.
    template <uint8_t kMask>
    static constexpr uint8_t kClearWord = bit_word<kMask>();
};

}  // namespace hal
