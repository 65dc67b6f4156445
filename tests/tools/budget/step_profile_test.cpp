// step_profile_test.cpp - T-states by module and step. Programs are assembled by hand and run by
// the simulated board; expected values are sums of the data sheet's T-states.
#include "tools/budget/step_profile.hpp"

#include <gtest/gtest.h>

#include <span>

#include "host_sim/board/board.hpp"
#include "tests/support/trap_gate.hpp"

namespace {

using host_sim::Board;
using host_sim::StepRecord;
using rover_budget::InterruptInput;
using rover_budget::Module;
using rover_budget::ModuleKind;
using rover_budget::ProfileFigures;
using rover_budget::StepProfile;

constexpr uint16_t kStepCount = 0x8000;

// Modules of the program below.
enum : uint16_t { kBoot, kWork, kLibrary, kWait, kHandler, kOther };
const std::vector<Module> kModules = {
    {"boot", ModuleKind::boot},         {"work", ModuleKind::step},
    {"library", ModuleKind::library},   {"wait", ModuleKind::idle},
    {"handler", ModuleKind::interrupt}, {"other", ModuleKind::step}};

/// boot 0000, handler of TRAP 0024, work 0100, library 0200, wait 0300.
constexpr const char* kSymbols =
    "0000 0010 F boot\n0024 0010 I handler\n0100 0020 F work\n0200 0010 F library\n"
    "0300 0010 F wait\n";

class Profiled {
public:
    Profiled() {
        // boot: LXI SP,9000H 10; JMP work 10
        put(0x0000, {0x31, 0x00, 0x90, 0xC3, 0x00, 0x01});
        // handler: CALL library 18 (4+7 there, RET 10); RET 10
        put(0x0024, {0xCD, 0x00, 0x02, 0xC9});
        // work: CALL library 18; CALL wait 18; LXI H,8000H 10; INR M 10; JMP work 10
        put(0x0100, {0xCD, 0x00, 0x02, 0xCD, 0x00, 0x03, 0x21, 0x00, 0x80, 0x34, 0xC3, 0x00, 0x01});
        put(0x0200, {0x00, 0x3E, 0x00, 0xC9});  // library: NOP 4; MVI A 7; RET 10
        put(0x0300, {0x00, 0x00, 0xC9});        // wait: NOP 4; NOP 4; RET 10
        symbols = host_sim::read_symbols(kSymbols, "a.sym");
        module_of.assign(65536, kOther);
        for (unsigned at = 0; at < 0x0400; ++at) {
            module_of[at] = at < 0x0024   ? kBoot
                            : at < 0x0100 ? kHandler
                            : at < 0x0200 ? kWork
                            : at < 0x0300 ? kLibrary
                                          : kWait;
        }
        profile.emplace(StepProfile::Program{&symbols, &kModules, &module_of, kStepCount, 0x9000});
        profile->begin("a");
        profile->count_steps();
    }
    void put(uint16_t at, std::vector<uint8_t> bytes) { board.program(bytes, at); }
    void run(uint64_t until_t) {
        StepRecord record;
        while (board.state.cpu.t < until_t) {
            board.step(record, until_t);
            profile->observe(record, board.state.cpu);
        }
    }
    [[nodiscard]] const ProfileFigures& figures() const { return profile->figures(); }

    Board board;
    host_sim::Symbols symbols;
    std::vector<uint16_t> module_of;
    std::optional<StepProfile> profile;
};

// One round: work's own 18 + 18 + 10 + 10 + 10 = 66, library 21, wait 18: 105.
constexpr uint64_t kWorkT = 66 + 21, kWaitT = 18, kRoundT = kWorkT + kWaitT;
// From reset to the end of the first step: boot 20; of the round all but the JMP.
constexpr uint64_t kFirstEndT = 20 + kRoundT - 10;

TEST(StepProfile, AStepIsWhatLiesBetweenTwoCounts) {
    Profiled program;
    program.run(kFirstEndT + 4 * kRoundT);
    const ProfileFigures& figures = program.figures();
    EXPECT_EQ(figures.steps, 5u);
    EXPECT_EQ(figures.total_t, 5 * kRoundT - 10);
    EXPECT_EQ(figures.modules[kWork].total_t, 5 * kWorkT - 10);
    EXPECT_EQ(figures.modules[kWork].worst_t, kWorkT);
    EXPECT_EQ(figures.modules[kWork].worst, (rover_budget::WorstPlace{"a", 1}));
    EXPECT_EQ(figures.modules[kWait].total_t, 5 * kWaitT);
    EXPECT_EQ(figures.main_line.worst_t, kWorkT) << "no waiting";
    EXPECT_EQ(figures.interrupts.total_t, 0u);
}

TEST(StepProfile, LibraryTimeIsItsCallers) {
    Profiled program;
    program.run(kFirstEndT + 2 * kRoundT);
    EXPECT_EQ(program.figures().modules[kLibrary].total_t, 0u);
}

TEST(StepProfile, TheBootIsNoStep) {
    Profiled program;
    program.run(kFirstEndT);
    EXPECT_EQ(program.figures().boot_t, 20u);
    EXPECT_EQ(program.figures().main_line.total_t, kWorkT - 10);
}

TEST(StepProfile, StepsBeforeTheLogDoNotCount) {
    Profiled program;
    program.profile->begin("b");
    program.run(kFirstEndT + 2 * kRoundT);
    EXPECT_EQ(program.figures().steps, 0u);
    EXPECT_EQ(program.figures().boot_t, 20u);
    program.profile->count_steps();
    program.run(kFirstEndT + 5 * kRoundT);
    EXPECT_EQ(program.figures().steps, 3u);
    EXPECT_EQ(program.figures().modules[kWork].worst, (rover_budget::WorstPlace{"b", 0}));
}

TEST(StepTime, WorkInStepsInARowIsAddedUpAndEndsWithAStepWithoutAndWithTheLog) {
    rover_budget::StepTime time;
    uint64_t step = 0;
    for (const uint64_t t : {5u, 0u, 7u, 2u, 4u, 0u, 9u, 3u}) time.take(t, "a", step++);
    EXPECT_EQ(time.worst_run_t, 13u);  // 7 + 2 + 4
    EXPECT_EQ(time.worst_t, 9u);
    EXPECT_EQ(time.steps, 6u);
    step = 0;
    for (const uint64_t t : {4u, 6u, 0u}) time.take(t, "b", step++);
    EXPECT_EQ(time.worst_run_t, 13u) << "not 9 + 3 + 4 + 6";
    EXPECT_EQ(time.total_t, 40u);
}

TEST(StepProfile, TheDeepestStackThatWasSeen) {
    Profiled program;
    program.run(kFirstEndT);
    EXPECT_EQ(program.figures().stack_bytes, 2u);
}

// TRAP: accepted in 12 T; handler 18 + 21 + 10. The bumper is hit at T 200, in the middle of the
// third round's work: the instruction that runs then ends first.
TEST(StepProfile, AnInterruptIsNobodysStepTime) {
    Profiled program;
    test_support::open_trap_gate(program.board.state);
    program.board.schedule({200, host_sim::Stimulus::Kind::bumper, 0, 1});
    program.run(kFirstEndT + 4 * kRoundT + 61);
    const ProfileFigures& figures = program.figures();
    EXPECT_EQ(figures.steps, 5u);
    const auto& trap = figures.inputs[static_cast<std::size_t>(InterruptInput::trap)];
    EXPECT_EQ(trap.accepted, 1u);
    EXPECT_EQ(trap.total_t, 61u);
    EXPECT_EQ(trap.worst_t, 61u);
    EXPECT_EQ(figures.interrupts.total_t, 61u);
    EXPECT_EQ(figures.modules[kHandler].total_t, 61u);
    EXPECT_EQ(figures.modules[kWork].worst_t, kWorkT);
    // At least the acceptance itself; at most one CALL (18 T) and the sampling more.
    EXPECT_GE(trap.worst_latency_t, 12u);
    EXPECT_LE(trap.worst_latency_t, 12u + 18 + 2);
}

/// Latency of an RST 7.5 that asked at `asked_t`, whose mask opened at T 80, and whose acceptance
/// ended at T 112, from records made by hand.
uint64_t latency_of(uint64_t asked_t) {
    const host_sim::Symbols symbols = host_sim::read_symbols(kSymbols, "a.sym");
    const std::vector<uint16_t> module_of(65536, kWork);
    StepProfile profile({&symbols, &kModules, &module_of, kStepCount, 0x9000});
    profile.begin("a");
    profile.count_steps();
    host_sim::CpuState cpu;
    cpu.sp = 0x9000;
    const auto instruction = [&](uint64_t begin_t, uint64_t end_t) {
        StepRecord record;
        record.pc = record.next_pc = 0x0100;
        record.sp = record.next_sp = cpu.sp;
        record.t_begin = begin_t;
        record.t_end = cpu.t = end_t;
        record.accesses[0].value = 0x00;  // NOP
        record.access_count = 1;
        return record;
    };
    profile.observe(instruction(70, 76), cpu);
    cpu.masks = 0;
    profile.observe(instruction(76, 80), cpu);
    StepRecord accepted = instruction(100, 112);
    accepted.kind = StepRecord::Kind::rst75;
    accepted.next_pc = 0x003C;
    accepted.next_sp = cpu.sp = 0x8FFE;
    cpu.rst75_latched_t = asked_t;
    profile.observe(accepted, cpu);
    StepRecord counts = instruction(112, 122);
    counts.accesses[1] = {host_sim::BusAccess::Kind::write, kStepCount, 1, 122};
    counts.access_count = 2;
    profile.observe(counts, cpu);
    EXPECT_EQ(profile.figures().steps, 1u);
    return profile.figures()
        .inputs[static_cast<std::size_t>(InterruptInput::rst75)]
        .worst_latency_t;
}

TEST(StepProfile, AMaskIsNoLatencyButDisabledInterruptsAre) {
    EXPECT_EQ(latency_of(60), 112u - 80u);
    EXPECT_EQ(latency_of(90), 112u - 90u);
}

TEST(StepProfile, AResetBeginsAnew) {
    Profiled program;
    program.run(kFirstEndT + kRoundT);
    EXPECT_EQ(program.figures().steps, 2u);
    program.board.reset();
    program.board.state.memory.bytes[kStepCount] = 0;
    program.run(program.board.state.cpu.t + kFirstEndT + 2 * kRoundT);
    EXPECT_EQ(program.figures().steps, 5u);
    EXPECT_EQ(program.figures().boot_t, 20u);
}

}  // namespace
