// presence_buffer.hpp - 74HC244: which tachometers are plugged in, as an input port.
// Source       own circuit: a loop in each tachometer's connector pulls its line up; without the
//              plug a pull-down wins. Lines 6 and 7 are tied high.
// Depends on   host_sim/chips/chip.hpp.
// Not modelled the buffer's delay. A plug does not hold back pulses: whoever makes them decides.
// Page         docs/chips/presence-buffer.md
#pragma once

#include <cstdint>

#include "host_sim/chips/chip.hpp"

namespace host_sim::chips {

struct PresenceBuffer {
    static constexpr unsigned kWheelCount = 6;

    /// The part has no RESET pin.
    void reset() {}
    uint8_t read(uint16_t /*address*/, uint64_t /*now_t*/) { return lines; }
    void advance(uint64_t /*now_t*/) {}
    [[nodiscard]] uint64_t next_event_t() const { return kNever; }

    /// Plugs a tachometer in or out. @param wheel  [0, kWheelCount)
    void set_connected(unsigned wheel, bool plugged);
    [[nodiscard]] Properties properties() const;

    uint8_t lines = kOpenBus;  ///< all plugged in

    bool operator==(const PresenceBuffer&) const = default;
};

}  // namespace host_sim::chips
