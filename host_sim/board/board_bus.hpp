// board_bus.hpp - the wiring of RB-85: address and port decoding, interrupt lines, outside events.
// Depends on   board_state.hpp.
// Use          a Bus for the interpreters. Holds a reference only; all state is in BoardState.
#pragma once

#include <cstdint>

#include "host_sim/board/board_state.hpp"

namespace host_sim {

class BoardBus {
public:
    explicit BoardBus(BoardState& state) : s_(state) {}

    // -- Bus cycles (host_sim/cpu/reference.hpp) -------------------------------------------------
    uint8_t fetch(uint16_t address, uint64_t t) { return read(address, t); }
    uint8_t operand(uint16_t address, uint64_t t) { return read(address, t); }
    uint8_t read(uint16_t address, uint64_t t);
    void write(uint16_t address, uint8_t value, uint64_t t);
    uint8_t in(uint8_t port, uint64_t t);
    void out(uint8_t port, uint8_t value, uint64_t t);
    uint8_t acknowledge(uint64_t) { return chips::kOpenBus; }  // INTR is tied low
    void update_pins(uint64_t t) { advance(t); }
    void serial_out(bool level, uint64_t t);

    // -- Time
    // --------------------------------------------------------------------------------------
    /// Everything that happens by itself up to the beginning of T-state `t`, in the order of time.
    void advance(uint64_t t) {
        while (s_.event_t <= t) handle_event();
    }
    /// Lets a stimulus act now.
    void apply(const Stimulus& stimulus);

    /// The RESET line: processor, USART, parallel ports and motors. Timers, EEPROM and converter
    /// have no such pin.
    void reset(uint64_t t);
    /// The interrupt lines as they are, for a processor that has just been reset.
    void find_lines(uint64_t t);

    /// The PC that violations report.
    void set_instruction_pc(uint16_t pc) { instruction_pc_ = pc; }

private:
    void handle_event();
    void find_event();
    void follow_outputs(uint64_t t);
    void follow_interrupt_lines(uint64_t t);
    void follow_eeprom();
    void follow_watchdog(uint64_t t);
    void violate(Violation::Kind kind, uint16_t address, uint8_t value, uint64_t t);
    uint8_t read_ppi(unsigned index, uint8_t address, uint64_t t);

    BoardState& s_;
    uint16_t instruction_pc_ = 0;
};

}  // namespace host_sim
