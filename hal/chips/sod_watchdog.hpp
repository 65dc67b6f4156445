// sod_watchdog.hpp - driver of the watchdog on SOD: 0.5 s without an edge is a reset.
// Source       8085A: SIM, bits 7 (SOD), 6 (SOD enable), 3 (mask set enable).
// Depends on   nothing. Bus: docs/design/hal.md
// Page         docs/chips/sod-watchdog.md
#pragma once

#include <stdint.h>

namespace hal {

template <class Bus>
struct SodWatchdog {
    static constexpr uint8_t kSodEnable = 0x40;  ///< SIM: bit 7 goes to SOD
    static constexpr uint8_t kSodHigh = 0x80;

    /// An edge of SOD. Interrupt masks and a pending RST 7.5 stay as they are.
    /// @context  task; never a handler, which would go on when the main loop hangs
    static void toggle() {
        level_ ^= kSodHigh;
        Bus::sim(level_ | kSodEnable);
    }

    /// Sets SOD, without memory: for code that runs before variables exist. RESET leaves it low,
    /// and toggle() takes it to be low when variables are cleared.
    template <bool kHigh>
    static void set() {
        Bus::sim(kHigh ? kSodHigh | kSodEnable : kSodEnable);
    }

private:
    static inline uint8_t level_ = 0;  ///< bit 7: SOD, which cannot be read
};

}  // namespace hal
