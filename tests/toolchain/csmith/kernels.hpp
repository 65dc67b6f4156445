// kernels.hpp - random C programs of another kind than csmith's: small functions with loops over
// arrays, pointers that walk, counters of every width, unsigned arithmetic that wraps, in csmith's
// frame. Every function gets its operands at run time.
// Depends on   the standard library.
#pragma once

#include <cstdint>
#include <string>

namespace csmith_test {

/// The program of a seed. C leaves nothing in it open, and every loop ends.
[[nodiscard]] std::string kernel_program(uint64_t seed);

}  // namespace csmith_test
