// fast.hpp - the fast 8085 interpreter: same states as reference.hpp, several times the speed.
// Depends on   cpu_state.hpp, flat_memory.hpp.
// Bounds       runs only while nothing looks: memory reads are plain, no observer is attached, no
//              interrupt can be taken before `until_t`. Everything else is left to the host.
// Design note  docs/design/cpu.md
#pragma once

#include <cstdint>

#include "host_sim/cpu/cpu_state.hpp"
#include "host_sim/cpu/flat_memory.hpp"

namespace host_sim {

/// What surrounds the fast interpreter.
class FastHost {
public:
    virtual ~FastHost() = default;

    /// Executes the one instruction at PC with all its bus cycles (on the reference interpreter).
    /// Asked for IN, OUT, EI, DI, RIM, SIM, HLT, DAA, instructions outside the set, and writes to
    /// pages that are not writable.
    /// @return whether the fast interpreter may go on, up to the (perhaps new) run_until_t()
    virtual bool execute_exactly() = 0;

    /// The T-state at or after which to stop at the next instruction boundary.
    [[nodiscard]] virtual uint64_t run_until_t() const = 0;
};

/// Runs whole instructions until cpu.t >= host.run_until_t(), or until the host says stop. Neither
/// HALT nor interrupts are looked at: the caller has dealt with them, and pins_settled(cpu) holds.
void run_fast(CpuState& cpu, FlatMemory& memory, FastHost& host, InstructionSet set);

}  // namespace host_sim
