// compare.hpp - one seed: its program, the oracle's answer, our answers at several levels.
// Depends on   oracle.hpp, subject.hpp, profile.hpp.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "tests/toolchain/csmith/generate.hpp"
#include "tests/toolchain/csmith/oracle.hpp"
#include "tests/toolchain/csmith/subject.hpp"

namespace csmith_test {

/// What a comparison found. Only `agreed` and the skipped ones are no faults of ours.
enum class Verdict : uint8_t {
    agreed,
    skipped,     ///< no program, or no checksum of the oracle's: says nothing about our compiler
    doubtful,    ///< avr-gcc disagrees with itself at other levels, or C leaves the result open
    too_large,   ///< our compiler says that the image does not fit
    no_end,      ///< ours does not end where the oracle's does
    refused,     ///< our compiler says no
    failed,      ///< our compiler or its program crashes
    difference,  ///< another checksum
};
inline constexpr std::size_t kVerdicts = 8;
[[nodiscard]] std::string_view name_of(Verdict verdict);
[[nodiscard]] constexpr bool is_fault(Verdict verdict) {
    return verdict >= Verdict::no_end;
}

struct Finding {
    Verdict verdict = Verdict::agreed;
    std::string text{};  ///< one line

    bool operator==(const Finding&) const = default;
};

struct CompareOptions {
    std::vector<std::string> levels = {"0", "1", "2", "s"};
    std::filesystem::path keep{};  ///< programs of faults, and doubtful ones, are copied here
    Generator kind = Generator::csmith;
    Layer layer = Layer::image;  ///< what is compared first
    SubjectOptions subject{};    ///< the level does not matter
};

/// Compares all levels for a given program. The worst verdict, with the levels that have it. When
/// an image does something else, the text says whether the representation does so too.
[[nodiscard]] Finding compare(const Program& program, const CompareOptions& options);

/// generate() and compare() in a folder of its own.
[[nodiscard]] Finding compare_seed(uint64_t seed, const CompareOptions& options);

}  // namespace csmith_test
