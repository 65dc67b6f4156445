// compiled_program.hpp - a module compiled, linked with the runtime and put into the memory of a
// simulated processor.
// Depends on   toolchain/codegen/compile.hpp, toolchain/asm, host_sim/cpu.
#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <functional>
#include <ostream>
#include <string>
#include <vector>

#include "host_sim/cpu/flat_machine.hpp"
#include "host_sim/cpu/interrupts.hpp"
#include "toolchain/asm/program.hpp"
#include "toolchain/codegen/compile.hpp"

namespace codegen_test {

/// The modules of toolchain/runtime, parsed once.
[[nodiscard]] const std::vector<toolchain::assembly::Module>& runtime_modules();

/// generate() with its search, without it, and the plain one.
struct NamedGenerator {
    const char* name;
    toolchain::codegen::Generator generator;
};
[[nodiscard]] std::vector<NamedGenerator> generators();
[[nodiscard]] inline std::string generator_name(
    const testing::TestParamInfo<NamedGenerator>& test) {
    return test.param.name;
}
inline void PrintTo(const NamedGenerator& generator, std::ostream* out) {
    *out << generator.name;
}

class CompiledProgram {
public:
    CompiledProgram(toolchain::codegen::Generator generator, toolchain::codegen::Module module,
                    const toolchain::codegen::CompileOptions& options = {});

    /// From reset until HLT. @errors std::runtime_error: it does not halt, or runs out of the code
    void run() {
        run([](uint64_t) { return host_sim::Interrupt::none; });
    }

    /// The same; before every instruction `interrupt` says what comes in. RST 5.5 to 7.5 are taken
    /// only where the processor would; what is not taken is lost.
    /// @param interrupt  is given the number of instructions so far
    void run(const std::function<host_sim::Interrupt(uint64_t)>& interrupt);

    [[nodiscard]] uint64_t variable(const std::string& name, unsigned size) const;
    [[nodiscard]] uint64_t word_at(uint32_t address, unsigned size) const;
    [[nodiscard]] uint64_t instructions() const { return instructions_; }
    [[nodiscard]] uint64_t t_states() const { return machine_.cpu.t; }
    /// May RST 5.5 to 7.5 come now?
    [[nodiscard]] bool enabled() const { return machine_.cpu.interrupt_enable; }
    [[nodiscard]] uint32_t accepted() const { return accepted_; }
    /// Lowest stack pointer seen, as bytes below the top.
    [[nodiscard]] uint32_t deepest_stack() const { return deepest_stack_; }
    [[nodiscard]] const toolchain::codegen::Compiled& compiled() const { return compiled_; }
    [[nodiscard]] const toolchain::assembly::Program& program() const { return program_; }

private:
    void load();

    toolchain::codegen::Compiled compiled_;
    toolchain::assembly::Program program_;
    host_sim::FlatMachine machine_{host_sim::InstructionSet::documented};
    uint64_t instructions_ = 0;
    uint32_t accepted_ = 0;
    uint32_t deepest_stack_ = 0;
};

}  // namespace codegen_test
