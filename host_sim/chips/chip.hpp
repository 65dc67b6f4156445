// chip.hpp - what all chip models share: time in T-states of the processor's clock, and properties.
// Depends on   the standard library.
// A model is   a plain, copyable struct with operator== (so a board snapshot is a copy) and
//                reset()                         the RESET pin
//                read(address, now_t)            a bus read that is complete at the end of now_t
//                write(address, value, now_t)
//                advance(now_t)                  brings the model to now_t; read and write do it
//                too next_event_t()                  when an output may next change by itself, or
//                kNever properties()                    its registers and state, for people
//              Times never go back. advance() in one stride or in many leaves the same state. The
//              board calls advance(next_event_t()), so an output is seen to change at its T-state.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace host_sim::chips {

/// No event without a further access.
inline constexpr uint64_t kNever = UINT64_MAX;

/// What a read yields when nothing drives the data bus: the pull-ups win.
inline constexpr uint8_t kOpenBus = 0xFF;

/// T-states of a clock of `clock_hz` that last at least `ns` nanoseconds (rounded up; exact).
[[nodiscard]] constexpr uint64_t t_states_from_ns(uint64_t ns, uint64_t clock_hz) {
    constexpr uint64_t kNsPerSecond = 1'000'000'000;
    const uint64_t seconds = ns / kNsPerSecond;
    const uint64_t rest = ns % kNsPerSecond;
    return seconds * clock_hz + (rest * clock_hz + kNsPerSecond - 1) / kNsPerSecond;
}

/// One line of a chip's state as the debugger shows it.
struct Property {
    std::string name;
    std::string value;
};
using Properties = std::vector<Property>;

}  // namespace host_sim::chips
