// subject.hpp - what a C program computes according to our compiler, at one of two places: as an
// image on the simulated 8085, or in the back end's representation, executed by an interpreter.
// A difference in both is a fault of the front half, one only in the image a fault of code
// generation.
// Depends on   toolchain/driver, tests/toolchain/codegen/interpreter.hpp, host_sim/cpu,
// process.hpp.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "tests/toolchain/csmith/oracle.hpp"
#include "toolchain/asm/program.hpp"
#include "toolchain/codegen/mir.hpp"
#include "toolchain/codegen/steps.hpp"

namespace csmith_test {

enum class Layer : uint8_t { image, mir };

struct SubjectOptions {
    std::string level = "s";     ///< "0", "1", "2" or "s"
    bool undocumented = false;   ///< instructions too: --cpu=8085u
    uint64_t search_budget = 0;  ///< as in driver::Request
    toolchain::Steps steps{};    ///< to be taken
    /// Change what is executed; tests put faults in with them.
    std::function<void(toolchain::codegen::Module&)> meddle_mir{};
    std::function<void(toolchain::assembly::Program&)> meddle_image{};
};

/// Compiles and runs in a process of its own.
[[nodiscard]] Observation observe_subject(const Program& program, Layer layer,
                                          const SubjectOptions& options);

}  // namespace csmith_test
