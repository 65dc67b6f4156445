// profile.cpp - see profile.hpp.
#include "tests/toolchain/csmith/profile.hpp"

#include <random>

namespace csmith_test {

Profile profile_of(uint64_t seed) {
    std::mt19937_64 source(seed);  // specified exactly by the standard, unlike distributions
    Profile result{{"--seed", std::to_string(seed), "--no-argc", "--no-float", "--quiet",
                    "--concise", "--no-hash-value-printf", "--bitfields", "--packed-struct"},
                   {}};
    const auto number = [&](const char* option, uint64_t low, uint64_t high) {
        result.csmith.emplace_back(option);
        result.csmith.push_back(std::to_string(low + source() % (high - low + 1)));
    };
    const auto flag = [&](const char* option, unsigned percent) {
        if (source() % 100 < percent) result.csmith.emplace_back(option);
    };
    number("--max-funcs", 2, 9);
    number("--max-block-depth", 2, 5);
    number("--max-block-size", 2, 4);
    number("--max-expr-complexity", 4, 12);
    number("--max-array-dim", 1, 3);
    number("--max-array-len-per-dim", 2, 7);
    number("--max-struct-fields", 2, 8);
    number("--max-pointer-depth", 1, 3);
    if (source() % 2 == 0) {
        result.csmith.emplace_back("--no-longlong");
        result.csmith.emplace_back("--no-math64");
    }
    flag("--no-unions", 30);
    flag("--no-volatiles", 30);
    flag("--no-pointers", 10);
    flag("--inline-function", 30);
    flag("--no-jumps", 40);
    if (source() % 3 == 0)
        result.compiler.emplace_back("-DROVER_SAFE=static __attribute__((noinline))");
    result.opaque = source() % 3 != 0;
    return result;
}

}  // namespace csmith_test
