// machine.hpp - what a drive on the board cost: the report's section about the machine.
// Depends on   the standard library; nlohmann-json and fmt in the source.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace report {

/// A value against what it may be.
struct MachineBar {
    std::string name;
    double value = 0, limit = 0;
    std::string unit;

    bool operator==(const MachineBar&) const = default;
};

/// T-states of every step of the log, and figures of the image.
struct Machine {
    std::string image;                                     ///< its identity
    std::vector<std::uint32_t> main_line_t, interrupts_t;  ///< by step
    std::vector<MachineBar> bars;

    bool operator==(const Machine&) const = default;
};

/// The section: a sentence and bars. The chart of the steps stands among the other charts.
std::string machine_section(const Machine& machine);

/// As a file beside the log, so that a report can be made again.
std::string machine_json(const Machine& machine);
/// @param file  name for messages. @errors  std::runtime_error: not what machine_json() writes
Machine parse_machine(std::string_view text, std::string_view file);

}  // namespace report
