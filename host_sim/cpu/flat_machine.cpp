// flat_machine.cpp - runs of a processor with 64 KB of RAM.
// Depends on   flat_machine.hpp, flat_bus.hpp, recording_bus.hpp.
#include "host_sim/cpu/flat_machine.hpp"

#include "host_sim/cpu/flat_bus.hpp"
#include "host_sim/cpu/recording_bus.hpp"

namespace host_sim {

RunEnd FlatMachine::run(uint64_t until_t) {
    until_t_ = until_t;
    undefined_ = false;
    while (cpu.t < until_t) {
        if (cpu.halted) return RunEnd::halted;
        if (pins_settled(cpu)) {
            run_fast(cpu, memory, *this, set_);
        } else {
            execute_exactly();
        }
        if (undefined_) return RunEnd::undefined_instruction;
    }
    return cpu.halted ? RunEnd::halted : RunEnd::time_limit;
}

bool FlatMachine::execute_exactly() {
    FlatBus bus{memory};
    undefined_ = !Reference<FlatBus>(cpu, bus, set_).execute();
    return !undefined_ && !cpu.halted && !cpu.ei_shadow;
}

RunEnd FlatMachine::run_reference(uint64_t until_t) {
    FlatBus bus{memory};
    Reference<FlatBus> reference(cpu, bus, set_);
    while (cpu.t < until_t && !cpu.halted) {
        if (!reference.execute()) return RunEnd::undefined_instruction;
    }
    return cpu.halted ? RunEnd::halted : RunEnd::time_limit;
}

RunEnd FlatMachine::step(StepRecord& record) {
    if (cpu.halted) return RunEnd::halted;
    FlatBus bus{memory};
    if (!step_recorded(cpu, bus, set_, Interrupt::none, record)) {
        return RunEnd::undefined_instruction;
    }
    return cpu.halted ? RunEnd::halted : RunEnd::time_limit;
}

}  // namespace host_sim
