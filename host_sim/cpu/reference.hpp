// reference.hpp - the plain 8085 interpreter: one switch, eager flags, every bus cycle.
// Depends on   cpu_state.hpp, interrupts.hpp, reference_table.hpp.
// Source       Intel 8085AH data sheet; MCS-80/85 Family User's Manual (docs/design/cpu.md).
// Use          the definition of what is correct: the fast interpreter is compared with it in lock
//              step, and everything that observes single bus cycles runs on it.
#pragma once

#include <cstdint>

#include "host_sim/cpu/cpu_state.hpp"
#include "host_sim/cpu/interrupts.hpp"
#include "host_sim/cpu/reference_table.hpp"

namespace host_sim {

/// One processor on one bus. Holds references only; all state is in CpuState.
template <Bus B>
class Reference {
public:
    Reference(CpuState& state, B& bus, InstructionSet set = InstructionSet::all)
        : x_{state, bus, state.t}, set_(set) {}

    /// Executes the instruction at PC, without looking at interrupts or HALT.
    /// @return false, with the state unchanged, when it is not in the instruction set
    bool execute() {
        x_.t = x_.s.t;
        const bool ei_shadow = x_.s.ei_shadow;
        x_.s.ei_shadow = false;
        const uint8_t opcode = x_.bus.fetch(x_.s.pc, x_.t + 3);
        ++x_.s.pc;
        x_.t += 4;
        if (!reference::dispatch(x_, opcode, set_)) {
            --x_.s.pc;
            x_.s.ei_shadow = ei_shadow;
            return false;
        }
        x_.s.t = x_.t;
        ++x_.s.instructions;
        return true;
    }

    /// Takes `interrupt`: INTA or idle cycle, then the push. Any acceptance clears IE.
    void accept(Interrupt interrupt) {
        x_.t = x_.s.t;
        x_.s.halted = false;
        x_.s.ei_shadow = false;  // the handler's first instruction does not stand behind EI
        if (interrupt == Interrupt::trap) {
            x_.s.trap_latch = false;
            x_.s.trap_saved_valid = true;
            x_.s.trap_saved_enable = x_.s.interrupt_enable;
        }
        if (interrupt == Interrupt::rst75) x_.s.rst75_latch = false;
        x_.s.interrupt_enable = false;
        if (interrupt == Interrupt::intr) {
            acknowledge();
        } else {
            x_.t += 6;
            x_.call(interrupt_vector(interrupt));
        }
        x_.s.t = x_.t;
    }

private:
    // INTA reads the instruction instead of memory and leaves PC alone; so do the second and third
    // byte of a CALL. The data sheet knows RST and CALL; any other byte is executed as it stands,
    // its operands from memory.
    void acknowledge() {
        const uint8_t opcode = x_.bus.acknowledge(x_.t + 3);
        x_.t += 4;
        if (opcode == 0xCD) {
            x_.t += 2;
            const uint8_t low = x_.bus.acknowledge(x_.t + 3);
            const uint8_t high = x_.bus.acknowledge(x_.t + 6);
            x_.t += 6;
            x_.call(static_cast<uint16_t>(high << 8 | low));
        } else {
            reference::dispatch(x_, opcode, set_);
        }
    }

    reference::Operations<B> x_;
    InstructionSet set_;
};

}  // namespace host_sim
