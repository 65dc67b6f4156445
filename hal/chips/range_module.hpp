// range_module.hpp - driver of the range module behind an 82C55A: reads one frame.
// Source       docs/chips/range-module.md (own design; section "Behaviour and timing").
// Depends on   hal/io.hpp (how many samples), an 82C55A driver.
// Page         docs/chips/range-module.md
#pragma once

#include <stdint.h>

#include "hal/io.hpp"

namespace hal {

enum class RangeStatus : uint8_t {
    ok = 0,
    absent,    ///< no answer within the bound: no module, or it went away
    checksum,  ///< 19 bytes came, and their sum is not A5h
};

/// A scan as the module sends it: the order of the members is the order of the bytes.
struct RangeFrame {
    uint8_t scan_count;                  ///< modulo 2^8; 0: no scan yet; unchanged: stale
    uint8_t present;                     ///< bit i: sample i was measured
    int16_t heights[kRangeSampleCount];  ///< s16 Q1 mm, ground, body frame; 0 when absent
};
static_assert(sizeof(RangeFrame) == 2 + 2 * kRangeSampleCount);

/// @tparam Ppi         I82c55a: port A has the data, port C the other lines
/// @tparam kAckBit     mask in port C, input
/// @tparam kStrobeBit  mask in port C, output
/// @tparam kSelectBit  mask in port C, output
/// @tparam kHigh       other outputs of port C: they are high and stay so
template <class Ppi, uint8_t kAckBit, uint8_t kStrobeBit, uint8_t kSelectBit, uint8_t kHigh = 0>
struct RangeModule {
    static_assert(kAckBit == 1, "ACKNOWLEDGE is compared with bit 0 of a control word");

    /// Polls of ACKNOWLEDGE for a byte. One takes at least 27 T (IN, test, jump), so they last at
    /// least 100 us; a module needs 20 us.
    static constexpr uint8_t kPollsMax = 12;
    static constexpr uint8_t kSum = 0xA5;

    /// Reads the newest scan. Deselects the module in every case.
    /// @param frame  meaningless unless ok
    [[nodiscard]] static RangeStatus read(RangeFrame& frame) {
        uint8_t* next = reinterpret_cast<uint8_t*>(&frame);
        uint8_t sum = 0;
        uint8_t strobe = Ppi::template kClearWord<kStrobeBit>;  // bit 0: its level
        uint8_t left = sizeof(RangeFrame) + 1;
        RangeStatus status = RangeStatus::absent;
        Ppi::write_c(kSelectBit | kHigh);
        while (acknowledged(strobe)) {
            const uint8_t value = Ppi::read_a();
            if (--left == 0) {
                sum = static_cast<uint8_t>(sum + value);
                status = sum == kSum ? RangeStatus::ok : RangeStatus::checksum;
                break;
            }
            strobe ^= 1;
            Ppi::command_c(strobe);
            *next++ = value;  // while the module fetches the next byte
            sum = static_cast<uint8_t>(sum + value);
        }
        Ppi::write_c(kHigh);
        return status;
    }

private:
    /// Waits until ACKNOWLEDGE is what STROBE is.
    static bool acknowledged(uint8_t strobe) {
        uint8_t polls = kPollsMax + 1;
        do {
            if (--polls == 0) return false;
        } while (((Ppi::read_c() ^ strobe) & kAckBit) != 0);
        return true;
    }
};

}  // namespace hal
