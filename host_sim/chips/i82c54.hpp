// i82c54.hpp - 82C54 programmable interval timer: three 16-bit counters in modes 0 to 5.
// Source       Intel 82C54 data sheet (231244).
// Depends on   host_sim/chips/chip.hpp.
// Modelled     all modes, binary and BCD, byte order flip-flops, count and status latches, null
//              count, gate levels and triggers. Any stretch of time is computed in closed form.
// Not modelled set-up and hold times: a CLK pulse is one instant, its falling edge.
// Page         docs/chips/i82c54.md
#pragma once

#include <array>
#include <cstdint>

#include "host_sim/chips/chip.hpp"

namespace host_sim::chips {

/// Three counters and a control register. Accesses, gates and pulses come in the order of their
/// times; what happens at T-state t counts from the first CLK pulse after t.
struct I82c54 {
    static constexpr unsigned kCounterCount = 3;
    static constexpr uint16_t kControlAddress = 3;  ///< 0 to 2 are the counters
    /// Count of a counter that was not loaded since its control word (undefined on the part).
    static constexpr uint16_t kUndefinedCount = 0xA5A5;

    /// One counter, its wires first.
    struct Counter {
        uint64_t clock_period_t = 0;  ///< T-states between CLK pulses; 0: pulses from outside
        uint64_t next_pulse_t = kNever;
        bool gate = true;
        bool watched = true;  ///< output changes are events

        bool programmed = false;
        uint8_t control = 0;     ///< bits 5 to 0 of the control word, as written
        bool write_msb = false;  ///< flip-flops of two-byte counts
        bool read_msb = false;
        uint8_t written_lsb = 0;
        uint32_t count = 0;  ///< count register, 1 to 65536 (10000 in BCD); 0: none since control
        bool null_count = false;  ///< the count register was not loaded yet
        bool load_pending = false;
        bool trigger = false;    ///< the gate's edge flip-flop
        bool inhibited = false;  ///< mode 0 between the two bytes of a count

        bool loaded = false;  ///< counts since its control word
        /// CLK pulses to the terminal count (modes 0, 1, 4, 5: the count itself), to the reload
        /// (mode 2: the count) or to the end of the half cycle (mode 3).
        uint32_t value = 0;
        uint32_t cycle_count = 0;  ///< the count that `value` was loaded from
        bool expired = false;      ///< modes 0, 1, 4, 5: terminal count was reached
        bool low_half = false;     ///< mode 3
        bool output = false;

        bool count_latched = false;
        bool status_latched = false;
        uint16_t latched_count = 0;
        uint8_t latched_status = 0;

        bool operator==(const Counter&) const = default;
    };

    /// Power-up: nothing is programmed, outputs low. Wires (clocks, gates, watching) and time stay.
    /// The part has no RESET pin: a board's reset leaves it running.
    void reset();

    /// @param address  bits 1 and 0 count: counter 0, 1, 2, control (reads as open bus)
    uint8_t read(uint16_t address, uint64_t now_t);
    void write(uint16_t address, uint8_t value, uint64_t now_t);
    void advance(uint64_t now_t);
    /// The next change of a watched output of a counter with periodic clock, exactly.
    [[nodiscard]] uint64_t next_event_t() const { return event_t; }

    /// CLK of `counter` falls at every T-state that is `phase_t` modulo `period_t` (not 0), from
    /// the last advance on.
    void set_periodic_clock(unsigned counter, uint64_t period_t, uint64_t phase_t = 0);
    /// CLK of `counter` comes from clock_pulse, as after construction.
    void set_external_clock(unsigned counter);
    /// One CLK pulse with its falling edge at `now_t`. @pre set_external_clock
    void clock_pulse(unsigned counter, uint64_t now_t) { clock_pulses(counter, 1, now_t); }
    /// So many pulses, all of them before the next access.
    void clock_pulses(unsigned counter, uint64_t pulse_count, uint64_t now_t);
    /// GATE; high after construction.
    void set_gate(unsigned counter, bool level, uint64_t now_t);
    /// Whether next_event_t() tells of the changes of this output. A baud rate clock would make
    /// one every few T-states: switch it off there.
    void watch_output(unsigned counter, bool watched);

    /// OUT, as of the last advance.
    [[nodiscard]] bool output(unsigned counter) const { return counters[counter].output; }
    /// Period of OUT in T-states while it runs in mode 2 or 3 from a periodic clock, else 0. A new
    /// count shows at once, though OUT first ends its cycle. Can change with write and set_gate.
    [[nodiscard]] uint64_t output_period_t(unsigned counter) const;
    [[nodiscard]] Properties properties() const;

    std::array<Counter, kCounterCount> counters{};
    uint64_t last_t = 0;        ///< of the last advance
    uint64_t event_t = kNever;  ///< what next_event_t() returns

    uint64_t unprogrammed_access_count = 0;  ///< counter read or written before its control word
    uint64_t undefined_read_count = 0;  ///< count read before it was loaded, status not latched
    uint64_t live_read_count = 0;       ///< count read without latch: two bytes may not match
    uint64_t illegal_count_count = 0;   ///< 1 in mode 2 or 3; BCD digits above 9
    uint64_t lost_latch_count = 0;      ///< latched again before the first was read

    bool operator==(const I82c54&) const = default;

private:
    void write_control(uint8_t value);
    void write_count(Counter& counter, uint8_t value);
    void take_count(Counter& counter, uint16_t bits);
    void latch_count(Counter& counter, bool status_tells);
    void find_event();
};

}  // namespace host_sim::chips
