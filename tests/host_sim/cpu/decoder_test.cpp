// decoder_test.cpp - all 256 opcodes as executed against the instruction table of the toolchain,
// which was written by other hands from the same manuals: bytes, T-states, machine cycles, the
// flags that may change, and which opcodes exist.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <random>
#include <set>
#include <string>

#include "host_sim/cpu/flat_machine.hpp"
#include "toolchain/isa/instruction_set.hpp"

namespace {

using host_sim::BusAccess;
using host_sim::CpuState;
using host_sim::FlatMachine;
using host_sim::InstructionSet;
using host_sim::RunEnd;
using host_sim::StepRecord;
using toolchain::isa::BusCycle;
using toolchain::isa::BusCycles;
using toolchain::isa::Flow;
using toolchain::isa::Instruction;

constexpr unsigned kSeed = 256;
constexpr int kStatesPerOpcode = 400;
constexpr uint8_t kFlagBits = 0xF7;

/// Random registers and memory contents around everything that an instruction can reach. Extreme
/// values are frequent, so that every flag gets its chance.
class RandomStates {
public:
    CpuState registers() {
        CpuState cpu;
        cpu.a = byte(), cpu.b = byte(), cpu.c = byte(), cpu.d = byte();
        cpu.e = byte(), cpu.h = byte(), cpu.l = byte();
        cpu.f = static_cast<uint8_t>(random_() & kFlagBits);
        cpu.sp = word();
        cpu.pc = word();
        cpu.t = 1000;
        return cpu;
    }
    uint8_t byte() {
        constexpr uint8_t kExtremes[] = {0x00, 0x01, 0x7F, 0x80, 0xFF};
        return random_() % 2 == 0 ? kExtremes[random_() % 5] : static_cast<uint8_t>(random_());
    }
    uint16_t word() { return static_cast<uint16_t>(byte() << 8 | byte()); }

private:
    std::mt19937 random_{kSeed};
};

/// Executes `instruction` from a random state. The record is that of the instruction.
StepRecord execute(FlatMachine& machine, RandomStates& states, const Instruction& instruction) {
    machine.cpu = states.registers();
    // Few enough bytes are ever looked at; the rest of memory keeps older values.
    for (const uint16_t begin :
         {machine.cpu.pc, machine.cpu.sp, machine.cpu.hl(), machine.cpu.bc(), machine.cpu.de()}) {
        for (unsigned i = 0; i < 4; ++i) {
            machine.memory.bytes[static_cast<uint16_t>(begin + i)] = states.byte();
        }
    }
    machine.memory.bytes[machine.cpu.pc] = instruction.opcode;
    StepRecord record;
    machine.step(record);
    return record;
}

/// The transfers that `cycles` make, in the notation of transfers(). The first reads of an
/// instruction are its operand bytes.
std::string expected_transfers(const Instruction& instruction, const BusCycles& cycles) {
    std::string result;
    unsigned t = 0;
    unsigned operand_bytes = instruction.bytes - 1U;
    for (const BusCycle cycle : cycles.list()) {
        const unsigned end = t + 3;
        t += cycle == BusCycle::fetch4 ? 4U : cycle == BusCycle::fetch6 ? 6U : 3U;
        switch (cycle) {
            case BusCycle::fetch4:
            case BusCycle::fetch6:
                result += fmt::format("F@{} ", end);
                break;
            case BusCycle::memory_read:
                result += fmt::format("{}@{} ", operand_bytes > 0 ? "O" : "R", end);
                if (operand_bytes > 0) --operand_bytes;
                break;
            case BusCycle::memory_write:
                result += fmt::format("W@{} ", end);
                break;
            case BusCycle::io_read:
                result += fmt::format("I@{} ", end);
                break;
            case BusCycle::io_write:
                result += fmt::format("X@{} ", end);
                break;
            case BusCycle::bus_idle:
                break;
        }
    }
    return result;
}

std::string transfers(const StepRecord& record) {
    std::string result;
    for (unsigned i = 0; i < record.access_count; ++i) {
        const BusAccess& access = record.accesses[i];
        result += fmt::format("{}@{} ", "FORWIXA"[static_cast<unsigned>(access.kind)],
                              access.t - record.t_begin);
    }
    return result;
}

class Decoder : public testing::Test {
protected:
    /// Calls `check(instruction, state before, record)` for many states of every opcode.
    template <class Check>
    void for_all(Check check) {
        for (const Instruction& instruction : toolchain::isa::instruction_set()) {
            SCOPED_TRACE(fmt::format("{:02X} {}", instruction.opcode, instruction.text()));
            for (int i = 0; i < kStatesPerOpcode && !HasFailure(); ++i) {
                const StepRecord record = execute(machine_, states_, instruction);
                check(instruction, record);
            }
        }
    }

    RandomStates states_;
    FlatMachine machine_;
};

TEST_F(Decoder, TheTableCountsOpcodesInOrder) {
    unsigned opcode = 0;
    for (const Instruction& instruction : toolchain::isa::instruction_set()) {
        EXPECT_EQ(instruction.opcode, opcode++);
    }
}

TEST_F(Decoder, TStatesAgreeTakenAndNotTaken) {
    std::set<std::pair<uint8_t, uint64_t>> seen;
    for_all([&seen](const Instruction& instruction, const StepRecord& record) {
        const uint64_t t = record.t_end - record.t_begin;
        EXPECT_TRUE(t == instruction.t_taken || t == instruction.t_not_taken) << t << " T-states";
        seen.insert({instruction.opcode, t});
    });
    for (const Instruction& instruction : toolchain::isa::instruction_set()) {
        EXPECT_TRUE(seen.contains({instruction.opcode, instruction.t_taken})) << instruction.text();
        EXPECT_TRUE(seen.contains({instruction.opcode, instruction.t_not_taken}))
            << instruction.text();
    }
}

TEST_F(Decoder, MachineCyclesAgreeTakenAndNotTaken) {
    for_all([](const Instruction& instruction, const StepRecord& record) {
        const bool taken = record.t_end - record.t_begin == instruction.t_taken;
        EXPECT_EQ(transfers(record),
                  expected_transfers(instruction, taken ? instruction.cycles_taken
                                                        : instruction.cycles_not_taken));
    });
}

// The operand bytes follow the opcode; what is not a branch goes on behind them.
TEST_F(Decoder, LengthsAgree) {
    for_all([this](const Instruction& instruction, const StepRecord& record) {
        const bool taken = record.t_end - record.t_begin == instruction.t_taken;
        const auto behind = static_cast<uint16_t>(record.pc + instruction.bytes);
        const bool branches = instruction.flow != Flow::next && instruction.flow != Flow::halt &&
                              (taken || !instruction.conditional());
        if (!branches) {
            EXPECT_EQ(record.next_pc, behind);
        } else if (instruction.flow == Flow::call || instruction.flow == Flow::restart) {
            EXPECT_EQ(machine_.memory.bytes[machine_.cpu.sp], behind & 0xFF);
            EXPECT_EQ(machine_.memory.bytes[static_cast<uint16_t>(machine_.cpu.sp + 1)],
                      behind >> 8);
        }
        for (unsigned i = 1; i < record.access_count; ++i) {
            if (record.accesses[i].kind != BusAccess::Kind::operand) continue;
            EXPECT_EQ(record.accesses[i].address, static_cast<uint16_t>(record.pc + i));
            EXPECT_LT(i, instruction.bytes);
        }
    });
}

// Flags outside the table's mask never change; those inside do, unless the mask calls them
// unsettled. Bit 3 stays clear.
TEST_F(Decoder, FlagsThatMayChangeAgree) {
    for (const Instruction& instruction : toolchain::isa::instruction_set()) {
        SCOPED_TRACE(fmt::format("{:02X} {}", instruction.opcode, instruction.text()));
        uint8_t changed = 0;
        for (int i = 0; i < kStatesPerOpcode; ++i) {
            machine_.cpu = states_.registers();
            const CpuState before = machine_.cpu;
            machine_.memory.bytes[before.pc] = instruction.opcode;
            machine_.memory.bytes[static_cast<uint16_t>(before.pc + 1)] = states_.byte();
            if (before.hl() != before.pc) machine_.memory.bytes[before.hl()] = states_.byte();
            StepRecord record;
            machine_.step(record);
            changed |= static_cast<uint8_t>(before.f ^ machine_.cpu.f);
        }
        EXPECT_EQ(changed & ~instruction.flags, 0) << fmt::format("{:02X}", changed);
        int settled = instruction.flags & ~instruction.flags_unsettled;
        // Sets CY as the table says, but to what it was: A - A - CY borrows exactly when CY is set.
        if (instruction.text() == "SBB A") settled &= ~toolchain::isa::flag::kCarry;
        EXPECT_EQ(changed & settled, settled) << fmt::format("{:02X}", changed);
    }
}

// Intel left ten opcodes out; the documented set refuses exactly those, on both interpreters,
// leaving the state as it was.
TEST_F(Decoder, TheDocumentedSetRefusesTheTen) {
    const std::set<int> undocumented{0x08, 0x10, 0x18, 0x28, 0x38, 0xCB, 0xD9, 0xDD, 0xED, 0xFD};
    FlatMachine documented(InstructionSet::documented);
    for (const Instruction& instruction : toolchain::isa::instruction_set()) {
        SCOPED_TRACE(fmt::format("{:02X} {}", instruction.opcode, instruction.text()));
        const bool refused = undocumented.contains(instruction.opcode);
        EXPECT_EQ(instruction.documented, !refused);
        const CpuState before = states_.registers();
        StepRecord record;
        const auto check = [&](auto run) {
            documented.cpu = before;
            documented.memory.bytes[before.pc] = instruction.opcode;
            const host_sim::FlatMemory memory = documented.memory;
            EXPECT_EQ(run() == RunEnd::undefined_instruction, refused);
            EXPECT_EQ(documented.cpu.instructions, refused ? 0U : 1U);
            if (!refused) return;
            EXPECT_EQ(documented.cpu, before);
            EXPECT_EQ(documented.memory, memory);
        };
        check([&] { return documented.run(before.t + 1); });
        check([&] { return documented.run_reference(before.t + 1); });
        check([&] { return documented.step(record); });
    }
}

// An EI before an opcode that is refused still casts its shadow when the run is tried again.
TEST_F(Decoder, ARefusedOpcodeKeepsTheShadowOfEi) {
    FlatMachine documented(InstructionSet::documented);
    documented.cpu.t = 1000;
    documented.memory.bytes = {0xFB, 0x08};  // EI, DSUB
    EXPECT_EQ(documented.run(2000), RunEnd::undefined_instruction);
    EXPECT_TRUE(documented.cpu.ei_shadow);
    EXPECT_EQ(documented.cpu.pc, 1);
}

}  // namespace
