// drive_output.hpp - what every drive leaves in its folder, and the lines it prints.
// Files   report.html, traverse.csv, summary.json, traverse.rlog; machine.json of a measured drive
// on
//         the board.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "host_sim/log/log.hpp"
#include "tools/report/machine.hpp"

struct DriveOutputOptions {
    std::filesystem::path folder;
    std::string title;
    std::string command_line;
    std::optional<double> front_wheel_ahead_mm;  ///< of a vehicle with a linkage
    std::optional<report::Machine> machine{};    ///< of a measured drive on the board
};

/// Writes the four files into the folder (made when missing) and prints the summary and where the
/// report is.
/// @errors  std::runtime_error with one line: which file, why, what to do
void write_drive_output(const host_sim::Log& log, const DriveOutputOptions& options);

/// What machine.json in a folder says; nothing if there is none.
/// @errors  std::runtime_error: it cannot be used
std::optional<report::Machine> read_machine(const std::filesystem::path& folder);
