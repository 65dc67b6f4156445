// i8251a_fixture.hpp - what the tests of the 8251A share: a programmed USART and its flags in time.
// Depends on   host_sim/chips/i8251a.hpp.
// Times        TxC = RxC = 10 T with falling edges at multiples of 10, factor 16, so 160 T per bit
//              (19,200 baud at 3.072 MHz) and 1600 T per frame 8N1. Rising edges at 5, 15, ...
#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <ostream>
#include <vector>

#include "host_sim/chips/i8251a.hpp"

namespace host_sim::chips_test {

using chips::I8251a;
using Command = I8251a::Command;
using Format = I8251a::Format;
using Parity = I8251a::Parity;
using Status = I8251a::Status;

inline constexpr uint16_t kData = I8251a::kDataAddress;
inline constexpr uint16_t kControl = I8251a::kControlAddress;
inline constexpr uint8_t kMode8N1x16 = 0x4E;
inline constexpr uint8_t kBothWays = Command::kTransmitEnable | Command::kReceiveEnable;
inline constexpr uint64_t kClockT = 10;
inline constexpr uint64_t kBitT = 160;
inline constexpr uint64_t kBitQ8T = kBitT * 256;

/// Ready at T-state 1000.
inline I8251a ready_usart(uint8_t mode = kMode8N1x16, uint8_t command = kBothWays) {
    I8251a usart;
    usart.set_clock_period_t(kClockT, 0);
    usart.write(kControl, mode, 100);
    usart.write(kControl, command, 200);
    usart.advance(1000);
    return usart;
}

struct Change {
    uint64_t t;
    uint8_t status;
    bool operator==(const Change&) const = default;
};
inline void PrintTo(const Change& change, std::ostream* out) {
    *out << change.t << ": " << std::hex << unsigned{change.status} << std::dec;
}

/// Changes of the status register up to `end_t`, found from event to event.
inline std::vector<Change> changes_until(I8251a& usart, uint64_t end_t) {
    std::vector<Change> list;
    uint8_t status = usart.status();
    while (usart.next_event_t() <= end_t) {
        usart.advance(usart.next_event_t());
        if (usart.status() != status) {
            status = usart.status();
            list.push_back({usart.last_t, status});
        }
    }
    usart.advance(end_t);
    EXPECT_EQ(usart.status(), status) << "a change that next_event_t() did not tell of";
    return list;
}

inline std::vector<uint8_t> bytes_of(const I8251a& usart) {
    std::vector<uint8_t> list;
    for (const auto& sent : usart.transmitted) {
        list.push_back(sent.byte);
    }
    return list;
}

}  // namespace host_sim::chips_test
