// recording_bus.hpp - a bus that notes every transfer in a StepRecord and passes it on.
// Depends on   reference.hpp, step_record.hpp.
// Use          built around the real bus for one observed step; unobserved runs never see it.
#pragma once

#include <cstdint>

#include "host_sim/cpu/reference.hpp"
#include "host_sim/cpu/step_record.hpp"

namespace host_sim {

/// Wraps `inner` for the duration of a step.
template <Bus B>
class RecordingBus {
public:
    RecordingBus(B& inner, StepRecord& record) : inner_(inner), record_(record) {}

    uint8_t fetch(uint16_t address, uint64_t t) {
        return note(BusAccess::Kind::fetch, address, inner_.fetch(address, t), t);
    }
    uint8_t operand(uint16_t address, uint64_t t) {
        return note(BusAccess::Kind::operand, address, inner_.operand(address, t), t);
    }
    uint8_t read(uint16_t address, uint64_t t) {
        return note(BusAccess::Kind::read, address, inner_.read(address, t), t);
    }
    void write(uint16_t address, uint8_t value, uint64_t t) {
        note(BusAccess::Kind::write, address, value, t);
        inner_.write(address, value, t);
    }
    uint8_t in(uint8_t port, uint64_t t) {
        return note(BusAccess::Kind::in, port, inner_.in(port, t), t);
    }
    void out(uint8_t port, uint8_t value, uint64_t t) {
        note(BusAccess::Kind::out, port, value, t);
        inner_.out(port, value, t);
    }
    uint8_t acknowledge(uint64_t t) {
        return note(BusAccess::Kind::acknowledge, 0, inner_.acknowledge(t), t);
    }
    void update_pins(uint64_t t) { inner_.update_pins(t); }
    void serial_out(bool level, uint64_t t) { inner_.serial_out(level, t); }

private:
    uint8_t note(BusAccess::Kind kind, uint16_t address, uint8_t value, uint64_t t) {
        record_.accesses[record_.access_count++] = {kind, address, value, t};
        return value;
    }

    B& inner_;
    StepRecord& record_;
};

/// The kind of a step that takes `interrupt`.
[[nodiscard]] constexpr StepRecord::Kind record_kind(Interrupt interrupt) {
    switch (interrupt) {
        case Interrupt::trap:
            return StepRecord::Kind::trap;
        case Interrupt::rst75:
            return StepRecord::Kind::rst75;
        case Interrupt::rst65:
            return StepRecord::Kind::rst65;
        case Interrupt::rst55:
            return StepRecord::Kind::rst55;
        case Interrupt::intr:
            return StepRecord::Kind::intr;
        case Interrupt::none:
            break;
    }
    return StepRecord::Kind::instruction;
}

/// Executes the instruction at PC, or takes `interrupt` if there is one, and fills `record`.
/// @return false, with the state unchanged, when the instruction is not in the set
template <Bus B>
bool step_recorded(CpuState& cpu, B& bus, InstructionSet set, Interrupt interrupt,
                   StepRecord& record) {
    record.kind = record_kind(interrupt);
    record.pc = cpu.pc;
    record.sp = cpu.sp;
    record.t_begin = cpu.t;
    record.access_count = 0;
    RecordingBus<B> recording(bus, record);
    Reference<RecordingBus<B>> reference(cpu, recording, set);
    if (interrupt != Interrupt::none) {
        reference.accept(interrupt);
    } else if (!reference.execute()) {
        return false;
    }
    record.next_pc = cpu.pc;
    record.next_sp = cpu.sp;
    record.t_end = cpu.t;
    return true;
}

}  // namespace host_sim
