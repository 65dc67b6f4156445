// scripted_machine.hpp - a processor for tests: RAM and ROM, ports, input pins by a script. Driven
// like the board: before every instruction the pins that have changed, then the interrupt if one is
// due, else HALT or the instruction.
// Use          run_stepwise() on the reference interpreter, run_quickly() on the fast one; both
// must
//              leave the same machine.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <initializer_list>
#include <vector>

#include "host_sim/cpu/cpu_state.hpp"
#include "host_sim/cpu/fast.hpp"
#include "host_sim/cpu/flat_memory.hpp"
#include "host_sim/cpu/interrupts.hpp"
#include "host_sim/cpu/recording_bus.hpp"
#include "host_sim/cpu/reference.hpp"
#include "host_sim/cpu/step_record.hpp"

namespace cpu_test {

/// An input pin that changes at the beginning of T-state `t`.
struct PinEvent {
    uint64_t t = 0;
    host_sim::Pin pin = host_sim::Pin::trap;
    bool level = false;
};

/// A byte that left by OUT, or (port 100H) the level that SIM gave to SOD.
struct Output {
    static constexpr uint16_t kSerial = 0x100;
    uint16_t port = 0;
    uint8_t value = 0;
    uint64_t t = 0;
    bool operator==(const Output&) const = default;
};

class ScriptedMachine : private host_sim::FastHost {
public:
    explicit ScriptedMachine(host_sim::InstructionSet set = host_sim::InstructionSet::all)
        : set_(set) {}

    host_sim::CpuState cpu;
    host_sim::FlatMemory memory = host_sim::all_ram();
    std::array<bool, host_sim::kPageCount> rom{};  ///< pages that ignore writes
    std::vector<PinEvent> events;                  ///< in the order of their times
    std::vector<uint8_t> acknowledge_bytes{0xFF};  ///< what INTA reads, over and over
    std::vector<Output> outputs;
    uint64_t exact_instructions = 0;  ///< that the fast interpreter left to its host
    bool stopped = false;             ///< on an instruction outside the set

    void put(uint16_t address, std::initializer_list<int> bytes) {
        for (const int byte : bytes) memory.bytes[address++] = static_cast<uint8_t>(byte);
    }
    /// The pages are not writable for the fast interpreter; with `read_only` for nobody.
    void protect(unsigned first_page, unsigned last_page, bool read_only) {
        for (unsigned page = first_page; page <= last_page; ++page) {
            memory.page_writable[page] = false;
            rom[page] = read_only;
        }
    }

    /// One step: an interrupt, one T-state of HALT, or an instruction.
    host_sim::StepRecord step() {
        using Kind = host_sim::StepRecord::Kind;
        deliver(cpu.t);
        host_sim::StepRecord record;
        const host_sim::Interrupt interrupt = host_sim::pending_interrupt(cpu);
        if (interrupt == host_sim::Interrupt::none && cpu.halted) {
            record.kind = Kind::halt;
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

    void run_stepwise(uint64_t until_t) {
        while (cpu.t < until_t && !stopped) step();
    }

    void run_quickly(uint64_t until_t) {
        until_t_ = until_t;
        while (cpu.t < until_t && !stopped) {
            deliver(cpu.t);
            const host_sim::Interrupt interrupt = host_sim::pending_interrupt(cpu);
            if (interrupt != host_sim::Interrupt::none) {
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

    /// Everything that both ways of running must agree on.
    [[nodiscard]] bool same(const ScriptedMachine& other) const {
        return cpu == other.cpu && memory == other.memory && outputs == other.outputs &&
               next_event_ == other.next_event_ && acknowledged_ == other.acknowledged_ &&
               stopped == other.stopped;
    }

private:
    struct ScriptedBus {
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
            return machine
                .acknowledge_bytes[machine.acknowledged_++ % machine.acknowledge_bytes.size()];
        }
        void update_pins(uint64_t t) const { machine.deliver(t); }
        void serial_out(bool level, uint64_t t) const {
            machine.outputs.push_back({Output::kSerial, static_cast<uint8_t>(level ? 1 : 0), t});
        }
    };

    void deliver(uint64_t t) {
        for (; next_event_ < events.size() && events[next_event_].t <= t; ++next_event_) {
            const PinEvent& event = events[next_event_];
            host_sim::set_pin(cpu, event.pin, event.level, event.t);
        }
    }
    bool execute_exactly() override {
        ScriptedBus bus{*this};
        ++exact_instructions;
        stopped = !host_sim::Reference<ScriptedBus>(cpu, bus, set_).execute();
        return !stopped && !cpu.halted && host_sim::pins_settled(cpu) &&
               host_sim::pending_interrupt(cpu) == host_sim::Interrupt::none;
    }
    [[nodiscard]] uint64_t run_until_t() const override {
        return next_event_ < events.size() ? std::min(until_t_, events[next_event_].t) : until_t_;
    }

    host_sim::InstructionSet set_;
    uint64_t until_t_ = 0;
    std::size_t next_event_ = 0;
    std::size_t acknowledged_ = 0;
};

}  // namespace cpu_test
