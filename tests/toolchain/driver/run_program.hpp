// run_program.hpp - a compiled program on the simulated processor.
// Depends on   toolchain/driver, host_sim/cpu/flat_machine.hpp.
#pragma once

#include <cstdint>
#include <stdexcept>
#include <string>

#include "host_sim/cpu/flat_machine.hpp"
#include "toolchain/driver/driver.hpp"

namespace driver_test {

/// A machine with a program in it; memory that the program leaves out holds 5AH, so that what
/// nobody initialised does not happen to be 0.
class Machine {
public:
    explicit Machine(const toolchain::driver::Result& result,
                     host_sim::InstructionSet set = host_sim::InstructionSet::documented)
        : program_(result.program), machine_(set) {
        for (std::size_t address = 0; address < toolchain::assembly::kMemorySize; ++address) {
            machine_.memory.bytes[address] =
                program_.image.present[address] ? program_.image.bytes[address] : 0x5A;
        }
        machine_.cpu.pc = program_.start.value();
    }

    /// Runs to HLT. @errors std::runtime_error: anything else ends the run
    void run(uint64_t most_t = 50'000'000) {
        const host_sim::RunEnd end = machine_.run(machine_.cpu.t + most_t);
        if (end != host_sim::RunEnd::halted) {
            throw std::runtime_error("the program did not halt, but stopped at " +
                                     std::to_string(machine_.cpu.pc));
        }
    }

    [[nodiscard]] uint64_t variable(const std::string& name, unsigned bytes) const {
        const toolchain::assembly::Symbol* symbol = program_.find(name);
        if (symbol == nullptr) throw std::runtime_error("no symbol " + name);
        uint64_t value = 0;
        for (unsigned i = 0; i < bytes; ++i) {
            value |= uint64_t{machine_.memory.bytes[symbol->value + i]} << (8 * i);
        }
        return value;
    }

    [[nodiscard]] const host_sim::CpuState& cpu() const { return machine_.cpu; }
    [[nodiscard]] host_sim::FlatMachine& machine() { return machine_; }

private:
    const toolchain::assembly::Program& program_;
    host_sim::FlatMachine machine_;
};

}  // namespace driver_test
