// generate.hpp - the random program of a seed. Depends on   csmith, profile.hpp, kernels.hpp,
// oracle.hpp.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "tests/toolchain/csmith/oracle.hpp"

namespace csmith_test {

enum class Generator : uint8_t {
    csmith,   ///< made by csmith, with the options of profile.hpp
    kernels,  ///< kernels.hpp
};

/// Writes SEED.c. @return nothing when csmith found no program in time
/// @errors std::runtime_error: csmith is missing or refuses its options
[[nodiscard]] std::optional<Program> generate(uint64_t seed, const std::filesystem::path& folder,
                                              Generator kind = Generator::csmith);

/// What makes the first values of a program's variables unknown to an optimiser: a visible table of
/// their addresses (the call of an unknown function is in csmith.h).
[[nodiscard]] std::string escapes_of(const std::string& program);

}  // namespace csmith_test
