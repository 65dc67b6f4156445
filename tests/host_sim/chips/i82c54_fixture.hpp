// i82c54_fixture.hpp - what the tests of the 82C54 share: a programmed timer, its counts and edges.
// Depends on   host_sim/chips/i82c54.hpp.
#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <utility>
#include <vector>

#include "host_sim/chips/i82c54.hpp"

namespace host_sim::chips_test {

using chips::I82c54;

using Edges = std::vector<std::pair<uint64_t, bool>>;

inline constexpr uint8_t kLsb = 0x10;
inline constexpr uint8_t kMsb = 0x20;
inline constexpr uint8_t kBoth = 0x30;
inline constexpr uint8_t kBcd = 0x01;
inline constexpr uint8_t kStatusOutput = 0x80;
inline constexpr uint8_t kStatusNull = 0x40;

constexpr uint8_t control(unsigned counter, uint8_t access, unsigned mode, uint8_t bcd = 0) {
    return static_cast<uint8_t>(counter << 6 | access | mode << 1 | bcd);
}

/// A timer at T-state 10 whose counter 0 has its control word and runs from a clock of 1 T.
inline I82c54 timer_in_mode(unsigned mode, uint8_t access = kLsb) {
    I82c54 timer;
    timer.set_periodic_clock(0, 1);
    timer.write(I82c54::kControlAddress, control(0, access, mode), 10);
    return timer;
}

/// LSB of the count, read live at each of the next `size` T-states.
inline std::vector<int> counts(I82c54& timer, unsigned size) {
    std::vector<int> list;
    for (unsigned n = 0; n < size; ++n) {
        list.push_back(timer.read(0, timer.last_t + 1));
    }
    return list;
}

/// Output edges of counter 0 up to `end_t`, found from event to event.
inline Edges edges_until(I82c54& timer, uint64_t end_t) {
    Edges edges;
    bool level = timer.output(0);
    while (timer.next_event_t() <= end_t) {
        timer.advance(timer.next_event_t());
        if (timer.output(0) != level) {
            level = !level;
            edges.emplace_back(timer.last_t, level);
        }
    }
    timer.advance(end_t);
    EXPECT_EQ(timer.output(0), level) << "an edge that next_event_t() did not tell of";
    return edges;
}

inline uint8_t status_of(I82c54& timer, unsigned counter = 0) {
    timer.write(I82c54::kControlAddress, static_cast<uint8_t>(0xE0 | 2U << counter), timer.last_t);
    return timer.read(static_cast<uint16_t>(counter), timer.last_t);
}

inline uint16_t read_two(I82c54& timer, unsigned counter, uint64_t t) {
    const unsigned lsb = timer.read(static_cast<uint16_t>(counter), t);
    const unsigned msb = timer.read(static_cast<uint16_t>(counter), t);
    return static_cast<uint16_t>(msb << 8 | lsb);
}

inline void write_two(I82c54& timer, unsigned counter, unsigned count, uint64_t t) {
    timer.write(static_cast<uint16_t>(counter), static_cast<uint8_t>(count), t);
    timer.write(static_cast<uint16_t>(counter), static_cast<uint8_t>(count >> 8), t);
}

}  // namespace host_sim::chips_test
