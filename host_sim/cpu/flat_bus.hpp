// flat_bus.hpp - 64 KB of RAM and nothing else: the bus of plain programs.
// Depends on   flat_memory.hpp, reference.hpp.
#pragma once

#include <cstdint>

#include "host_sim/cpu/flat_memory.hpp"
#include "host_sim/cpu/reference.hpp"

namespace host_sim {

/// Every address is RAM, every port reads FFH (open bus), INTA reads RST 7 (FFH).
struct FlatBus {
    FlatMemory& memory;

    [[nodiscard]] uint8_t fetch(uint16_t address, uint64_t) const { return memory.bytes[address]; }
    [[nodiscard]] uint8_t operand(uint16_t address, uint64_t) const {
        return memory.bytes[address];
    }
    [[nodiscard]] uint8_t read(uint16_t address, uint64_t) const { return memory.bytes[address]; }
    void write(uint16_t address, uint8_t value, uint64_t) const { memory.bytes[address] = value; }
    [[nodiscard]] uint8_t in(uint8_t, uint64_t) const { return 0xFF; }
    void out(uint8_t, uint8_t, uint64_t) const {}
    [[nodiscard]] uint8_t acknowledge(uint64_t) const { return 0xFF; }
    void update_pins(uint64_t) const {}
    void serial_out(bool, uint64_t) const {}
};

}  // namespace host_sim
