// i82c54.hpp - driver of the 82C54 timer: counters with a 16-bit count, latched reads.
// Source       Intel 82C54 data sheet (231244).
// Depends on   nothing. Bus: docs/design/hal.md
// Reset        the part has no RESET pin: behind a reset of the processor its counters still count,
//              and OUT still interrupts, until start() is called.
// Page         docs/chips/i82c54.md
#pragma once

#include <stdint.h>

namespace hal {

/// @tparam kPort  counter 0; counters 1 and 2 and the control register follow
template <class Bus, uint8_t kPort>
struct I82c54 {
    static constexpr uint8_t kControl = kPort + 3;

    enum class Mode : uint8_t {
        terminal_count = 0,
        rate_generator = 2,
        square_wave = 3,
        software_strobe = 4,
    };

    static constexpr uint8_t kTwoBytes = 0x30;      ///< control word: LSB, then MSB
    static constexpr uint8_t kLatchAll = 0xDE;      ///< read-back: count of counters 0, 1, 2
    static constexpr uint8_t kLatchAllBoth = 0xCE;  ///< read-back: status and count of all three
    static constexpr uint8_t kNullCount = 0x40;     ///< status: the count was not loaded yet

    /// Starts a counter anew. Its next CLK pulse loads the count, the ones behind count down.
    /// @param count  0 is 65536; 1 is illegal in the modes 2 and 3
    /// @ref  "Programming the 82C54", control word format
    template <uint8_t kCounter, Mode kMode>
    static void start(uint16_t count) {
        static_assert(kCounter < 3);
        constexpr uint8_t kWord =
            kCounter << 6 | kTwoBytes | static_cast<uint8_t>(static_cast<uint8_t>(kMode) << 1);
        Bus::template out<kControl>(kWord);
        Bus::template out<kPort + kCounter>(static_cast<uint8_t>(count));
        Bus::template out<kPort + kCounter>(static_cast<uint8_t>(count >> 8));
    }

    /// The count of one counter, of one moment.
    /// @pre  its clock has loaded it (else undefined); nothing is latched
    /// @ref  "Counter Latch Command"
    template <uint8_t kCounter>
    static uint16_t count() {
        static_assert(kCounter < 3);
        Bus::template out<kControl>(kCounter << 6);
        return latched_count<kCounter>();
    }

    /// Latches the three counts at one moment. Each is then read once by latched_count().
    /// @ref  "Read-Back Command"
    static void latch_counts() { Bus::template out<kControl>(kLatchAll); }

    template <uint8_t kCounter>
    static uint16_t latched_count() {
        const uint8_t low = Bus::template in<kPort + kCounter>();
        const uint8_t high = Bus::template in<kPort + kCounter>();
        return static_cast<uint16_t>(high << 8 | low);
    }

    // -- Counting pulses from outside ------------------------------------------------------------
    // Mode 0 with the count FFFEh, the complement of 1: pulse 1 loads it, pulse n leaves ~n, and
    // behind 0 mode 0 counts on from FFFFh. So the complement of the count is n modulo 2^16 for
    // ever. Before the first pulse the count is undefined: the null count bit tells. (Mode 2 starts
    // again from its count behind 1, so it turns over modulo 2^16 only from 0.)

    /// Counts pulses from 0 on.
    /// @ref  "Mode Definitions", mode 0
    template <uint8_t kCounter>
    static void start_pulses() {
        start<kCounter, Mode::terminal_count>(0xFFFE);
    }

    /// start_pulses() for the three counters.
    static void start_all_pulses() {
        Bus::template out<kControl>(kTwoBytes);
        Bus::template out<kControl>(1 << 6 | kTwoBytes);
        Bus::template out<kControl>(2 << 6 | kTwoBytes);
        Bus::template out<kPort>(0xFE);
        Bus::template out<kPort + 1>(0xFE);
        Bus::template out<kPort + 2>(0xFE);
        Bus::template out<kPort>(0xFF);
        Bus::template out<kPort + 1>(0xFF);
        Bus::template out<kPort + 2>(0xFF);
    }

    /// Latches what pulses() needs, of three counters at one moment. Then each pulses() once.
    static void latch_pulses() { Bus::template out<kControl>(kLatchAllBoth); }

    /// CLK pulses since start_pulses(), modulo 2^16.
    /// @pre  latch_pulses()
    template <uint8_t kCounter>
    static uint16_t pulses() {
        static_assert(kCounter < 3);
        const uint8_t status = Bus::template in<kPort + kCounter>();  // latched status comes first
        const uint16_t count = latched_count<kCounter>();
        if ((status & kNullCount) != 0) return 0;
        return static_cast<uint16_t>(~count);
    }
};

}  // namespace hal
