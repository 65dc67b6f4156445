// comparison.hpp - what two targets made of the same log, output by output.
// Depends on   host_sim/log.
// Compared     telemetry frame byte by byte, drive motors, steering motors, mast, lasers, of every
//              step.
// Design note  docs/design/targets.md
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "host_sim/log/log.hpp"

namespace host_sim {

/// The first output that differs.
struct Divergence {
    std::size_t step = 0;  ///< index in the log
    uint32_t time_ms = 0;
    std::string signal;         ///< "telemetry position_q4_mm (byte 17)", "drive motor 3", ...
    std::string first, second;  ///< both values; those of a word also as a number
};

struct Comparison {
    std::size_t steps = 0;   ///< compared, up to and with the one that differs
    std::size_t frames = 0;  ///< telemetry frames that are the same
    std::size_t bytes = 0;   ///< of them
    std::optional<Divergence> divergence;
};

/// Compares the commands of both logs, step by step, up to the first difference. A step without
/// commands differs from one that has them.
[[nodiscard]] Comparison compare_outputs(const Log& first, const Log& second);

/// Name of the telemetry field that a byte of the frame belongs to, and where the field begins:
/// docs/spec/telemetry.md.
struct TelemetryField {
    std::string_view name;
    std::size_t offset = 0;
    std::size_t size = 1;
    bool is_signed = false;
};
[[nodiscard]] TelemetryField telemetry_field_at(std::size_t offset);

}  // namespace host_sim
