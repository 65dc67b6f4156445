// run_test.cpp - runs end for the right reason, and the same observed and at full speed.
#include "tools/i85run/run.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <initializer_list>

namespace {

using i85run::End;
using i85run::Machine;
using i85run::run_to_end;
using i85run::RunRequest;

class I85runRun : public testing::TestWithParam<bool> {
protected:
    void load(std::initializer_list<uint8_t> bytes) {
        std::ranges::copy(bytes, machine_.memory.bytes.begin());
    }

    End run() {
        if (GetParam()) {
            request_.observers.emplace_back(
                [this](const host_sim::StepRecord& step, const host_sim::CpuState& after) {
                    seen_t_ += step.t_end - step.t_begin;
                    EXPECT_EQ(after.pc, step.next_pc);
                });
        }
        const End end = run_to_end(machine_, request_);
        if (GetParam()) {
            EXPECT_EQ(seen_t_, machine_.cpu.t) << "every step is shown once";
        }
        return end;
    }

    Machine machine_;
    RunRequest request_;
    uint64_t seen_t_ = 0;
};

TEST_P(I85runRun, HltIsIncluded) {
    load({0x00, 0x76});
    EXPECT_EQ(run(), End::halt);
    EXPECT_EQ(machine_.cpu.t, 9u);
}

TEST_P(I85runRun, TheLimitStopsAtTheFirstInstructionBoundaryBehindIt) {
    load({0xC3, 0x00, 0x00});  // JMP 0: 10 T each
    request_.max_t = 95;
    EXPECT_EQ(run(), End::time_limit);
    EXPECT_EQ(machine_.cpu.t, 100u);
    EXPECT_EQ(machine_.cpu.instructions, 10u);
}

TEST_P(I85runRun, ALimitOfNothingRunsNothing) {
    load({0xC3, 0x00, 0x00});
    request_.max_t = 0;
    EXPECT_EQ(run(), End::time_limit);
    EXPECT_EQ(machine_.cpu.instructions, 0u);
}

TEST_P(I85runRun, AnEndInTheVeryLastTStateCounts) {
    load({0x00, 0x76});
    request_.max_t = 9;
    EXPECT_EQ(run(), End::halt);
}

TEST_P(I85runRun, ATrapWithoutServiceIsTheReturn) {
    load({0x00, 0xC3, 0x00, 0x10});
    machine_.add_trap(0x1000);
    request_.max_t = 14;
    EXPECT_EQ(run(), End::returned);
    EXPECT_EQ(machine_.cpu.t, 14u);
}

TEST_P(I85runRun, AServedTrapGoesOnUntilItEnds) {
    load({0xCD, 0x00, 0x10, 0xC3, 0x00, 0x00});  // CALL 1000h (18); JMP 0 (10)
    machine_.cpu.sp = 0x4000;
    machine_.add_trap(0x1000);
    int calls = 0;
    request_.end_at_trap = End::warm_boot;
    request_.serve_trap = [&calls](Machine& machine, host_sim::StepRecord& record) {
        if (++calls == 3) return false;
        machine.execute_instead(0xC9, record);  // RET (10)
        return true;
    };
    EXPECT_EQ(run(), End::warm_boot);
    EXPECT_EQ(machine_.cpu.t, 2u * (18 + 10 + 10) + 18);
    EXPECT_EQ(machine_.cpu.instructions, 7u);
}

TEST_P(I85runRun, BetweenSlicesTheUserMayEndIt) {
    load({0xC3, 0x00, 0x00});
    request_.between_slices = [](const Machine& machine) {
        EXPECT_EQ(machine.cpu.t, i85run::kSliceT);
        return std::optional(End::interrupted);
    };
    EXPECT_EQ(run(), End::interrupted);
}

TEST_P(I85runRun, StrictRomWriteAndUndefinedInstructionEndIt) {
    machine_ = Machine(host_sim::InstructionSet::documented);
    load({0x32, 0x00, 0x00, 0x10});  // STA 0; ARHL
    EXPECT_EQ(run(), End::undefined_instruction);
    machine_ = Machine();
    load({0x32, 0x00, 0x00, 0x10});
    machine_.protect({0, 0xFF}, true);
    seen_t_ = 0;
    request_.observers.clear();
    EXPECT_EQ(run(), End::rom_write);
    EXPECT_EQ(machine_.cpu.t, 13u);
}

INSTANTIATE_TEST_SUITE_P(FastAndObserved, I85runRun, testing::Bool());

}  // namespace
