// generated_program.hpp - functions of the back end's representation as a program in the simulator.
// Depends on   toolchain/codegen behind lower_calls(), toolchain/asm, toolchain/runtime/*.s85,
// host_sim. Why          generate() alone is tested here: frames do not overlap, nothing is shared.
#pragma once

#include <cstdint>
#include <map>
#include <string>

#include "host_sim/cpu/flat_machine.hpp"
#include "toolchain/asm/program.hpp"
#include "toolchain/codegen/generate.hpp"
#include "toolchain/codegen/mir.hpp"

namespace codegen_test {

class GeneratedProgram {
public:
    /// @param ask_clobbers  what a call changes is known if the callee comes earlier in the module
    explicit GeneratedProgram(const toolchain::codegen::Module& lowered,
                              toolchain::codegen::GenerateOptions options = {},
                              bool ask_clobbers = false);

    /// Calls a function without arguments and runs it up to its return.
    /// @return T-states from its first instruction up to and with its RET
    /// @errors std::runtime_error: it does not come back, or with another stack pointer
    uint64_t call(const std::string& name, uint64_t limit_t = 400'000'000);

    [[nodiscard]] uint64_t variable(const std::string& name, unsigned size) const;
    [[nodiscard]] uint32_t code_bytes(const std::string& function) const;
    [[nodiscard]] std::string listing() const;
    [[nodiscard]] uint16_t address(const std::string& name) const;

    host_sim::FlatMachine machine;
    toolchain::assembly::Program program;
};

}  // namespace codegen_test
