// i8085.hpp - the real processor as the Bus of the drivers: one instruction a function.
// Depends on   <i85.h>, so it is compiled by i85cc only. Beside firmware/app (interrupt functions)
//              the one file that includes it.
// Design note  docs/design/hal.md
#pragma once

#include <i85.h>
#include <stdint.h>

namespace hal {

struct I8085 {
    /// @cost  10 T, 2 bytes each
    template <uint8_t kPort>
    static uint8_t in() {
        return __i85_in(kPort);
    }
    template <uint8_t kPort>
    static void out(uint8_t value) {
        __i85_out(kPort, value);
    }

    /// Masks, pending interrupts, interrupts enabled, SID: see i85.h. @cost 4 T each
    static uint8_t rim() { return __i85_rim(); }
    static void sim(uint8_t value) { __i85_sim(value); }

    /// Takes effect behind the next instruction.
    static void enable_interrupts() { __i85_ei(); }
    static void disable_interrupts() { __i85_di(); }
    /// Sleeps until an interrupt.
    static void halt() { __i85_hlt(); }
};

}  // namespace hal
