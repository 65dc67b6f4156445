// Comparisons that a carry answers: every pair of bytes, and words and longs, give what the host's
// compiler gives, at every level and with both sets of instructions; without the step the same, but
// slower.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <string>

#include "tests/target/compile.hpp"
#include "tests/target/machine.hpp"

extern "C" uint32_t carry_hash(void);

namespace target_test {
namespace {

struct Outcome {
    uint32_t hash = 0;
    uint64_t t_states = 0;
};

Outcome run(Optimisation level, bool undocumented, const toolchain::Steps& steps) {
    const std::string path = std::string(ROVER_SOURCE_DIR) + "/tests/target/carry_program.c";
    std::ifstream file(path);
    std::string text{std::istreambuf_iterator<char>(file), {}};
    text += "\nuint32_t result;\nint main(void) { result = carry_hash(); return 0; }\n";
    toolchain::driver::Request made = request(level);
    made.sources = {{.path = path, .text = text}};
    made.keep = {"result"};
    made.undocumented = undocumented;
    made.search_budget = 5000;  // quick to compile; what is tested comes behind the search
    made.steps = steps;
    Machine machine(
        toolchain::driver::compile_program(made).program,
        undocumented ? host_sim::InstructionSet::all : host_sim::InstructionSet::documented);
    Outcome seen;
    seen.t_states = machine.run(500'000'000);
    seen.hash = static_cast<uint32_t>(machine.read(machine.address("result"), 4));
    return seen;
}

class Carry : public testing::TestWithParam<Level> {};

TEST_P(Carry, AnswersAsTheHostDoes) {
    for (const bool undocumented : {false, true}) {
        EXPECT_EQ(run(GetParam().level, undocumented, {}).hash, carry_hash()) << undocumented;
    }
}

TEST(CarryAnswers, AreTheSameWithoutTheStepButCheaper) {
    toolchain::Steps without;
    without.leave_out(toolchain::Step::carry_answers);
    const Outcome plain = run(Optimisation::more, false, without);
    const Outcome with = run(Optimisation::more, false, {});
    EXPECT_EQ(plain.hash, carry_hash());
    EXPECT_LT(with.t_states, plain.t_states);
    fmt::print("{} T with answers, {} T without\n", with.t_states, plain.t_states);
}

INSTANTIATE_TEST_SUITE_P(Levels, Carry, testing::ValuesIn(kLevels),
                         [](const auto& test) { return test.param.name; });

}  // namespace
}  // namespace target_test
