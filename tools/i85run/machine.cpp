#include "tools/i85run/machine.hpp"

#include "host_sim/cpu/flat_bus.hpp"
#include "host_sim/cpu/interrupts.hpp"
#include "host_sim/cpu/recording_bus.hpp"
#include "host_sim/cpu/reference.hpp"

namespace i85run {

using host_sim::StepRecord;

/// The flat bus, but for writes into the protected range.
struct Machine::RomBus : host_sim::FlatBus {
    Machine& machine;
    uint16_t pc;

    explicit RomBus(Machine& owner) : FlatBus{owner.memory}, machine(owner), pc(owner.cpu.pc) {}

    void write(uint16_t address, uint8_t value, uint64_t t) const {
        if (machine.is_rom(address)) {
            machine.note_rom_write({pc, t, address, value});
        } else {
            FlatBus::write(address, value, t);
        }
    }
};

void Machine::add_trap(uint16_t address) {
    memory.bytes[address] = kHalt;
    traps_[address] = true;
}

void Machine::protect(host_sim::AddressRange range, bool strict) {
    rom_ = range;
    strict_ = strict;
    for (unsigned page = range.first / host_sim::kPageSize;
         page <= range.last / host_sim::kPageSize; ++page) {
        memory.page_writable[page] = false;
    }
}

void Machine::note_rom_write(const RomWrite& write) {
    rom_written_ = true;
    ++rom_write_count_;
    if (!first_rom_write_) first_rom_write_ = write;
}

Stop Machine::run(uint64_t until_t) {
    until_t_ = until_t;
    stop_.reset();
    while (!stop_) {
        if (cpu.halted) return Stop::halted;
        if (at_trap()) return Stop::trap;
        if (cpu.t >= until_t) return Stop::time_limit;
        if (host_sim::pins_settled(cpu)) {
            host_sim::run_fast(cpu, memory, *this, set_);
        } else {
            execute_exactly();
        }
    }
    return *stop_;
}

bool Machine::execute_exactly() {
    if (at_trap()) {
        stop_ = Stop::trap;
        return false;
    }
    RomBus bus(*this);
    rom_written_ = false;
    if (!host_sim::Reference<RomBus>(cpu, bus, set_).execute()) {
        stop_ = Stop::undefined_instruction;
    } else if (rom_written_ && strict_) {
        stop_ = Stop::rom_write;
    } else if (cpu.halted) {
        stop_ = Stop::halted;
    }
    return !stop_ && !cpu.ei_shadow;
}

Stop Machine::step(StepRecord& record) {
    if (cpu.halted) return Stop::halted;
    if (at_trap()) return Stop::trap;
    RomBus bus(*this);
    rom_written_ = false;
    if (!host_sim::step_recorded(cpu, bus, set_, host_sim::Interrupt::none, record)) {
        return Stop::undefined_instruction;
    }
    if (rom_written_ && strict_) return Stop::rom_write;
    return cpu.halted ? Stop::halted : Stop::time_limit;
}

void Machine::execute_instead(uint8_t opcode, StepRecord& record) {
    const uint16_t address = cpu.pc;
    const uint8_t kept = memory.bytes[address];
    memory.bytes[address] = opcode;
    RomBus bus(*this);
    host_sim::step_recorded(cpu, bus, host_sim::InstructionSet::all, host_sim::Interrupt::none,
                            record);
    memory.bytes[address] = kept;
}

}  // namespace i85run
