// drive_output.hpp - what every drive leaves in its folder, and the lines it prints.
// Files   report.html, traverse.csv, summary.json, traverse.rlog.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "host_sim/log/log.hpp"

struct DriveOutputOptions {
    std::filesystem::path folder;
    std::string title;
    std::string command_line;
    std::optional<double> front_wheel_ahead_mm;  ///< of a vehicle with a linkage
};

/// Writes the four files into the folder (made when missing) and prints the summary and where the
/// report is.
/// @errors  std::runtime_error with one line: which file, why, what to do
void write_drive_output(const host_sim::Log& log, const DriveOutputOptions& options);
