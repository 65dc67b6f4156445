// What instructions read and write, against the simulated processor: changing anything else that
// it holds changes nothing else.
#include "toolchain/codegen/effects.hpp"

#include <gtest/gtest.h>

#include <array>
#include <random>

#include "host_sim/cpu/flat_machine.hpp"
#include "toolchain/isa/instruction_set.hpp"

namespace {

using namespace toolchain::codegen;
namespace isa = toolchain::isa;

constexpr uint16_t kCode = 0x0100;
constexpr unsigned kStates = 200;
constexpr uint8_t kSignFlags = 0xD4;  // S, Z, AC, P
constexpr uint8_t kKFlag = 0x20;

/// Registers by their numbers, the three kinds of flags as one value each.
using Values = std::array<uint8_t, 10>;

struct Outcome {
    Values values{};
    std::vector<uint8_t> memory{};
};

Outcome run(const CodeItem& item, const Values& values, uint8_t memory) {
    host_sim::FlatMachine machine{host_sim::InstructionSet::all};
    machine.memory.bytes.fill(memory);
    machine.memory.bytes[kCode] = item.opcode;
    machine.memory.bytes[kCode + 1] = 0x34;
    machine.memory.bytes[kCode + 2] = 0x92;
    host_sim::CpuState& cpu = machine.cpu;
    cpu.pc = kCode;
    cpu.sp = 0xF000;
    cpu.b = values[0], cpu.c = values[1], cpu.d = values[2], cpu.e = values[3];
    cpu.h = values[4], cpu.l = values[5], cpu.a = values[7];
    cpu.f = static_cast<uint8_t>((values[6] & kSignFlags) | (values[8] & 1) | (values[9] & kKFlag));
    host_sim::StepRecord record;
    (void)machine.step(record);
    Outcome result;
    result.values = {
        cpu.b, cpu.c, cpu.d, cpu.e, cpu.h, cpu.l, static_cast<uint8_t>(cpu.f & kSignFlags), cpu.a,
        static_cast<uint8_t>(cpu.f & 1),
        // Nobody may rely on what sources disagree on.
        static_cast<uint8_t>(cpu.f & kKFlag & ~isa::instruction(item.opcode).flags_unsettled)};
    result.memory.assign(machine.memory.bytes.begin() + 0x8000, machine.memory.bytes.end());
    return result;
}

bool is_plain(uint8_t opcode) {
    const isa::Instruction& instruction = isa::instruction(opcode);
    const bool stack = (opcode & 0xCB) == 0xC1 || opcode == 0xE3 || opcode == 0xF9 ||
                       (opcode & 0xF1) == 0x31 || opcode == 0x39;
    const bool outside = opcode == 0xDB || opcode == 0xD3 || opcode == 0xF3 || opcode == 0xFB ||
                         opcode == 0x20 || opcode == 0x30;
    return instruction.flow == isa::Flow::next && !stack && !outside && opcode != 0x38;  // LDSI
}

Values random_values(std::mt19937& random) {
    Values values;
    for (uint8_t& value : values) value = static_cast<uint8_t>(random());
    for (const unsigned high : {0U, 2U, 4U}) values[high] |= 0x80;  // pointers into data
    values[6] &= kSignFlags;
    values[8] &= 1;
    values[9] &= kKFlag;
    return values;
}

TEST(Effects, WhatIsNotReadMattersToNothingAndWhatIsNotWrittenStays) {
    std::mt19937 random(20250717);
    for (unsigned opcode = 0; opcode < 256; ++opcode) {
        if (!is_plain(static_cast<uint8_t>(opcode))) continue;
        CodeItem item;
        item.opcode = static_cast<uint8_t>(opcode);
        const Effects effects = effects_of(item);
        for (unsigned i = 0; i < kStates; ++i) {
            const Values before = random_values(random);
            const auto memory = static_cast<uint8_t>(random());
            const Outcome after = run(item, before, memory);
            const Values other = random_values(random);
            for (unsigned which = 0; which < before.size(); ++which) {
                const bool written = (effects.writes >> which & 1U) != 0;
                if (!written) {
                    ASSERT_EQ(after.values[which], before[which]) << opcode << ' ' << which;
                }
                if ((effects.reads >> which & 1U) != 0) continue;
                Values changed = before;
                changed[which] = other[which];
                Outcome expected = after;
                if (!written) expected.values[which] = other[which];
                const Outcome seen = run(item, changed, memory);
                ASSERT_EQ(seen.values, expected.values) << opcode << ' ' << which;
                ASSERT_EQ(seen.memory, expected.memory) << opcode << ' ' << which;
            }
        }
    }
}

TEST(Effects, MemoryIsNamed) {
    std::mt19937 random(20250718);
    for (unsigned opcode = 0; opcode < 256; ++opcode) {
        if (!is_plain(static_cast<uint8_t>(opcode))) continue;
        CodeItem item;
        item.opcode = static_cast<uint8_t>(opcode);
        const Effects effects = effects_of(item);
        bool writes = false;
        bool reads = false;
        for (unsigned i = 0; i < kStates; ++i) {
            const Values before = random_values(random);
            const Outcome zero = run(item, before, 0x00);
            for (const uint8_t fill : {uint8_t{0x5A}, uint8_t{0xFF}}) {
                reads = reads || zero.values != run(item, before, fill).values;
            }
            writes = writes || std::vector<uint8_t>(zero.memory.size(), 0x00) != zero.memory;
        }
        const bool named_read =
            effects.memory == MemoryAccess::read || effects.memory == MemoryAccess::read_write;
        const bool named_write =
            effects.memory == MemoryAccess::write || effects.memory == MemoryAccess::read_write;
        EXPECT_EQ(named_read, reads) << opcode;
        EXPECT_EQ(named_write, writes) << opcode;
        EXPECT_EQ(effects.pure, effects.memory == MemoryAccess::none && opcode != 0) << opcode;
    }
}

TEST(Effects, CallsAreWhatTheirItemSays) {
    CodeItem call;
    call.opcode = 0xCD;
    call.reads = set_of(Register::a);
    call.writes = static_cast<RegisterSet>(set_of(Register::h) | set_of(Register::flags));
    const Effects effects = effects_of(call);
    EXPECT_EQ(effects.reads, resource::kA);
    EXPECT_EQ(effects.writes, resource::of(4U) | resource::kFlags);
    EXPECT_FALSE(effects.pure);
}

// To the routine for tables: what it used is no longer there at the labels.
TEST(Effects, AJumpDestroysWhatItsItemSays) {
    CodeItem jump;
    jump.opcode = 0xC3;
    jump.reads = static_cast<RegisterSet>(set_of(Register::a) | set_of(Register::h));
    jump.writes = static_cast<RegisterSet>(set_of(Register::a) | set_of(Register::flags));
    EXPECT_EQ(effects_of(jump).reads, resource::kA | resource::of(4U));
    EXPECT_EQ(effects_of(jump).writes, resource::kA | resource::kFlags);
}

TEST(Effects, JumpsAndReturnsReadTheirFlag) {
    CodeItem item;
    item.opcode = 0xDA;  // JC
    EXPECT_EQ(effects_of(item).reads, resource::kCarry);
    item.opcode = 0xC8;  // RZ
    EXPECT_EQ(effects_of(item).reads, resource::kSign);
    item.opcode = 0xFD;  // JK
    EXPECT_EQ(effects_of(item).reads, resource::kK);
    item.opcode = 0xC3;
    EXPECT_EQ(effects_of(item).reads, 0);
}

}  // namespace
