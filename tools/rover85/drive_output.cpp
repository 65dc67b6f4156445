#include "tools/rover85/drive_output.hpp"

#include <fmt/format.h>

#include <future>
#include <iostream>
#include <stdexcept>

#include "host_sim/log/log_io.hpp"
#include "tools/report/report.hpp"
#include "tools/report/summary.hpp"

void write_drive_output(const host_sim::Log& log, const DriveOutputOptions& options) {
    std::error_code failed;
    std::filesystem::create_directories(options.folder, failed);
    if (failed || !std::filesystem::is_directory(options.folder)) {
        throw std::runtime_error(
            fmt::format("{}: cannot make this folder ({}); choose another --out",
                        options.folder.string(), failed.message()));
    }
    const report::Summary summary = report::summarize(log);
    report::ReportOptions page;
    page.title = options.title;
    page.command_line = options.command_line;
    page.csv_file = "traverse.csv";
    page.front_wheel_ahead_mm = options.front_wheel_ahead_mm;
    const std::filesystem::path report = options.folder / "report.html";
    // The wide CSV takes as long as the rest together, so it is written beside it.
    auto csv = std::async(std::launch::async,
                          [&] { host_sim::write_csv(options.folder / "traverse.csv", log); });
    host_sim::write_rlog(options.folder / "traverse.rlog", log);
    report::write_summary_json(summary, options.folder / "summary.json");
    report::write_report(log, page, report);
    csv.get();
    for (const std::string& sentence : report::sentences(summary)) std::cout << sentence << "\n";
    std::cout << "Report: " << report.string() << "\n";
}
