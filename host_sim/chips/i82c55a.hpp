// i82c55a.hpp - 82C55A programmable peripheral interface: ports A, B, C in modes 0, 1 and 2.
// Source       Intel 82C55A data sheet (231256).
// Depends on   host_sim/chips/chip.hpp.
// Modelled     all mode combinations, bit set/reset, handshakes, interrupt requests, read-back of
//              the control word. The part has no clock: outputs follow inputs and accesses at once.
// Not modelled propagation delays; a bus-hold device that keeps a low level on port A.
// Page         docs/chips/i82c55a.md
#pragma once

#include <array>
#include <cstdint>

#include "host_sim/chips/chip.hpp"

namespace host_sim::chips {

/// Three ports of 8 pins and a control register. After reset every pin is an input.
struct I82c55a {
    enum class Port : uint8_t { a, b, c };
    static constexpr uint16_t kControlAddress = 3;  ///< 0 to 2 are ports A, B, C
    static constexpr uint8_t kResetControl = 0x9B;  ///< mode 0, all input

    /// The RESET pin: all pins inputs in mode 0, latches and handshakes cleared. What drives the
    /// pins from outside goes on driving them.
    void reset();

    /// @param address  bits 1 and 0 count: port A, B, C, control
    uint8_t read(uint16_t address, uint64_t now_t);
    void write(uint16_t address, uint8_t value, uint64_t now_t);
    void advance(uint64_t /*now_t*/) {}
    [[nodiscard]] uint64_t next_event_t() const { return kNever; }

    /// Drives pins from outside: those in `mask` take the level in `value`, the others keep
    /// theirs. A pin that was never driven is 1 (bus hold); one that is let go has to be set to 1.
    /// Levels at pins that are outputs at the time wait there until the pin is an input.
    void set_port_input(Port port, uint8_t value, uint8_t mask, uint64_t now_t);

    /// Levels that the part drives; 1 for every pin it does not drive.
    [[nodiscard]] uint8_t port_output(Port port) const;
    /// Pins that the part drives now. Port A in mode 2 drives only while ACK is low.
    [[nodiscard]] uint8_t port_output_mask(Port port) const;
    /// Levels on the wires: driven by the part, else from outside.
    [[nodiscard]] uint8_t port_level(Port port) const;
    /// Interrupt requests, PC3 and PC0. False in mode 0.
    [[nodiscard]] bool interrupt_a() const;
    [[nodiscard]] bool interrupt_b() const;
    [[nodiscard]] Properties properties() const;

    uint8_t control = kResetControl;                   ///< last mode word
    std::array<uint8_t, 3> latch{};                    ///< output latches
    std::array<uint8_t, 3> outside{0xFF, 0xFF, 0xFF};  ///< levels from outside
    std::array<uint8_t, 2> strobed{};  ///< input latches of ports A and B, modes 1 and 2

    bool input_full_a = false;  ///< IBF
    bool input_full_b = false;
    bool output_full_a = false;  ///< OBF is low
    bool output_full_b = false;
    bool input_enable_a = false;   ///< INTE at PC4; INTE 2 in mode 2
    bool output_enable_a = false;  ///< INTE at PC6; INTE 1 in mode 2
    bool enable_b = false;         ///< INTE at PC2

    uint64_t strobe_overrun_count = 0;  ///< STB while the byte before had not been read
    uint64_t output_overrun_count = 0;  ///< a byte written over one that was not acknowledged
    uint64_t empty_read_count = 0;      ///< strobed port read without a new byte
    uint64_t input_write_count = 0;     ///< port or bit written that drives no pin

    bool operator==(const I82c55a&) const = default;

private:
    enum class Mode : uint8_t { basic, strobed_input, strobed_output, bidirectional };
    [[nodiscard]] Mode mode_a() const;
    [[nodiscard]] Mode mode_b() const;
    [[nodiscard]] bool takes_a() const;
    [[nodiscard]] bool gives_a() const;
    [[nodiscard]] uint8_t handshake_pins() const;
    [[nodiscard]] uint8_t handshake_outputs() const;
    [[nodiscard]] uint8_t general_outputs() const;
    [[nodiscard]] uint8_t handshake_levels() const;
    [[nodiscard]] uint8_t status() const;
    [[nodiscard]] bool outside_c(unsigned bit) const { return (outside[2] >> bit & 1) != 0; }
    uint8_t read_port_a();
    uint8_t read_port_b();
    void write_port(uint8_t port, uint8_t value);
    void write_bit(unsigned bit, bool level);
    void set_mode(uint8_t word);
    void follow_strobes();
    void follow_control_edges(uint8_t before);
};

}  // namespace host_sim::chips
