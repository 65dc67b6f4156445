// startup_test.cpp - start-up code run on the simulated processor: what it leaves, and its
// T-states.
#include "toolchain/asm/startup.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "host_sim/cpu/flat_machine.hpp"
#include "support.hpp"

namespace {

using namespace asm_test;
using namespace toolchain::assembly;

struct Case {
    unsigned data;
    unsigned zero;
};

class StartupRuns : public testing::TestWithParam<Case> {};

TEST_P(StartupRuns, InitialisesMemoryInTheStatedTime) {
    const auto [data, zero] = GetParam();
    std::string source =
        "SECTION main,code\nmain: LXI H,data\nLXI H,zero\nRET\nSECTION first,code\nfirst: RET\n"
        "SECTION zero,zero\n" +
        fmt::format("zero: DS {}\n", zero) + "SECTION data,initialised\ndata:\n";
    for (unsigned i = 0; i < data; ++i) source += fmt::format("DB {}\n", (i * 7 + 1) % 251);
    LinkOptions options;
    options.stack_size = 64;
    options.startup = StartupOptions{"main", {"first"}};
    const Program program = linked(source, options);

    host_sim::FlatMachine machine(host_sim::InstructionSet::documented);
    std::ranges::copy(program.image.bytes, machine.memory.bytes.begin());
    for (unsigned at = 0x8000; at < 0xFFFF; ++at) machine.memory.bytes[at] = 0xA5;
    const auto first = static_cast<uint16_t>(value_of(program, "first"));
    host_sim::StepRecord record;
    uint64_t before_call = 0;
    while (machine.cpu.pc != first) {
        before_call = machine.cpu.t;
        ASSERT_EQ(machine.step(record), host_sim::RunEnd::time_limit);
        ASSERT_LT(machine.cpu.t, 10'000'000u);
    }
    // The JMP at 0000H comes first.
    EXPECT_EQ(program.startup_t_states, before_call - 10);
    EXPECT_EQ(machine.run(20'000'000), host_sim::RunEnd::halted);
    EXPECT_EQ(machine.cpu.sp, 0xFF00);
    for (unsigned i = 0; i < data; ++i) {
        ASSERT_EQ(machine.memory.bytes[program.data.first + i], (i * 7 + 1) % 251) << i;
    }
    for (unsigned i = 0; i < zero; ++i) {
        ASSERT_EQ(machine.memory.bytes[program.zero.first + i], 0) << i;
    }
    EXPECT_EQ(machine.memory.bytes[std::max(program.data.end(), program.zero.end())], 0xA5);
    EXPECT_EQ(machine.memory.bytes[0xFEBF], 0xA5);  // below the stack
}

INSTANTIATE_TEST_SUITE_P(Sizes, StartupRuns,
                         testing::Values(Case{0, 0}, Case{1, 1}, Case{255, 2}, Case{256, 511},
                                         Case{257, 512}, Case{600, 513}, Case{0, 3000},
                                         Case{3000, 0}));

TEST(Startup, OnlyWhatThereIsToDo) {
    // LXI SP 10; then CALL, HLT, JMP.
    const Startup bare = make_startup({}, {});
    EXPECT_EQ(bare.t_states, 10u);
    EXPECT_EQ(section_size(bare.section), 3u + 3 + 1 + 3);
    // LXI SP, LXI H 20; MVI C 7; 2 rounds of PUSH 12, DCR 4, JNZ 10 and 7; LXI SP 10.
    const Startup clear = make_startup({}, {{}, {}, {0x8000, 4}, 0});
    EXPECT_EQ(clear.t_states, 20u + 7 + 2 * 16 + 10 + 7 + 10);
    // LXI SP 10; LXI H, LXI D 20; MVI C 7; a round of 7+7+6+6+4 and JNZ 7.
    const Startup copy = make_startup({}, {{0x8000, 1}, {0x100, 1}, {}, 0});
    EXPECT_EQ(copy.t_states, 10u + 20 + 7 + 30 + 7);
    // 10 bytes as above; clearing LXI LXI MVI PUSH DCR JNZ, copying LXI LXI MVI, 4 moves, DCR JNZ;
    // beyond 256 rounds LXI for MVI, and DCR JNZ again.
    EXPECT_EQ(section_size(clear.section), 10u + 13);
    EXPECT_EQ(section_size(copy.section), 10u + 16);
    EXPECT_EQ(section_size(make_startup({}, {{}, {}, {0x8000, 514}, 0}).section), 10u + 18);
    EXPECT_EQ(section_size(make_startup({}, {{0x8000, 257}, {0x100, 257}, {}, 0}).section),
              10u + 21);
    EXPECT_THROW((void)make_startup({}, {{}, {}, {0x8000, 3}, 0}), std::invalid_argument);
}

}  // namespace
