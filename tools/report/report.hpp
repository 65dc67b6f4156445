// report.hpp - the report of a drive: one HTML file that needs nothing else, not even a network.
// Depends on      host_sim/log/log.hpp.     Design note  docs/design/report.md
// Bounds          75,000 steps in at most 0.15 s and 3 MB (Report.SeventyFiveThousandSteps...).
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>

#include "host_sim/log/log.hpp"
#include "tools/report/machine.hpp"
#include "tools/report/summary.hpp"

namespace report {

struct ReportOptions {
    std::string title = "Traverse report";
    std::string command_line;  ///< shown under "Where this came from"; empty: not shown
    std::string csv_file;      ///< name of the file with every step; empty: the page names none

    /// Horizontal distance from rear to front wheel on level ground. When given, the ground chart
    /// draws what the front wheel met where it met it; else where the rear wheel then stood.
    std::optional<double> front_wheel_ahead_mm;

    /// Of a drive on the board. Its steps are shown when they are as many as the log's.
    std::optional<Machine> machine;

    std::size_t rows_per_chart_max = 4000;  ///< longer logs are drawn decimated, extremes kept
    std::size_t events_max = 250;           ///< rows of the table of events
};

/// The page as text. Any log is accepted, an empty one too. The same log and options give the same
/// bytes.
std::string report_html(const host_sim::Log& log, const ReportOptions& options);

/// Writes report_html() to a file, replacing it as a whole.
/// @errors  std::runtime_error naming the file, the reason and what to do; no half-written file
void write_report(const host_sim::Log& log, const ReportOptions& options,
                  const std::filesystem::path& file);

}  // namespace report
