// interrupts.hpp - which interrupt is taken at an instruction boundary, and when that is certain.
// Depends on   cpu_state.hpp.
// Source       Intel 8085AH data sheet, "Interrupt and Serial I/O": inputs are sampled in the
//              next-to-last T-state of an instruction and throughout HALT. The wake-up granularity
//              of 1 T and that the EI shadow does not delay TRAP are inferences from it.
#pragma once

#include <cstdint>

#include "host_sim/cpu/cpu_state.hpp"

namespace host_sim {

enum class Interrupt : uint8_t { none, trap, rst75, rst65, rst55, intr };

/// A level present from the beginning of T-state x is seen by an instruction that ends at x + 2 or
/// later.
inline constexpr uint64_t kSampleLead = 2;

/// The highest-priority interrupt that is taken instead of the next instruction, at the boundary
/// `cpu.t`: TRAP, RST 7.5, 6.5, 5.5, INTR.
[[nodiscard]] Interrupt pending_interrupt(const CpuState& cpu);

/// True when pending_interrupt() can change only by an instruction or by a pin: no pin is younger
/// than the sampling lead and no EI is fresh. Until then instructions must be stepped one by one.
[[nodiscard]] bool pins_settled(const CpuState& cpu);

/// Start address of an interrupt with a fixed vector; 0 for none and intr.
[[nodiscard]] constexpr uint16_t interrupt_vector(Interrupt interrupt) {
    switch (interrupt) {
        case Interrupt::trap:
            return 0x0024;
        case Interrupt::rst75:
            return 0x003C;
        case Interrupt::rst65:
            return 0x0034;
        case Interrupt::rst55:
            return 0x002C;
        case Interrupt::none:
        case Interrupt::intr:
            break;
    }
    return 0;
}

}  // namespace host_sim
