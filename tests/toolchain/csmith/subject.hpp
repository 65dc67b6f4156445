// subject.hpp - what a C program computes according to our compiler, seen at two places: in the
// back end's representation, executed by an interpreter, and (when there is code generation) as an
// image on the simulated 8085. A difference in the first is a fault of the front half, one only in
// the second a fault of code generation. Depends on   toolchain/ir,
// tests/toolchain/codegen/interpreter.hpp, process.hpp.
#pragma once

#include <functional>
#include <string>

#include "tests/toolchain/csmith/oracle.hpp"
#include "toolchain/codegen/mir.hpp"

namespace csmith_test {

/// What each layer computes.
struct Subject {
    Observation mir{};
};

/// Changes the representation before it is executed; tests put faults in with it.
using Meddle = std::function<void(toolchain::codegen::Module&)>;

/// Compiles and runs in a process of its own. @param level  "0", "1", "2" or "s"
[[nodiscard]] Subject observe_subject(const Program& program, const std::string& level,
                                      const Meddle& meddle = {});

}  // namespace csmith_test
