// fast_test.cpp - what the fast interpreter promises its host: which instructions it leaves alone,
// when it stops, and exact T-states and instruction counts over long runs. That it computes what
// the reference does is lockstep_test's.
#include "host_sim/cpu/fast.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <set>
#include <vector>

#include "host_sim/cpu/fast_opcodes.hpp"
#include "host_sim/cpu/fast_operations.hpp"
#include "host_sim/cpu/fast_registers.hpp"
#include "host_sim/cpu/flat_bus.hpp"
#include "host_sim/cpu/flat_machine.hpp"
#include "host_sim/cpu/flat_memory.hpp"

namespace {

using host_sim::CpuState;
using host_sim::FlatMachine;
using host_sim::FlatMemory;
using host_sim::InstructionSet;
using host_sim::RunEnd;

/// Notes every request; `answer` executes it or not.
struct Host : host_sim::FastHost {
    CpuState cpu;
    FlatMemory memory = host_sim::all_ram();
    uint64_t until_t = 0;
    std::vector<int> asked;  ///< opcodes
    std::function<bool()> answer = [this] {
        host_sim::FlatBus bus{memory};
        host_sim::Reference<host_sim::FlatBus>(cpu, bus).execute();
        return true;
    };

    bool execute_exactly() override {
        asked.push_back(memory.bytes[cpu.pc]);
        return answer();
    }
    [[nodiscard]] uint64_t run_until_t() const override { return until_t; }
    void run(InstructionSet set = InstructionSet::all) {
        host_sim::run_fast(cpu, memory, *this, set);
    }
};

// fast.hpp: IN, OUT, EI, DI, RIM, SIM, HLT, DAA and, in the documented set, the ten others.
TEST(Fast, LeavesExactlyTheListedInstructionsToItsHost) {
    const std::set<int> always{0xDB, 0xD3, 0xFB, 0xF3, 0x20, 0x30, 0x76, 0x27};
    const std::set<int> ten{0x08, 0x10, 0x18, 0x28, 0x38, 0xCB, 0xD9, 0xDD, 0xED, 0xFD};
    for (const InstructionSet set : {InstructionSet::all, InstructionSet::documented}) {
        for (int opcode = 0; opcode < 256; ++opcode) {
            Host host;
            host.cpu.pc = 0x1000;
            host.cpu.sp = 0x8000;
            host.memory.bytes[0x1000] = static_cast<uint8_t>(opcode);
            host.until_t = 1;
            host.run(set);
            const bool left = always.contains(opcode) ||
                              (set == InstructionSet::documented && ten.contains(opcode));
            EXPECT_EQ(host.asked.size(), left ? 1U : 0U) << fmt::format("{:02X}", opcode);
            EXPECT_EQ(host.cpu.instructions, 1U) << fmt::format("{:02X}", opcode);
        }
    }
}

/// An instruction, and the pages that it writes to (from SP 8080H, HL 4080H, BC, DE, operand).
struct Writer {
    std::vector<int> code;
    std::vector<unsigned> pages;
};

// Writes to a page that is not writable: the host is asked before anything has changed, also when
// only the second byte lies there.
TEST(Fast, LeavesWritesToProtectedPagesToItsHost) {
    const std::vector<Writer> writers = {
        {{0x70}, {0x40}},
        {{0x36, 0x55}, {0x40}},
        {{0x34}, {0x40}},
        {{0x35}, {0x40}},
        {{0x02}, {0x50}},
        {{0x12}, {0x60}},
        {{0x32, 0x00, 0x70}, {0x70}},
        {{0x22, 0xFF, 0x70}, {0x70, 0x71}},
        {{0xD9}, {0x60}},
        {{0xC5}, {0x80}},
        {{0xF5}, {0x80}},
        {{0xE3}, {0x80}},
        {{0xC7}, {0x80}},
        {{0xCD, 0x00, 0x20}, {0x80}},
        {{0xC4, 0x00, 0x20}, {0x80}},  // CNZ, Z is clear
        {{0xCB}, {0x80}},              // RSTV, V is set
    };
    for (const Writer& writer : writers) {
        SCOPED_TRACE(fmt::format("opcode {:02X}", writer.code[0]));
        for (unsigned page = 0; page < 256; ++page) {
            Host host;
            host.cpu.pc = 0x1000;
            host.cpu.sp = 0x8080;
            host.cpu.b = 0x50, host.cpu.d = 0x60, host.cpu.h = 0x40, host.cpu.l = 0x80;
            host.cpu.f = host_sim::flag::kV;
            for (unsigned i = 0; i < writer.code.size(); ++i) {
                host.memory.bytes[0x1000 + i] = static_cast<uint8_t>(writer.code[i]);
            }
            host.memory.page_writable[page] = false;
            host.until_t = 1;
            const CpuState before = host.cpu;
            const FlatMemory memory = host.memory;
            host.answer = [] { return false; };
            host.run();
            const bool protected_page = std::count(writer.pages.begin(), writer.pages.end(), page);
            ASSERT_EQ(host.asked.size(), protected_page ? 1U : 0U) << "page " << page;
            if (!protected_page) continue;
            EXPECT_EQ(host.cpu, before);
            EXPECT_EQ(host.memory, memory);
        }
    }
}

// The stack pointer at the edge of a page: one byte on each side.
TEST(Fast, LooksAtBothPagesOfAPush) {
    for (const unsigned page : {0x7FU, 0x80U}) {
        Host host;
        host.cpu.sp = 0x8001;
        host.memory.bytes[0] = 0xC5;
        host.memory.page_writable[page] = false;
        host.until_t = 1;
        host.run();
        EXPECT_EQ(host.asked.size(), 1U);
    }
}

TEST(Fast, StopsWhenTheHostSaysSo) {
    Host host;
    host.memory.bytes = {0x00, 0xFB, 0x00};
    host.until_t = 1000;
    host.answer = [] { return false; };
    host.run();
    EXPECT_EQ(host.cpu.pc, 1);
    EXPECT_EQ(host.cpu.t, 4U);
    EXPECT_EQ(host.cpu.instructions, 1U);
}

// The host may bring the end forward, or move it out, while it executes an instruction.
TEST(Fast, FollowsAnEndThatMoves) {
    for (const uint64_t moved : {uint64_t{1}, uint64_t{100}}) {
        Host host;
        host.memory.bytes[2] = 0xFB;
        host.until_t = 50;
        const auto execute = host.answer;
        host.answer = [&host, execute, moved] {
            host.until_t = moved;
            return execute();
        };
        host.run();
        EXPECT_EQ(host.cpu.t, moved == 1 ? 12U : 100U);
    }
}

// NOPs from T 0: stops at the first boundary at or behind the end, wherever it lies.
TEST(Fast, StopsAtTheFirstBoundaryAtOrBehindTheEnd) {
    for (uint64_t end = 0; end < 40; ++end) {
        Host host;
        host.until_t = end;
        host.run();
        EXPECT_EQ(host.cpu.t, (end + 3) / 4 * 4);
        EXPECT_EQ(host.cpu.instructions, (end + 3) / 4);
    }
}

// T-states and instructions are counted in one word for 2^21 T-states at a time; runs are longer.
TEST(Fast, CountsExactlyOverLongRuns) {
    Host host;
    host.cpu.t = uint64_t{1} << 40;
    host.memory.bytes = {0x3C, 0xC3, 0x00, 0x00};  // INR A; JMP 0: 14 T-states
    host.until_t = host.cpu.t + 14 * 10'000'000;
    host.run();
    EXPECT_EQ(host.cpu.t, host.until_t);
    EXPECT_EQ(host.cpu.instructions, 20'000'000U);
    EXPECT_EQ(host.cpu.a, 10'000'000 % 256);
    EXPECT_TRUE(host.asked.empty());
}

// -- Lazy flags
// ------------------------------------------------------------------------------------

// Every flag byte that POP PSW can load comes back, and each condition reads it rightly.
TEST(LazyFlags, HoldEveryFlagByte) {
    for (uint32_t flags = 0; flags < 256; ++flags) {
        if ((flags & host_sim::flag::kUnused) != 0) continue;
        host_sim::fast::Registers r{};
        r.set_flags(flags);
        EXPECT_EQ(r.flags(), flags);
        EXPECT_EQ(r.v(), (flags & host_sim::flag::kV) != 0);
        EXPECT_EQ(r.k(), (flags & host_sim::flag::kK) != 0);
        EXPECT_EQ(host_sim::fast::holds<0>(r), (flags & host_sim::flag::kZero) == 0);
        EXPECT_EQ(host_sim::fast::holds<3>(r), (flags & host_sim::flag::kCarry) != 0);
        EXPECT_EQ(host_sim::fast::holds<5>(r), (flags & host_sim::flag::kParity) != 0);
        EXPECT_EQ(host_sim::fast::holds<6>(r), (flags & host_sim::flag::kSign) == 0);
    }
}

// PUSH PSW behind every flag byte and then every instruction that changes some flags and keeps
// others: what was kept comes out. (INX keeps V, DAD keeps S Z AC P, STC keeps all but CY.)
TEST(LazyFlags, KeepWhatAnInstructionLeaves) {
    for (const int opcode : {0x03, 0x09, 0x37, 0x3F, 0x0F, 0x04, 0x10, 0x18}) {
        for (unsigned flags = 0; flags < 256; ++flags) {
            FlatMachine fast;
            fast.cpu.t = 1000;
            fast.cpu.f = static_cast<uint8_t>(flags & ~8U);
            fast.memory.bytes = {static_cast<uint8_t>(opcode), 0xF5};
            FlatMachine plain = fast;
            fast.run(1025);
            plain.run_reference(1025);
            ASSERT_EQ(fast.memory.bytes[0xFFFE], plain.memory.bytes[0xFFFE])
                << fmt::format("opcode {:02X} flags {:02X}", opcode, flags);
        }
    }
}

// -- execute() directly
// ------------------------------------------------------------------------------

// The rule of fast_opcodes.hpp: entered with PC behind the opcode; T-states or kLeftToHost.
TEST(FastOpcodes, TellTheirTStatesAndMovePc) {
    FlatMemory memory = host_sim::all_ram();
    memory.bytes[0x0101] = 0x34;
    memory.bytes[0x0102] = 0x12;
    host_sim::fast::Registers r{};
    r.pc = 0x0101;
    EXPECT_EQ(host_sim::fast::execute<0x01>(r, memory), 10);  // LXI B,1234H
    EXPECT_EQ(r.b << 8 | r.c, 0x1234U);
    EXPECT_EQ(r.pc, 0x0103U);
    r.pc = 0x0101;
    EXPECT_EQ(host_sim::fast::execute<0xC3>(r, memory), 10);  // JMP 1234H
    EXPECT_EQ(r.pc, 0x1234U);
    EXPECT_EQ(host_sim::fast::execute<0xDB>(r, memory), host_sim::fast::kLeftToHost);
    EXPECT_EQ(r.pc, 0x1234U);
}

}  // namespace
