#include "tools/rover85/replay_command.hpp"

#include <fmt/format.h>

#include <memory>
#include <string>

#include "host_sim/bind/controller_target.hpp"
#include "host_sim/calibration/calibration_file.hpp"
#include "host_sim/log/log_io.hpp"
#include "tools/rover85/command_errors.hpp"
#include "tools/rover85/drive_output.hpp"
#include "tools/rover85/progress_bar.hpp"
#include "tools/rover85/target_option.hpp"

namespace {

struct ReplayOptions {
    std::string log, calibration, out = "out/replay";
    TargetOptions target;
};

int replay(const ReplayOptions& options) {
    host_sim::Log log = host_sim::load_log(options.log);
    if (!options.calibration.empty()) {
        log.head.calibration = host_sim::load_calibration(options.calibration);
    }
    if (log.unverified) {
        fmt::print(stderr, "rover85: {}: no checksum line; edits of this file go unnoticed\n",
                   options.log);
    }
    const auto target = make_target(options.target);
    {
        ProgressBar bar("Replaying");
        host_sim::replay(*target, log, [&bar](double share) { bar.update(share); });
    }
    write_drive_output(log, {options.out, "Replay of " + options.log,
                             "rover85 replay " + options.log, std::nullopt, machine_of(*target)});
    return kExitPass;
}

int report_again(const std::string& folder) {
    const std::filesystem::path log = std::filesystem::path(folder) / "traverse.rlog";
    write_drive_output(host_sim::load_log(log),
                       {folder, "Traverse report", "rover85 report " + folder, std::nullopt,
                        read_machine(folder)});
    return kExitPass;
}

}  // namespace

void add_replay_command(CLI::App& app, int& exit_code) {
    auto options = std::make_shared<ReplayOptions>();
    CLI::App& command = *app.add_subcommand(
        "replay", "Feed a recorded log (.rlog or wide CSV) to the controller and report on it");
    command.add_option("LOG", options->log, "Recorded log")->required()->type_name("LOG");
    add_target_options(command, options->target);
    command
        .add_option("--calibration", options->calibration,
                    "Calibration record to use instead of the log's own")
        ->type_name("TOML");
    command.add_option("--out", options->out, "Folder for the results")->capture_default_str();
    command.footer(
        "Row k of the log is held on all inputs throughout step k. Sensors that the log lacks "
        "stay\n"
        "absent; the report says which estimates are then not available.\n"
        "Examples:\n"
        "  rover85 replay out/simulate/traverse.rlog --out out/again\n"
        "  rover85 replay out/simulate/traverse.rlog --target board --out out/on_board\n"
        "  rover85 replay snow_13.rlog --calibration measured.toml");
    command.callback(
        [options, &exit_code] { exit_code = guarded_on_target([&] { return replay(*options); }); });
}

void add_report_command(CLI::App& app, int& exit_code) {
    auto folder = std::make_shared<std::string>();
    CLI::App& command = *app.add_subcommand(
        "report", "Write report.html, traverse.csv and summary.json again from DIR/traverse.rlog");
    command.add_option("DIR", *folder, "Folder of an earlier drive")->required();
    command.footer("Example:\n  rover85 report out/main");
    command.callback(
        [folder, &exit_code] { exit_code = guarded([&] { return report_again(*folder); }); });
}
