// scripted_machine.cpp - see scripted_machine.hpp. Here once, because each bus makes the compiler
// build an interpreter of its own.
#include "scripted_machine.hpp"

#include <algorithm>

#include "host_sim/cpu/recording_bus.hpp"
#include "host_sim/cpu/reference.hpp"

namespace cpu_test {

using host_sim::Interrupt;
using host_sim::StepRecord;

struct ScriptedMachine::ScriptedBus {
    ScriptedMachine& machine;

    [[nodiscard]] uint8_t fetch(uint16_t address, uint64_t) const {
        return machine.memory.bytes[address];
    }
    [[nodiscard]] uint8_t operand(uint16_t address, uint64_t) const {
        return machine.memory.bytes[address];
    }
    [[nodiscard]] uint8_t read(uint16_t address, uint64_t) const {
        return machine.memory.bytes[address];
    }
    void write(uint16_t address, uint8_t value, uint64_t) const {
        if (!machine.rom[address / host_sim::kPageSize]) machine.memory.bytes[address] = value;
    }
    // Another value at every T-state, so that a wrong T-state is a wrong accumulator.
    [[nodiscard]] uint8_t in(uint8_t port, uint64_t t) const {
        return static_cast<uint8_t>(port * 37U + t * 101U);
    }
    void out(uint8_t port, uint8_t value, uint64_t t) const {
        machine.outputs.push_back({port, value, t});
    }
    [[nodiscard]] uint8_t acknowledge(uint64_t) const {
        const std::size_t at = machine.acknowledged_++ % machine.acknowledge_bytes.size();
        return machine.acknowledge_bytes[at];
    }
    void update_pins(uint64_t t) const { machine.deliver(t); }
    void serial_out(bool level, uint64_t t) const {
        machine.outputs.push_back({Output::kSerial, static_cast<uint8_t>(level ? 1 : 0), t});
    }
};

StepRecord ScriptedMachine::step() {
    deliver(cpu.t);
    StepRecord record;
    const Interrupt interrupt = host_sim::pending_interrupt(cpu);
    if (interrupt == Interrupt::none && cpu.halted) {
        record.kind = StepRecord::Kind::halt;
        record.pc = record.next_pc = cpu.pc;
        record.sp = record.next_sp = cpu.sp;
        record.t_begin = cpu.t;
        record.t_end = ++cpu.t;
    } else {
        ScriptedBus bus{*this};
        stopped = !host_sim::step_recorded(cpu, bus, set_, interrupt, record);
    }
    return record;
}

void ScriptedMachine::run_stepwise(uint64_t until_t) {
    while (cpu.t < until_t && !stopped) step();
}

void ScriptedMachine::run_quickly(uint64_t until_t) {
    until_t_ = until_t;
    while (cpu.t < until_t && !stopped) {
        deliver(cpu.t);
        const Interrupt interrupt = host_sim::pending_interrupt(cpu);
        if (interrupt != Interrupt::none) {
            ScriptedBus bus{*this};
            host_sim::Reference<ScriptedBus>(cpu, bus, set_).accept(interrupt);
        } else if (cpu.halted) {
            ++cpu.t;
        } else if (host_sim::pins_settled(cpu)) {
            host_sim::run_fast(cpu, memory, *this, set_);
        } else {
            execute_exactly();
        }
    }
}

void ScriptedMachine::deliver(uint64_t t) {
    for (; next_event_ < events.size() && events[next_event_].t <= t; ++next_event_) {
        const PinEvent& event = events[next_event_];
        host_sim::set_pin(cpu, event.pin, event.level, event.t);
    }
}

bool ScriptedMachine::execute_exactly() {
    ScriptedBus bus{*this};
    ++exact_instructions;
    stopped = !host_sim::Reference<ScriptedBus>(cpu, bus, set_).execute();
    return !stopped && !cpu.halted && host_sim::pins_settled(cpu) &&
           host_sim::pending_interrupt(cpu) == Interrupt::none;
}

uint64_t ScriptedMachine::run_until_t() const {
    return next_event_ < events.size() ? std::min(until_t_, events[next_event_].t) : until_t_;
}

}  // namespace cpu_test
