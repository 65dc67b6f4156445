// Random functions by the interpreter and as machine code: the same must be in memory behind them.
// ROVER_MIR_SEED and ROVER_MIR_COUNT choose the first seed and how many modules are tried.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <string>

#include "tests/toolchain/codegen/compare_programs.hpp"
#include "tests/toolchain/codegen/random_functions.hpp"

namespace {

using namespace codegen_test;

uint64_t from_environment(const char* name, uint64_t otherwise) {
    const char* text = std::getenv(name);
    return text == nullptr ? otherwise : std::stoull(text);
}

/// Options and sizes that differ from module to module.
CompareOptions options_for(uint64_t seed) {
    CompareOptions options;
    options.seed = seed;
    options.search = seed % 8 == 1;
    options.budget = 200;
    options.homes_by_chance = seed % 8 > 2 ? seed : 0;
    options.runs = 3;
    constexpr std::array<double, 3> kByteCosts = {1, 0.3, 10};
    options.byte_cost = kByteCosts[seed % kByteCosts.size()];
    options.ask_clobbers = seed % 5 != 0;
    return options;
}

RandomLimits limits_for(uint64_t seed) {
    RandomLimits limits;
    limits.statements = seed % 3 == 0 ? 4 : seed % 3 == 1 ? 8 : 16;
    return limits;
}

class GenerateRandom : public testing::TestWithParam<bool> {};

INSTANTIATE_TEST_SUITE_P(Instructions, GenerateRandom, testing::Bool(), [](const auto& test) {
    return test.param ? "Undocumented" : "Documented";
});

TEST_P(GenerateRandom, MachineCodeDoesWhatTheInterpreterDoes) {
    const uint64_t first = from_environment("ROVER_MIR_SEED", 60);
    const uint64_t count = from_environment("ROVER_MIR_COUNT", 150);
    std::size_t functions = 0;
    for (uint64_t seed = first; seed < first + count; ++seed) {
        const RandomProgram program = random_program(seed, limits_for(seed));
        functions += program.module.functions.size();
        CompareOptions options = options_for(seed);
        options.undocumented = GetParam();
        const std::string found = difference(program, options);
        if (found.empty()) continue;
        const RandomProgram smaller = shrink(program, options);
        ADD_FAILURE() << "seed " << seed << ": " << found
                      << "\nsmaller: " << difference(smaller, options) << "\n"
                      << print(smaller.module) << listing(smaller, options);
        if (from_environment("ROVER_MIR_ALL", 0) == 0) return;
    }
    RecordProperty("functions", static_cast<int>(functions));
    fmt::print("{} functions, seeds {} to {}\n", functions, first, first + count - 1);
}

}  // namespace
