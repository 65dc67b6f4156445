// A plain C program of CoreMark's kind and size, unchanged: linked list with function pointers,
// matrix, state machine, CRC. Its sums are those that CoreMark publishes for 2000 bytes; T-states
// of one round, preparation included, stay below 28 million (issue 6: the best existing compiler
// for the 8085 needs 44.4 million for CoreMark, the best one for the Z80 29.6).
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/target/compile.hpp"
#include "tests/target/machine.hpp"
#include "toolchain/driver/driver.hpp"

namespace {

constexpr uint64_t kMostT = 28'000'000;

struct Setting {
    toolchain::ir::Optimisation level;
    bool undocumented;
    const char* name;
};

void PrintTo(const Setting& setting, std::ostream* out) {  // name from GoogleTest
    *out << setting.name;
}

class MixedWork : public testing::TestWithParam<Setting> {};

TEST_P(MixedWork, GivesThePublishedSumsInTime) {
    toolchain::driver::Request request;
    request.level = GetParam().level;
    request.undocumented = GetParam().undocumented;
    request.front_end = {"-std=c89"};
    request.keep = {"mw_list_crc", "mw_matrix_crc", "mw_state_crc"};
    request.sources = {{ROVER_SOURCE_DIR "/tests/bench/programs/mixed_work.c"}};
    const auto program = toolchain::driver::compile_program(request).program;
    target_test::Machine machine(program, GetParam().undocumented
                                              ? host_sim::InstructionSet::all
                                              : host_sim::InstructionSet::documented);
    const uint64_t t = machine.run(kMostT);
    EXPECT_EQ(machine.read(machine.address("mw_list_crc"), 2), 0xE714U);
    EXPECT_EQ(machine.read(machine.address("mw_matrix_crc"), 2), 0x1FD7U);
    EXPECT_EQ(machine.read(machine.address("mw_state_crc"), 2), 0x8E3AU);
    EXPECT_LE(t, kMostT);
    uint64_t bytes = 0;
    for (const auto& placed : program.sections) {
        const bool code = placed.section.kind == toolchain::assembly::SectionKind::code;
        bytes += code ? placed.size : 0;
    }
    fmt::print("{}: {} T-states, {} bytes of code\n", GetParam().name, t, bytes);
}

/// Two of them where the compiler is slow: with sanitizers.
std::vector<Setting> settings() {
    using toolchain::ir::Optimisation;
    std::vector<Setting> all = {{Optimisation::more, false, "O2"},
                                {Optimisation::size, true, "Osu"},
                                {Optimisation::size, false, "Os"},
                                {Optimisation::more, true, "O2u"}};
    if (target_test::kSlowBuild) all.resize(2);
    return all;
}

INSTANTIATE_TEST_SUITE_P(Settings, MixedWork, testing::ValuesIn(settings()),
                         [](const auto& test) { return test.param.name; });

}  // namespace
