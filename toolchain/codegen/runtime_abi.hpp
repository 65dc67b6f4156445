// runtime_abi.hpp - where the runtime routines have their operands: docs/spec/runtime.md as a
// table. Depends on   mir.hpp.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "toolchain/codegen/mir.hpp"

namespace toolchain::codegen {

/// A byte of an argument or result: a register, or a byte of a cell.
struct RoutineByte {
    Register where = Register::flags;  ///< flags: in the cell
    const char* cell = nullptr;
    uint8_t offset = 0;
};

struct RoutineAbi {
    std::vector<RoutineByte> arguments{};  ///< all bytes of the first, then of the second ...
    std::vector<RoutineByte> results{};
    RegisterSet clobbers = kAllRegisters;  ///< all that changes, results included
};

/// Nothing if there is no such routine.
[[nodiscard]] std::optional<RoutineAbi> routine_abi(const std::string& name);

}  // namespace toolchain::codegen
