// presence_buffer.hpp - driver of the 74HC244 that tells which tachometers are plugged in.
// Depends on   nothing. Bus: docs/design/hal.md
// Page         docs/chips/presence-buffer.md
#pragma once

#include <stdint.h>

namespace hal {

template <class Bus, uint8_t kPort>
struct PresenceBuffer {
    static constexpr uint8_t kWheels = 0x3F;

    /// Bit w is 1 when the tachometer of hal::Wheel w is plugged in; bits 6 and 7 are 0.
    /// @cost  one access
    static uint8_t wheels() { return Bus::template in<kPort>() & kWheels; }
};

}  // namespace hal
