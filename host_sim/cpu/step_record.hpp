// step_record.hpp - what one step of the processor did on its bus, for trace, profile and coverage.
// Depends on   the standard library.
// Use          filled by the observed interpreter only; the fast one never builds it.
#pragma once

#include <array>
#include <cstdint>

namespace host_sim {

/// One machine cycle that used the bus.
struct BusAccess {
    enum class Kind : uint8_t { fetch, operand, read, write, in, out, acknowledge };
    Kind kind = Kind::fetch;
    uint16_t address = 0;  ///< for in and out the port number
    uint8_t value = 0;
    uint64_t t = 0;  ///< T-state at whose end the transfer is complete
};

/// One step: an instruction, an accepted interrupt, or time passing in HALT.
struct StepRecord {
    enum class Kind : uint8_t { instruction, trap, rst75, rst65, rst55, intr, halt };
    Kind kind = Kind::instruction;
    uint16_t pc = 0;  ///< before; of an instruction its address, of an interrupt the return address
    uint16_t sp = 0;  ///< before
    uint16_t next_pc = 0;
    uint16_t next_sp = 0;
    uint64_t t_begin = 0;
    uint64_t t_end = 0;
    uint8_t access_count = 0;
    std::array<BusAccess, 6> accesses{};  ///< of an instruction the first one is its opcode fetch

    [[nodiscard]] uint8_t opcode() const { return accesses[0].value; }
};

}  // namespace host_sim
