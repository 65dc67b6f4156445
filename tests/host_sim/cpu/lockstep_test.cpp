// lockstep_test.cpp - thousands of random programs on the fast and the reference interpreter: after
// every slice of a run the whole state and all of memory are the same.
// Reproduce    a failure names its seed; everything about a program follows from it.
#include <gtest/gtest.h>

#include <memory>
#include <string>

#include "host_sim/cpu/flat_machine.hpp"
#include "random_program.hpp"
#include "scripted_machine.hpp"

namespace {

using cpu_test::RandomProgram;
using cpu_test::ScriptedMachine;
using host_sim::FlatMachine;
using host_sim::InstructionSet;
using host_sim::Pin;
using host_sim::RunEnd;
using host_sim::StepRecord;

InstructionSet set_of(uint32_t seed) {
    return seed % 3 == 0 ? InstructionSet::documented : InstructionSet::all;
}

/// What ended a run is not the end of the comparison.
void revive(FlatMachine& machine, RunEnd end) {
    machine.cpu.halted = false;
    if (end == RunEnd::undefined_instruction) ++machine.cpu.pc;
}

testing::AssertionResult same(const FlatMachine& left, const FlatMachine& right) {
    if (left.cpu == right.cpu && left.memory == right.memory) return testing::AssertionSuccess();
    const auto text = [](const host_sim::CpuState& cpu) {
        return "T " + std::to_string(cpu.t) + " instructions " + std::to_string(cpu.instructions) +
               " PC " + std::to_string(cpu.pc) + " A " + std::to_string(cpu.a) + " F " +
               std::to_string(cpu.f);
    };
    return testing::AssertionFailure() << text(left.cpu) << " / " << text(right.cpu);
}

// Slices end at the first instruction boundary at or behind their end, on both. Pages that are not
// writable make the fast interpreter ask its host: the result is the same.
TEST(Lockstep, PlainProgramsAgreeAfterEverySlice) {
    const auto fast = std::make_unique<FlatMachine>();
    const auto plain = std::make_unique<FlatMachine>();
    uint64_t instructions = 0;
    for (uint32_t seed = 0; seed < 3000; ++seed) {
        *fast = FlatMachine(set_of(seed));
        RandomProgram program(seed);
        program.make(fast->cpu, fast->memory);
        for (uint32_t page = program.below(512); page < 256; page += 1 + program.below(64)) {
            fast->memory.page_writable[page] = false;
        }
        *plain = *fast;
        for (int slice = 0; slice < 12; ++slice) {
            const uint64_t until_t = fast->cpu.t + program.slice();
            const RunEnd end = fast->run(until_t);
            ASSERT_EQ(end, plain->run_reference(until_t)) << "seed " << seed << " slice " << slice;
            ASSERT_TRUE(same(*fast, *plain)) << "seed " << seed << " slice " << slice;
            ASSERT_TRUE(end != RunEnd::time_limit || fast->cpu.t >= until_t) << "seed " << seed;
            revive(*fast, end);
            revive(*plain, end);
        }
        instructions += plain->cpu.instructions;
    }
    EXPECT_GT(instructions, 10'000'000U) << "the programs do not run";
}

// step() does what run() does, one instruction at a time.
TEST(Lockstep, RecordedStepsAgree) {
    const auto fast = std::make_unique<FlatMachine>();
    const auto stepped = std::make_unique<FlatMachine>();
    for (uint32_t seed = 0; seed < 300; ++seed) {
        *fast = FlatMachine(set_of(seed));
        RandomProgram program(seed);
        program.make(fast->cpu, fast->memory);
        *stepped = *fast;
        for (int i = 0; i < 300; ++i) {
            StepRecord record;
            const RunEnd end = stepped->step(record);
            ASSERT_EQ(end, fast->run(fast->cpu.t + 1)) << "seed " << seed << " step " << i;
            ASSERT_EQ(stepped->cpu, fast->cpu) << "seed " << seed << " step " << i;
            revive(*stepped, end);
            revive(*fast, end);
        }
        ASSERT_TRUE(same(*fast, *stepped)) << "seed " << seed;
    }
}

// One run is the sum of its parts, wherever it is cut.
TEST(Lockstep, CutsLeaveNoTrace) {
    const auto whole = std::make_unique<FlatMachine>();
    const auto cut = std::make_unique<FlatMachine>();
    for (uint32_t seed = 0; seed < 500; ++seed) {
        *whole = FlatMachine();
        RandomProgram program(seed);
        program.make(whole->cpu, whole->memory);
        *cut = *whole;
        const uint64_t until_t = whole->cpu.t + 50'000;
        const RunEnd end = whole->run(until_t);
        RunEnd cut_end = RunEnd::time_limit;
        while (cut->cpu.t < until_t && cut_end == RunEnd::time_limit) {
            cut_end = cut->run(std::min(until_t, cut->cpu.t + program.slice()));
        }
        ASSERT_EQ(end, cut_end) << "seed " << seed;
        ASSERT_TRUE(same(*whole, *cut)) << "seed " << seed;
    }
}

/// Pins that change at random: bursts of 1 T and long levels, all pins, in the order of time.
void script_pins(ScriptedMachine& machine, RandomProgram& program) {
    uint64_t t = machine.cpu.t;
    for (uint32_t n = program.below(200); n > 0; --n) {
        t += program.one_in(3) ? program.below(4) : program.below(2000);
        machine.events.push_back(
            {t, static_cast<Pin>(program.below(host_sim::kPinCount)), program.one_in(2)});
    }
    static constexpr std::array<uint8_t, 8> kAcknowledged{0xC7, 0xD7, 0xFF, 0xCD,
                                                          0x40, 0x01, 0x00, 0xFB};
    machine.acknowledge_bytes.clear();
    for (uint32_t n = 1 + program.below(4); n > 0; --n) {
        machine.acknowledge_bytes.push_back(kAcknowledged[program.below(8)]);
    }
}

void protect_pages(ScriptedMachine& machine, RandomProgram& program) {
    if (program.one_in(2)) return;
    const uint32_t first = program.below(256);
    const uint32_t last = first + program.below(256 - first);
    machine.protect(first, last, program.one_in(2));
}

// The fast interpreter between pin events, as a board uses it, against a stepwise run that looks at
// the pins before every instruction: ROM, ports whose input depends on the T-state, interrupts,
// HALT, RIM in the middle of changes.
TEST(Lockstep, InterruptedProgramsAgreeAfterEverySlice) {
    const auto fast = std::make_unique<ScriptedMachine>();
    const auto plain = std::make_unique<ScriptedMachine>();
    uint64_t instructions = 0;
    uint64_t exact = 0;
    for (uint32_t seed = 0; seed < 1000; ++seed) {
        *fast = ScriptedMachine(set_of(seed));
        RandomProgram program(seed);
        program.make(fast->cpu, fast->memory);
        script_pins(*fast, program);
        protect_pages(*fast, program);
        *plain = *fast;
        for (int slice = 0; slice < 8 && !plain->stopped; ++slice) {
            const uint64_t until_t = fast->cpu.t + program.slice();
            fast->run_quickly(until_t);
            plain->run_stepwise(until_t);
            ASSERT_TRUE(fast->same(*plain)) << "seed " << seed << " slice " << slice;
        }
        instructions += plain->cpu.instructions;
        exact += fast->exact_instructions;
    }
    EXPECT_GT(instructions, 2'000'000U) << "the programs do not run";
    EXPECT_LT(exact * 2, instructions) << "the fast interpreter has been left out";
}

// A snapshot is a copy: taken in the middle, both continue alike, whoever continues.
TEST(Lockstep, SnapshotsContinueAlike) {
    const auto machine = std::make_unique<ScriptedMachine>();
    for (uint32_t seed = 0; seed < 500; ++seed) {
        *machine = ScriptedMachine();
        RandomProgram program(seed);
        program.make(machine->cpu, machine->memory);
        script_pins(*machine, program);
        machine->run_quickly(machine->cpu.t + program.slice());
        const auto snapshot = std::make_unique<ScriptedMachine>(*machine);
        const uint64_t until_t = machine->cpu.t + program.slice();
        machine->run_quickly(until_t);
        const auto first = std::make_unique<ScriptedMachine>(*machine);
        *machine = *snapshot;
        ASSERT_TRUE(machine->same(*snapshot)) << "seed " << seed;
        machine->run_quickly(until_t);
        ASSERT_TRUE(machine->same(*first)) << "seed " << seed;
        snapshot->run_stepwise(until_t);
        ASSERT_TRUE(snapshot->same(*first)) << "seed " << seed;
    }
}

}  // namespace
