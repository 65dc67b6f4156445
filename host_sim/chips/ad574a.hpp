// ad574a.hpp - AD574A 12-bit successive-approximation converter on an 8-bit bus.
// Source       Analog Devices AD574A data sheet (rev. B).
// Depends on   host_sim/chips/chip.hpp.
// Modelled     12- and 8-bit conversions, each bit decided with the input of its own moment; bytes
//              left-justified (12/8 low); outputs off and starts ignored while STS is high.
// Not modelled linearity and offset errors, noise, STS delay (below 2 T).
// Page         docs/chips/ad574a.md
#pragma once

#include <cstdint>

#include "host_sim/chips/chip.hpp"

namespace host_sim::chips {

struct Ad574a {
    /// Range and speed; the defaults are +-5 V and the longest times of the data sheet.
    struct Settings {
        int32_t low_uv = -5'000'000;   ///< voltage of code 000h
        int32_t span_uv = 10'000'000;  ///< 4096 codes
        uint64_t conversion12_ns = 35'000;
        uint64_t conversion8_ns = 24'000;

        bool operator==(const Settings&) const = default;
    };

    explicit Ad574a(uint64_t clock_hz) : Ad574a(clock_hz, Settings{}) {}
    Ad574a(uint64_t clock_hz, const Settings& wanted);

    /// The part has no RESET pin: a conversion goes on.
    void reset() {}
    /// Bit 0 of the address is A0: 0 reads the upper 8 bits, 1 the lower 4 bits and four zeros.
    /// While a conversion runs nothing drives the bus.
    uint8_t read(uint16_t address, uint64_t now_t);
    /// Starts a conversion of 12 (A0 = 0) or 8 bits (A0 = 1); the byte does not matter.
    void write(uint16_t address, uint8_t value, uint64_t now_t);
    void advance(uint64_t now_t);
    /// T-state at which the next bit is decided; the last one is the end of the conversion.
    [[nodiscard]] uint64_t next_event_t() const;

    /// Voltage at the analogue input from `now_t` on. A bit that is decided at `now_t` sees it, so
    /// the input is set before the converter is advanced to the same time.
    void set_input(int32_t voltage_uv, uint64_t now_t);
    /// STS: a conversion runs at `now_t`.
    [[nodiscard]] bool busy(uint64_t now_t) const { return converting && now_t < end_t(); }
    /// End of the last conversion started.
    [[nodiscard]] uint64_t end_t() const { return start_t + duration_t; }
    [[nodiscard]] Properties properties() const;

    Settings settings;
    uint64_t conversion12_t = 0;
    uint64_t conversion8_t = 0;

    int32_t input_uv = 0;
    bool converting = false;
    uint64_t start_t = 0;
    uint64_t duration_t = 0;
    uint8_t bit_count = 12;  ///< of the conversion: 12 or 8
    uint8_t bits_decided = 0;
    bool input_moved = false;  ///< the input has changed since the start
    uint16_t code = 0;         ///< successive approximation register, 12 bits

    uint64_t conversion_count = 0;   ///< completed
    uint64_t busy_start_count = 0;   ///< starts ignored
    uint64_t busy_read_count = 0;    ///< reads of a bus that nothing drives
    uint64_t moved_input_count = 0;  ///< conversions while the input changed

    bool operator==(const Ad574a&) const = default;

private:
    [[nodiscard]] uint64_t decision_t(uint8_t bit) const;
    void decide_bit();
};

}  // namespace host_sim::chips
