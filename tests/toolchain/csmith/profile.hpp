// profile.hpp - which kind of program belongs to a seed. Depends on   the standard library.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace csmith_test {

/// How csmith is called for a seed, and how its program is compiled by all compilers.
struct Profile {
    std::vector<std::string> csmith{};    ///< options
    std::vector<std::string> compiler{};  ///< options
    bool opaque = false;  ///< the optimiser shall not know the first values of variables
};

/// Depends on the seed alone: sizes, 64-bit numbers, unions, volatiles, small functions inline or
/// not. Floating point is never on.
[[nodiscard]] Profile profile_of(uint64_t seed);

}  // namespace csmith_test
