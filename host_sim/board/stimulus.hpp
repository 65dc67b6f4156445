// stimulus.hpp - something that happens to the board from outside at a T-state.
// Depends on   the standard library.
#pragma once

#include <cstdint>

namespace host_sim {

/// One outside event. Kept in the board's state until its time has come.
struct Stimulus {
    enum class Kind : uint8_t {
        sensor,          ///< index: multiplexer input; value: microvolts
        tach_pulse,      ///< index: wheel
        tach_forward,    ///< index: wheel; value: 1 turns forward, 0 backward
        tach_connected,  ///< index: wheel; value: 1 plugged in, 0 not
        detectors,       ///< value: the eight laser detector bits
        undervoltage,    ///< value: 1 pulls TRAP
        bumper,          ///< value: 1 pulls TRAP
        service,         ///< value: level of SID, the service jumper
        serial_byte,     ///< value: a byte from the ground at the link's baud rate
        reset_button,    ///< pressed and let go
    };
    uint64_t t = 0;
    Kind kind = Kind::sensor;
    uint8_t index = 0;
    int32_t value = 0;

    bool operator==(const Stimulus&) const = default;
};

}  // namespace host_sim
