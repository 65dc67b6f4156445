// run.hpp - runs a machine to its end in slices, observed or at full speed.
// Depends on   machine.hpp.
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <vector>

#include "host_sim/cpu/cpu_state.hpp"
#include "host_sim/cpu/step_record.hpp"
#include "tools/i85run/machine.hpp"

namespace i85run {

/// How a run ended. The first three are what a program is meant to do.
enum class End : uint8_t {
    halt,                   ///< HLT
    returned,               ///< RET of the entry
    warm_boot,              ///< CP/M program over
    time_limit,             ///< max_t reached
    undefined_instruction,  ///< not in the documented set; PC at it
    rom_write,              ///< a write to protected memory, where that is an error
    return_lost,            ///< the program has overwritten the byte that its return needs
    interrupted,            ///< by the user
};

[[nodiscard]] constexpr bool finished(End end) {
    return end == End::halt || end == End::returned || end == End::warm_boot;
}

using Observer =
    std::function<void(const host_sim::StepRecord& step, const host_sim::CpuState& after)>;

/// What to run for, and who looks on.
struct RunRequest {
    uint64_t max_t = std::numeric_limits<uint64_t>::max();

    /// Each sees every step in order, and the processor behind it. With none the machine runs at
    /// full speed.
    std::vector<Observer> observers{};

    /// Serves the trap the machine is at, executing one step into the record.
    /// @return false when the program is over
    std::function<bool(Machine&, host_sim::StepRecord&)> serve_trap{};
    End end_at_trap = End::returned;  ///< what it is when serve_trap returns false or is empty

    /// Called between slices of kSliceT. A value ends the run.
    std::function<std::optional<End>(const Machine&)> between_slices{};
};

inline constexpr uint64_t kSliceT = 20'000'000;  ///< some 10 ms of host time

/// Runs until the program ends, max_t, or a reason to give up. Whole instructions only.
End run_to_end(Machine& machine, const RunRequest& request);

}  // namespace i85run
