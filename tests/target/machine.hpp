// machine.hpp - a compiled program on the simulated processor, run from one HLT to the next.
// Depends on   toolchain/asm (Program), host_sim/cpu/flat_machine.hpp.
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "host_sim/cpu/flat_machine.hpp"
#include "toolchain/asm/program.hpp"

namespace target_test {

class Machine {
public:
    explicit Machine(const toolchain::assembly::Program& program,
                     host_sim::InstructionSet set = host_sim::InstructionSet::documented);

    /// Goes on up to the next HLT.
    /// @return  T-states taken, HLT included
    /// @errors  std::runtime_error: no HLT within `limit_t`, or an instruction that does not exist
    uint64_t run(uint64_t limit_t = 50'000'000);

    /// @errors std::out_of_range
    [[nodiscard]] uint16_t address(const std::string& symbol) const { return symbols_.at(symbol); }
    /// Bytes that a symbol names. @errors std::out_of_range
    [[nodiscard]] uint32_t size(const std::string& symbol) const { return sizes_.at(symbol); }

    [[nodiscard]] uint64_t read(uint16_t address, unsigned bytes) const;
    void write(uint16_t address, unsigned bytes, uint64_t value);
    void write(uint16_t address, std::span<const uint8_t> bytes);
    [[nodiscard]] std::span<const uint8_t> bytes(uint16_t address, uint32_t size) const {
        return std::span(machine_.memory.bytes).subspan(address, size);
    }

    [[nodiscard]] host_sim::FlatMachine& machine() { return machine_; }
    /// Bytes of the stack's region that have ever been written.
    [[nodiscard]] uint32_t stack_used() const;
    /// Nothing has written to the program's ROM.
    [[nodiscard]] bool rom_is_intact() const;

private:
    host_sim::FlatMachine machine_;
    std::map<std::string, uint16_t> symbols_;
    std::map<std::string, uint32_t> sizes_;
    toolchain::assembly::Region stack_;
    std::vector<uint16_t> rom_addresses_;
    std::vector<uint8_t> rom_bytes_;
};

}  // namespace target_test
