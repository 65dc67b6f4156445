// ad574a.hpp - driver of the AD574A converter: 12 bits on an 8-bit bus, STS polled with a bound.
// Source       Analog Devices AD574A data sheet (rev. B).
// Depends on   nothing. Bus: docs/design/hal.md
// Page         docs/chips/ad574a.md
#pragma once

#include <stdint.h>

namespace hal {

/// @tparam kPort        A0 = 0: starts 12 bits, reads the upper 8; A0 = 1: reads the lower 4
/// @tparam kStatusPort  where STS is read
/// @tparam kBusyBit     its bit
template <class Bus, uint8_t kPort, uint8_t kStatusPort, uint8_t kBusyBit>
struct Ad574a {
    /// Polls of STS. One takes at least 24 T (IN, test, jump), so this is at least 216 T; a
    /// conversion takes 35 us = 108 T at most (data sheet, convert mode timing).
    static constexpr uint8_t kPollsMax = 9;

    /// Starts a conversion of 12 bits. @pre the input has settled; no conversion runs
    /// @ref  Table I
    static void start(uint8_t anything = 0) { Bus::template out<kPort>(anything); }

    [[nodiscard]] static bool busy() { return (Bus::template in<kStatusPort>() & kBusyBit) != 0; }

    /// Waits for the end of the conversion.
    /// @return  false: it still runs behind the bound, so the converter does not work
    [[nodiscard]] static bool wait() {
        uint8_t polls = kPollsMax + 1;
        do {
            if (--polls == 0) return false;
        } while (busy());
        return true;
    }

    /// Bits 11 to 4. @pre no conversion runs (else FFh)
    static uint8_t high() { return Bus::template in<kPort>(); }
    /// Bits 3 to 0, in bits 7 to 4.
    static uint8_t low() { return Bus::template in<kPort + 1>(); }
};

}  // namespace hal
