// scripted_machine.hpp - a processor for tests: RAM and ROM, ports, input pins by a script. Driven
// like the board: before every instruction the pins that have changed, then the interrupt if one is
// due, else HALT or the instruction.
// Use          run_stepwise() on the reference interpreter, run_quickly() on the fast one; both
// must
//              leave the same machine.
#pragma once

#include <array>
#include <cstdint>
#include <initializer_list>
#include <vector>

#include "host_sim/cpu/cpu_state.hpp"
#include "host_sim/cpu/fast.hpp"
#include "host_sim/cpu/flat_memory.hpp"
#include "host_sim/cpu/interrupts.hpp"
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
    host_sim::StepRecord step();
    void run_stepwise(uint64_t until_t);
    void run_quickly(uint64_t until_t);

    /// Everything that both ways of running must agree on.
    [[nodiscard]] bool same(const ScriptedMachine& other) const {
        return cpu == other.cpu && memory == other.memory && outputs == other.outputs &&
               next_event_ == other.next_event_ && acknowledged_ == other.acknowledged_ &&
               stopped == other.stopped;
    }

private:
    struct ScriptedBus;

    void deliver(uint64_t t);
    bool execute_exactly() override;
    [[nodiscard]] uint64_t run_until_t() const override;

    host_sim::InstructionSet set_;
    uint64_t until_t_ = 0;
    std::size_t next_event_ = 0;
    std::size_t acknowledged_ = 0;
};

}  // namespace cpu_test
