// machine.hpp - a processor with 64 KB of memory, a write-protected range and trap addresses.
// Depends on   host_sim/cpu, host_sim/image (AddressRange).
// Absent       devices, interrupts; ports read FFH, what is written to them is lost.
// Design note  A trap is a HLT at a listed address. The fast interpreter leaves every HLT to its
//              host anyway, so traps cost nothing; the HLT itself is never executed nor counted.
//              A program that overwrites a trap byte has plain memory there.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "host_sim/cpu/cpu_state.hpp"
#include "host_sim/cpu/fast.hpp"
#include "host_sim/cpu/flat_memory.hpp"
#include "host_sim/cpu/step_record.hpp"
#include "host_sim/image/image.hpp"

namespace i85run {

/// A write into the protected range. The memory keeps its byte.
struct RomWrite {
    uint16_t pc = 0;  ///< of the instruction
    uint64_t t = 0;   ///< T-state at whose end the write was complete
    uint16_t address = 0;
    uint8_t value = 0;
};

/// Why the machine stopped. At `trap` and `undefined_instruction` PC is at that instruction.
enum class Stop : uint8_t { time_limit, trap, halted, undefined_instruction, rom_write };

/// The processor, its memory, and the ways to advance both.
class Machine final : private host_sim::FastHost {
public:
    explicit Machine(host_sim::InstructionSet set = host_sim::InstructionSet::all) : set_(set) {}

    host_sim::CpuState cpu;
    host_sim::FlatMemory memory = host_sim::all_ram();

    /// Puts a HLT at `address` and stops in front of it from now on.
    void add_trap(uint16_t address);

    /// @return whether PC is at a trap whose HLT is still there
    [[nodiscard]] bool at_trap() const { return traps_[cpu.pc] && memory.bytes[cpu.pc] == kHalt; }

    /// Protects `range` from writes of the program.
    /// @param strict  run and step stop with rom_write behind an instruction that tried
    void protect(host_sim::AddressRange range, bool strict);

    [[nodiscard]] uint64_t rom_write_count() const { return rom_write_count_; }
    [[nodiscard]] const std::optional<RomWrite>& first_rom_write() const {
        return first_rom_write_;
    }

    /// Runs at full speed until cpu.t >= until_t or one of the other reasons to stop.
    Stop run(uint64_t until_t);

    /// One instruction, recorded. At a trap, in HALT and on an instruction outside the set nothing
    /// happens, and `record` is as it was.
    /// @return time_limit, when there is no reason to stop
    Stop step(host_sim::StepRecord& record);

    /// Executes `opcode` (one byte) in place of the byte at PC, recorded. Memory is as before.
    void execute_instead(uint8_t opcode, host_sim::StepRecord& record);

private:
    struct RomBus;
    static constexpr uint8_t kHalt = 0x76;

    bool execute_exactly() override;
    [[nodiscard]] uint64_t run_until_t() const override { return until_t_; }
    [[nodiscard]] bool is_rom(uint16_t address) const {
        return rom_ && rom_->first <= address && address <= rom_->last;
    }
    void note_rom_write(const RomWrite& write);

    host_sim::InstructionSet set_;
    uint64_t until_t_ = 0;
    std::optional<Stop> stop_;
    std::array<bool, 0x10000> traps_{};
    std::optional<host_sim::AddressRange> rom_;
    bool strict_ = false;
    bool rom_written_ = false;  ///< by the current instruction
    uint64_t rom_write_count_ = 0;
    std::optional<RomWrite> first_rom_write_;
};

}  // namespace i85run
