#include "tools/rover85/drive_output.hpp"

#include <fmt/format.h>

#include <fstream>
#include <future>
#include <iostream>
#include <iterator>
#include <stdexcept>

#include "host_sim/log/log_io.hpp"
#include "tools/report/report.hpp"
#include "tools/report/summary.hpp"

namespace {

constexpr const char* kMachineFile = "machine.json";

/// A drive that was not measured leaves no figures of an earlier one.
void write_machine(const DriveOutputOptions& options) {
    const std::filesystem::path file = options.folder / kMachineFile;
    std::filesystem::remove(file);
    if (!options.machine) return;
    std::ofstream stream(file, std::ios::binary);
    stream << report::machine_json(*options.machine);
    stream.close();
    if (!stream) throw std::runtime_error(file.string() + ": cannot be written; free some space");
}

}  // namespace

std::optional<report::Machine> read_machine(const std::filesystem::path& folder) {
    const std::filesystem::path file = folder / kMachineFile;
    if (!std::filesystem::exists(file)) return {};
    std::ifstream stream(file, std::ios::binary);
    const std::string text{std::istreambuf_iterator<char>(stream), {}};
    return report::parse_machine(text, file.string());
}

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
    page.machine = options.machine;
    const std::filesystem::path report = options.folder / "report.html";
    // The wide CSV takes as long as the rest together, so it is written beside it.
    auto csv = std::async(std::launch::async,
                          [&] { host_sim::write_csv(options.folder / "traverse.csv", log); });
    host_sim::write_rlog(options.folder / "traverse.rlog", log);
    report::write_summary_json(summary, options.folder / "summary.json");
    write_machine(options);
    report::write_report(log, page, report);
    csv.get();
    for (const std::string& sentence : report::sentences(summary)) std::cout << sentence << "\n";
    std::cout << "Report: " << report.string() << "\n";
}
