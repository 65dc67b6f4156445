// i82c54_reference.hpp - one 82C54 counter in two-byte access, clock pulse by clock pulse.
// Why          the model computes stretches of time in closed form; this one takes every pulse as
//              the data sheet's "Mode Definitions" tell it, and counts BCD digit by digit.
// Depends on   the standard library.
#pragma once

#include <cstdint>

namespace host_sim::chips_test {

/// A counter; counts of 1 in modes 2 and 3 are not for it.
struct TimerReference {
    unsigned mode = 0;
    bool bcd = false;
    bool gate = true;
    bool edge = false;     ///< gate's edge flip-flop
    bool written = false;  ///< there is a count in the register
    bool to_load = false;
    bool running = false;  ///< loaded since the control word
    bool stopped = false;  ///< mode 0 between two bytes
    bool done = false;
    bool odd = false;
    bool output = false;
    bool high_half = true;
    bool null_count = false;
    uint16_t count_register = 0;
    uint16_t element = 0;

    void write_control(unsigned new_mode, bool new_bcd) {
        const bool level = gate;
        *this = TimerReference{};
        gate = level;
        mode = new_mode;
        bcd = new_bcd;
        output = mode != 0;
        null_count = true;
    }

    void write_first_byte() {
        if (mode == 0) {
            stopped = true;
            output = false;
        }
    }

    void write_count(uint16_t bits) {
        count_register = bits;
        written = true;
        null_count = true;
        stopped = false;
        const bool at_once = mode == 0 || mode == 4;
        const bool first = (mode == 2 || mode == 3) && !running;
        to_load = to_load || at_once || first;
    }

    void set_gate(bool level) {
        edge = edge || (level && !gate && mode != 0 && mode != 4);
        if (!level && (mode == 2 || mode == 3)) {
            output = true;
        }
        gate = level;
    }

    void pulse() {
        const bool load_now = to_load || (edge && written);
        edge = false;
        if ((mode == 4 || mode == 5)) {
            output = true;
        }
        if (load_now) {
            load();
            high_half = true;
            output = mode != 0 && mode != 1;
            done = false;
            return;
        }
        const bool enabled = gate || mode == 1 || mode == 5;
        if (!running || !enabled || stopped) {
            return;
        }
        if (mode == 3) {
            pulse_square();
            return;
        }
        if (mode == 2 && element == 1) {
            load();
            output = true;
            return;
        }
        decrement();
        if (mode == 2) {
            output = element != 1;
        } else if (element == 0 && !done) {
            done = true;
            output = mode == 0 || mode == 1;
        }
    }

    [[nodiscard]] uint16_t count() const { return running ? element : uint16_t{0xA5A5}; }

private:
    void load() {
        element = count_register;
        odd = (element & 1) != 0;
        if (mode == 3 && odd) {
            decrement();
        }
        to_load = false;
        null_count = false;
        running = true;
    }

    void pulse_square() {
        const uint16_t last = odd && high_half ? 0 : 2;
        if (element == last) {
            high_half = !high_half;
            output = high_half;
            load();
            return;
        }
        decrement();
        decrement();
    }

    void decrement() {
        if (!bcd) {
            --element;
            return;
        }
        for (unsigned shift = 0; shift < 16; shift += 4) {
            if ((element >> shift & 0xF) != 0) {
                element = static_cast<uint16_t>(element - (1U << shift));
                return;
            }
            element = static_cast<uint16_t>(element | 9U << shift);
        }
    }
};

}  // namespace host_sim::chips_test
