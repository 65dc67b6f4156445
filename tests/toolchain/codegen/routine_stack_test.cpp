// Stack of routines: against the simulated processor's stack pointer, and by hand.
#include "toolchain/codegen/routine_stack.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include "host_sim/cpu/flat_bus.hpp"
#include "host_sim/cpu/reference.hpp"
#include "tests/toolchain/codegen/compiled_program.hpp"
#include "toolchain/asm/link.hpp"
#include "toolchain/asm/parse.hpp"

namespace {

using toolchain::assembly::Module;
using toolchain::codegen::RoutineStack;

uint32_t depth(const std::string& source, const std::string& label = "f") {
    const std::vector<Module> modules = {toolchain::assembly::parse(source)};
    return RoutineStack(modules).of(label);
}

TEST(RoutineStack, CountsPushesAndCalls) {
    EXPECT_EQ(depth("f: RET\n"), 0U);
    EXPECT_EQ(depth("f: PUSH B\nPUSH D\nPOP D\nPOP B\nRET\n"), 4U);
    EXPECT_EQ(depth("f: PUSH B\nCALL g\nPOP B\nRET\ng: PUSH H\nPOP H\nRET\n"), 6U);
    EXPECT_EQ(depth("f: JMP g\ng: PUSH H\nPOP H\nRET\n"), 2U);  // no return address of its own
    EXPECT_EQ(depth("f: RET\n", "nobody"), 0U);
}

TEST(RoutineStack, FollowsEveryBranch) {
    EXPECT_EQ(depth("f: JZ .1\nRET\n.1: PUSH B\nCNZ g\nPOP B\nRNZ\nPUSH B\nPUSH B\nPUSH B\nPOP B\n"
                    "POP B\nPOP B\nRET\ng: RET\n"),
              6U);
    EXPECT_EQ(depth("f: DCR A\nJNZ f\nRET\n"), 0U);
}

TEST(RoutineStack, RefusesWhatItCannotKnow) {
    EXPECT_THROW((void)depth("f: POP B\nRET\n"), std::logic_error);
    EXPECT_THROW((void)depth("f: CALL f\nRET\n"), std::logic_error);
}

/// Lowest stack pointer of one call, as bytes below the return address.
/// @param blocks  the routine writes where HL points to: to memory that nothing else is in
uint32_t measured(const toolchain::assembly::Program& program, uint16_t entry, uint64_t seed,
                  bool blocks) {
    constexpr uint16_t kStack = 0xFF00;
    constexpr uint64_t kLimit = 200'000;
    host_sim::FlatMemory memory = host_sim::all_ram();
    memory.bytes.fill(0x76);
    std::copy(program.image.bytes.begin(), program.image.bytes.end(), memory.bytes.begin());
    std::mt19937 cells(static_cast<uint32_t>(seed));
    for (uint32_t i = 0x8000; i < 0x8100; ++i) {
        const bool zero = cells() % 2 == 0;
        memory.bytes[i] = zero ? uint8_t{0} : static_cast<uint8_t>(cells());
    }
    memory.bytes[kStack] = memory.bytes[kStack + 1] = 0;  // returns to HLT
    memory.bytes[0] = 0x76;
    host_sim::CpuState cpu;
    cpu.sp = kStack;
    cpu.pc = entry;
    cpu.a = static_cast<uint8_t>(seed);
    cpu.b = blocks ? 0 : static_cast<uint8_t>(seed >> 40);
    cpu.c = blocks ? static_cast<uint8_t>(1 + seed % 9) : static_cast<uint8_t>(seed >> 48);
    cpu.d = blocks ? static_cast<uint8_t>(0x90 + seed % 3) : static_cast<uint8_t>(seed >> 24);
    cpu.e = static_cast<uint8_t>(seed >> 8);
    cpu.h = blocks ? static_cast<uint8_t>(0x90 + seed % 5) : static_cast<uint8_t>(seed >> 32);
    cpu.l = static_cast<uint8_t>(seed >> 16);
    host_sim::FlatBus bus{memory};
    host_sim::Reference<host_sim::FlatBus> processor(cpu, bus);
    uint32_t most = 0;
    while (!cpu.halted && cpu.t < kLimit) {
        (void)processor.execute();
        if (cpu.sp <= kStack) most = std::max<uint32_t>(most, kStack - cpu.sp);
    }
    return most;
}

TEST(RoutineStack, OfTheRuntimeIsWhatTheProcessorUses) {
    toolchain::assembly::LinkOptions options;
    options.rom = {0x0040, 0x7FFF};
    std::vector<std::string> entries;
    for (const Module& module : codegen_test::runtime_modules()) {
        for (const auto& section : module.sections) {
            if (section.kind != toolchain::assembly::SectionKind::code) continue;
            for (const auto& item : section.items) {
                const std::string& name = item.operand.symbol;
                const bool jumps = name == "__jumpindex" || name == "__callhl";
                if (item.kind == toolchain::assembly::ItemKind::label && !jumps &&
                    !toolchain::assembly::is_local(name)) {
                    entries.push_back(name);
                }
            }
        }
    }
    ASSERT_GT(entries.size(), 30U);
    options.roots = entries;
    const auto program = toolchain::assembly::link(codegen_test::runtime_modules(), options);
    RoutineStack stated(codegen_test::runtime_modules());
    for (const std::string& entry : entries) {
        uint32_t most = 0;
        std::mt19937_64 random(85);
        for (int round = 0; round < 3000 && most < stated.of(entry); ++round) {
            // Long runs of equal bits: signs, zeros and small numbers are frequent.
            const uint64_t seed = random() & random() & (round % 2 == 0 ? UINT64_MAX : random());
            most = std::max(most, measured(program, program.find(entry)->value, seed,
                                           entry.starts_with("__mem")));
        }
        EXPECT_EQ(most, stated.of(entry)) << entry;
    }
}

}  // namespace
