// Volatile variables, ports and interrupt enables: every access exactly once and in order, at every
// optimisation level, against C's abstract machine (random programs that execute themselves while
// they are written). ROVER_VOLATILE_SEED and ROVER_VOLATILE_PROGRAMS change what is tried.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <string>
#include <string_view>

#include "tests/target/compile.hpp"
#include "tests/target/volatile_program.hpp"
#include "tests/target/watched_machine.hpp"

namespace target_test {
namespace {

uint64_t number_from(const char* variable, uint64_t otherwise) {
    const char* text = std::getenv(variable);
    return text == nullptr ? otherwise : std::strtoull(text, nullptr, 10);
}

toolchain::assembly::Program compiled(const VolatileProgram& source, const Level& level) {
    toolchain::driver::Request made = request(level);
    made.sources = {{.path = "volatile.c", .text = source.text}};
    for (const Device& device : source.devices) {
        if (device.address == 0) made.keep.push_back(device.name);
    }
    made.messages = [](std::string_view) {
    };  // clang warns of reads for nothing, which is the point
    return toolchain::driver::compile_program(made).program;
}

/// The first difference, or empty.
std::string difference(const std::vector<Access>& wanted, const WatchedRun& seen) {
    for (std::size_t i = 0; i < std::max(wanted.size(), seen.accesses.size()); ++i) {
        const std::string a = i < wanted.size() ? wanted[i].text() : "nothing";
        const std::string b = i < seen.accesses.size() ? seen.accesses[i].text() : "nothing";
        if (a != b) return fmt::format("access {}: wanted {}, seen {}", i, a, b);
    }
    return seen.violation;
}

class Volatile : public testing::TestWithParam<Level> {};

TEST_P(Volatile, AccessesAreThoseOfTheAbstractMachine) {
    const uint64_t first = number_from("ROVER_VOLATILE_SEED", 1);
    const uint64_t programs = number_from("ROVER_VOLATILE_PROGRAMS", kSlowBuild ? 3 : 8);
    std::size_t accesses = 0;
    for (uint64_t seed = first; seed < first + programs; ++seed) {
        const VolatileProgram source = make_volatile_program(seed);
        accesses += source.accesses.size();
        const WatchedRun run = run_watched(compiled(source, GetParam()), source.devices, seed,
                                           GetParam().undocumented);
        ASSERT_TRUE(run.halted) << "seed " << seed << "\n" << source.text;
        ASSERT_EQ(difference(source.accesses, run), "") << "seed " << seed << "\n" << source.text;
    }
    fmt::print("{} programs from seed {}: {} accesses\n", programs, first, accesses);
    EXPECT_GT(accesses, 20 * programs);
}

INSTANTIATE_TEST_SUITE_P(Levels, Volatile, testing::ValuesIn(kSettings),
                         [](const auto& test) { return test.param.name; });

}  // namespace
}  // namespace target_test
