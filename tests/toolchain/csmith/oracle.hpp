// oracle.hpp - what a C program computes according to avr-gcc and simavr: another compiler and
// another simulator with int and pointers of 16 bits, as ours. Depends on   process.hpp, avr_run.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace csmith_test {

/// A program's checksum, or why there is none.
struct Observation {
    enum class Kind {
        checksum,
        no_end,     ///< not done within the limit
        refused,    ///< the compiler says no
        too_large,  ///< it does not fit into memory
        failed,     ///< crash or other trouble
    };
    Kind kind = Kind::failed;
    uint32_t checksum = 0;
    std::string text{};  ///< what the compiler or simulator said

    bool operator==(const Observation&) const = default;
};

[[nodiscard]] std::string to_text(const Observation& observation);

/// A C source with the options that all compilers get.
struct Program {
    std::filesystem::path source{};
    std::vector<std::string> options{};
};

/// Options with which any of the compilers finds csmith.h.
[[nodiscard]] std::vector<std::string> include_options();

/// @param level  "0", "1", "2" or "s"
[[nodiscard]] Observation observe_avr(const Program& program, const std::string& level = "1");

}  // namespace csmith_test
