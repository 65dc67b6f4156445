// board_state.hpp - everything that the board RB-85 knows, as one copyable struct.
// Depends on   host_sim/cpu, host_sim/chips, hal/board/rb85.hpp.
// Use          a snapshot is a copy, a comparison is ==, a restore is an assignment, at any
//              instruction boundary: also in the middle of a conversion, a character, a page write.
#pragma once

#include <array>
#include <cstdint>
#include <deque>

#include "hal/board/rb85.hpp"
#include "host_sim/board/stimulus.hpp"
#include "host_sim/chips/analog_input.hpp"
#include "host_sim/chips/at28c256.hpp"
#include "host_sim/chips/i8251a.hpp"
#include "host_sim/chips/i82c54.hpp"
#include "host_sim/chips/i82c55a.hpp"
#include "host_sim/chips/motor_latch.hpp"
#include "host_sim/chips/presence_buffer.hpp"
#include "host_sim/chips/range_module.hpp"
#include "host_sim/chips/sod_watchdog.hpp"
#include "host_sim/cpu/cpu_state.hpp"
#include "host_sim/cpu/flat_memory.hpp"

namespace host_sim {

/// Which memory is fitted. The standard board has 32 KB of each; a smaller RAM leaves the rest of
/// the address space unmapped: reads yield FFH, writes are violations.
struct MemoryMap {
    uint16_t eeprom_last = hal::rb85::kEepromLast;
    uint16_t ram_first = hal::rb85::kRamFirst;
    uint16_t ram_last = hal::rb85::kRamLast;

    bool operator==(const MemoryMap&) const = default;
};

/// Something that working software does not do.
struct Violation {
    enum class Kind : uint8_t {
        none,
        unmapped_write,  ///< a write where no memory is
        eeprom_write,    ///< a byte that the EEPROM ignored: protected, busy or starting up
        unmapped_in,     ///< IN from a port that no chip answers
        unmapped_out,
    };
    Kind kind = Kind::none;
    uint16_t pc = 0;       ///< of the instruction, or the return address of an interrupt
    uint16_t address = 0;  ///< memory address or port
    uint8_t value = 0;
    uint64_t t = 0;

    bool operator==(const Violation&) const = default;
};

struct BoardState {
    explicit BoardState(const MemoryMap& memory_map = {});

    MemoryMap map;
    CpuState cpu;
    FlatMemory memory;  ///< the EEPROM's bytes as they read while it is not busy, and the RAM

    chips::At28c256 eeprom{hal::rb85::kClockHz};
    chips::I8251a usart;
    std::array<chips::I82c54, 3> timers;
    std::array<chips::I82c55a, 2> ppis;
    chips::AnalogInput analog{hal::rb85::kClockHz};
    chips::RangeModule range{hal::rb85::kClockHz};
    chips::MotorLatch motors;
    chips::PresenceBuffer presence;
    chips::SodWatchdog watchdog{hal::rb85::kClockHz};

    std::deque<Stimulus> stimuli;  ///< in the order of their times
    uint64_t event_t = 0;          ///< when something may happen without an access; 0: find out
    bool undervoltage = false;
    bool bumper = false;
    bool reset_pending = false;

    uint64_t violation_count = 0;
    Violation first_violation;
    Violation last_violation;
    uint64_t reset_count = 0;  ///< RESET pulses of this power-on, its own included

    bool operator==(const BoardState&) const = default;
};

}  // namespace host_sim
