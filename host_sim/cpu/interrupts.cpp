// interrupts.cpp - pins, edge latches, RESET, and which interrupt is taken next.
// Depends on   cpu_state.hpp, interrupts.hpp.
#include "host_sim/cpu/interrupts.hpp"

#include <algorithm>

namespace host_sim {

void set_pin(CpuState& cpu, Pin which, bool level, uint64_t t) {
    PinState& pin = cpu.pins[static_cast<unsigned>(which)];
    if (pin.level == level) return;
    if (pin.changed_t == t) {
        pin.level = level;  // what lasted no T-state was no level
    } else {
        pin = {level, pin.level, pin.previous, t, pin.changed_t};
    }
    cpu.pins_changed_t = std::max(cpu.pins_changed_t, t);
    if (which == Pin::trap && level && !cpu.trap_latch) {
        cpu.trap_latch = true;
        cpu.trap_latched_t = t;
    }
    if (which == Pin::rst75 && level && !cpu.rst75_latch) {
        cpu.rst75_latch = true;
        cpu.rst75_latched_t = t;
    }
}

void reset(CpuState& cpu) {
    cpu.pc = 0;
    cpu.halted = false;
    cpu.interrupt_enable = false;
    cpu.ei_shadow = false;
    cpu.masks = mask::kAll;
    cpu.rst75_latch = false;
    cpu.trap_latch = false;
    cpu.trap_saved_valid = false;
    cpu.sod = false;
}

namespace {

bool seen(uint64_t change_t, uint64_t boundary_t) {
    return change_t + kSampleLead <= boundary_t;
}

bool sampled(const PinState& pin, uint64_t boundary_t) {
    if (seen(pin.changed_t, boundary_t)) return pin.level;
    return seen(pin.previous_changed_t, boundary_t) ? pin.previous : pin.older;
}

}  // namespace

Interrupt pending_interrupt(const CpuState& cpu) {
    if (cpu.trap_latch && seen(cpu.trap_latched_t, cpu.t) && sampled(cpu.pin(Pin::trap), cpu.t)) {
        return Interrupt::trap;
    }
    if (!cpu.interrupt_enable || cpu.ei_shadow) return Interrupt::none;
    if (cpu.rst75_latch && seen(cpu.rst75_latched_t, cpu.t) && (cpu.masks & mask::kRst75) == 0) {
        return Interrupt::rst75;
    }
    if (sampled(cpu.pin(Pin::rst65), cpu.t) && (cpu.masks & mask::kRst65) == 0) {
        return Interrupt::rst65;
    }
    if (sampled(cpu.pin(Pin::rst55), cpu.t) && (cpu.masks & mask::kRst55) == 0) {
        return Interrupt::rst55;
    }
    if (sampled(cpu.pin(Pin::intr), cpu.t)) return Interrupt::intr;
    return Interrupt::none;
}

bool pins_settled(const CpuState& cpu) {
    return seen(cpu.pins_changed_t, cpu.t) && !cpu.ei_shadow;
}

}  // namespace host_sim
