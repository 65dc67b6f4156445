// random_functions.hpp - modules of the back end's representation made by chance, for running them
// twice: by the interpreter and as machine code.
// Depends on   toolchain/codegen/builder.hpp.
// Safe         every loop ends, every address lies in `data`; no value depends on where something
//              lies in memory, and none on an undefined byte.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "toolchain/codegen/mir.hpp"

namespace codegen_test {

inline constexpr unsigned kDataBytes = 256;  ///< of the variable `data`
inline constexpr unsigned kOutBytes = 64;    ///< of `out`, where functions leave what they found

struct RandomProgram {
    toolchain::codegen::Module module{};
    /// Functions without arguments or result. They read and write `data` and `out`.
    std::vector<std::string> entries{};
};

struct RandomLimits {
    unsigned entries = 6;
    unsigned callees = 2;
    unsigned statements = 12;  ///< of a function, about
};

[[nodiscard]] RandomProgram random_program(uint64_t seed, const RandomLimits& limits = {});

}  // namespace codegen_test
