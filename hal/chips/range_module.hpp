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
/// @tparam kAckBit     of port C, input
/// @tparam kStrobeBit  of port C, output
/// @tparam kSelectBit  of port C, output
template <class Ppi, uint8_t kAckBit, uint8_t kStrobeBit, uint8_t kSelectBit>
struct RangeModule {
    /// Polls of ACKNOWLEDGE. One takes at least 27 T (IN, ANI or XRA, jump), so this is at least
    /// 100 us; a module needs 20 us.
    static constexpr uint8_t kPollsMax = 12;
    static constexpr uint8_t kSum = 0xA5;

    /// Reads the newest scan. Deselects the module in every case.
    /// @param frame  meaningless unless ok
    [[nodiscard]] static RangeStatus read(RangeFrame& frame) {
        uint8_t* next = reinterpret_cast<uint8_t*>(&frame);
        uint8_t lines = kSelectBit;
        uint8_t sum = 0;
        RangeStatus status = RangeStatus::ok;
        for (uint8_t left = sizeof(RangeFrame) + 1;;) {
            Ppi::write_c(lines);
            if (!acknowledged(lines)) {
                status = RangeStatus::absent;
                break;
            }
            const uint8_t value = Ppi::read_a();
            sum = static_cast<uint8_t>(sum + value);
            if (--left == 0) {
                if (sum != kSum) status = RangeStatus::checksum;
                break;
            }
            *next++ = value;
            lines ^= kStrobeBit;
        }
        Ppi::write_c(0);
        return status;
    }

private:
    /// Waits until ACKNOWLEDGE is what STROBE is.
    static bool acknowledged(uint8_t lines) {
        const uint8_t wanted = (lines & kStrobeBit) != 0 ? kAckBit : 0;
        for (uint8_t polls = kPollsMax; polls != 0; --polls) {
            if ((Ppi::read_c() & kAckBit) == wanted) return true;
        }
        return false;
    }
};

}  // namespace hal
