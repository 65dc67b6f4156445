// machine.cpp - see machine.hpp.
#include "tests/target/machine.hpp"

#include <fmt/format.h>

#include <stdexcept>

namespace target_test {

namespace {

constexpr uint8_t kNeverWritten = 0xA7;

}  // namespace

Machine::Machine(const toolchain::assembly::Program& program, host_sim::InstructionSet set)
    : machine_(set), stack_(program.stack) {
    // RAM holds anything when the power comes on.
    machine_.memory.bytes.fill(kNeverWritten);
    for (std::size_t address = 0; address < toolchain::assembly::kMemorySize; ++address) {
        if (!program.image.present[address]) continue;
        machine_.memory.bytes[address] = program.image.bytes[address];
        rom_addresses_.push_back(static_cast<uint16_t>(address));
        rom_bytes_.push_back(program.image.bytes[address]);
    }
    for (const toolchain::assembly::Symbol& symbol : program.symbols) {
        symbols_[symbol.name] = symbol.value;
        sizes_[symbol.name] = symbol.size;
    }
    machine_.cpu.pc = program.start.value_or(0);
}

uint64_t Machine::run(uint64_t limit_t) {
    const uint64_t begin = machine_.cpu.t;
    machine_.cpu.halted = false;
    const host_sim::RunEnd end = machine_.run(begin + limit_t);
    if (end == host_sim::RunEnd::undefined_instruction) {
        throw std::runtime_error(fmt::format("no instruction at {:04X}H", machine_.cpu.pc));
    }
    if (end != host_sim::RunEnd::halted) {
        throw std::runtime_error(
            fmt::format("no HLT within {} T-states; PC {:04X}H", limit_t, machine_.cpu.pc));
    }
    return machine_.cpu.t - begin;
}

uint64_t Machine::read(uint16_t address, unsigned bytes) const {
    uint64_t value = 0;
    for (unsigned i = bytes; i-- > 0;) {
        value = value << 8 | machine_.memory.bytes[static_cast<uint16_t>(address + i)];
    }
    return value;
}

void Machine::write(uint16_t address, unsigned bytes, uint64_t value) {
    for (unsigned i = 0; i < bytes; ++i) {
        machine_.memory.bytes[static_cast<uint16_t>(address + i)] =
            static_cast<uint8_t>(value >> (8 * i));
    }
}

void Machine::write(uint16_t address, std::span<const uint8_t> bytes) {
    for (const uint8_t byte : bytes) machine_.memory.bytes[address++] = byte;
}

uint32_t Machine::stack_used() const {
    for (uint32_t i = 0; i < stack_.size; ++i) {
        if (machine_.memory.bytes[stack_.first + i] != kNeverWritten) return stack_.size - i;
    }
    return 0;
}

bool Machine::rom_is_intact() const {
    for (std::size_t i = 0; i < rom_addresses_.size(); ++i) {
        if (machine_.memory.bytes[rom_addresses_[i]] != rom_bytes_[i]) return false;
    }
    return true;
}

}  // namespace target_test
