// flat_machine.hpp - a processor with 64 KB of RAM: what plain programs run on.
// Depends on   cpu_state.hpp, fast.hpp, flat_memory.hpp, step_record.hpp.
// Absent       devices, interrupts; ports read FFH. The rover's board is host_sim/board.
#pragma once

#include <cstdint>

#include "host_sim/cpu/cpu_state.hpp"
#include "host_sim/cpu/fast.hpp"
#include "host_sim/cpu/flat_memory.hpp"
#include "host_sim/cpu/step_record.hpp"

namespace host_sim {

/// Why a run ended.
enum class RunEnd : uint8_t { time_limit, halted, undefined_instruction, violation };

/// Plain state and the ways to advance it. All three agree on every state, bit for bit.
class FlatMachine final : private FastHost {
public:
    explicit FlatMachine(InstructionSet set = InstructionSet::all) : set_(set) {}

    CpuState cpu;
    FlatMemory memory = all_ram();

    /// Runs until cpu.t >= until_t, HLT, or an instruction outside the set (PC stays on it).
    RunEnd run(uint64_t until_t);

    /// The same on the plain reference interpreter.
    RunEnd run_reference(uint64_t until_t);

    /// One instruction, recorded. In HALT, and on an instruction outside the set, nothing happens.
    /// @return the reason when nothing happened or HLT was executed, time_limit otherwise
    RunEnd step(StepRecord& record);

private:
    bool execute_exactly() override;
    [[nodiscard]] uint64_t run_until_t() const override { return until_t_; }

    InstructionSet set_;
    uint64_t until_t_ = 0;
    bool undefined_ = false;
};

}  // namespace host_sim
