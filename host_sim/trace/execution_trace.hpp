// execution_trace.hpp - what the processor did, a line a step, for people and for diff.
// Depends on   host_sim/cpu, host_sim/image, toolchain/isa.
// Format       docs/design/trace.md.
#pragma once

#include <cstdint>
#include <functional>
#include <ostream>
#include <string>
#include <string_view>

#include "host_sim/cpu/cpu_state.hpp"
#include "host_sim/cpu/step_record.hpp"
#include "host_sim/image/symbols.hpp"

namespace host_sim {

/// "TRAP", "RST 7.5" ... "INTR"; empty for a step that takes no interrupt.
[[nodiscard]] std::string_view interrupt_name(StepRecord::Kind kind);

/// What to write, and what is known besides the steps.
struct ExecutionTraceOptions {
    AddressRange addresses{};      ///< only steps that start in it
    uint64_t t_first = 0;          ///< only steps that begin at or after it,
    uint64_t t_last = UINT64_MAX;  ///< and not after this
    bool documented_only = false;  ///< undocumented opcodes as DB
    const Symbols* symbols = nullptr;
    /// Reads memory without side effects: for the operand byte that a conditional jump or call does
    /// not read when it is not taken. Without it that operand is shown as "?".
    std::function<uint8_t(uint16_t address)> peek{};
};

/// Writes steps as text.
class ExecutionTrace {
public:
    /// @param out  must outlive the trace
    ExecutionTrace(std::ostream& out, ExecutionTraceOptions options);

    /// Takes the next step.
    /// @param after  the processor behind it
    /// @errors  std::runtime_error when `out` takes no more
    void observe(const StepRecord& step, const CpuState& after);

    [[nodiscard]] uint64_t line_count() const { return lines_; }

private:
    std::ostream& out_;
    ExecutionTraceOptions options_;
    std::string line_;
    uint64_t lines_ = 0;
};

}  // namespace host_sim
