// main.cpp - rover85: the command line. Each command is a file of its own; this one lists them.
// Exit codes   0 pass, 1 regression or difference, 2 usage, 3 bad input (one line on standard
// error).
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "tools/rover85/board_command.hpp"
#include "tools/rover85/budget_command.hpp"
#include "tools/rover85/calibrate_command.hpp"
#include "tools/rover85/command_errors.hpp"
#include "tools/rover85/compare_command.hpp"
#include "tools/rover85/debug_command.hpp"
#include "tools/rover85/flash_command.hpp"
#include "tools/rover85/image_beside.hpp"
#include "tools/rover85/import_command.hpp"
#include "tools/rover85/main_job_command.hpp"
#include "tools/rover85/monitor_command.hpp"
#include "tools/rover85/recover_command.hpp"
#include "tools/rover85/replay_command.hpp"
#include "tools/rover85/simulate_command.hpp"
#include "tools/rover85/sweep_command.hpp"

int main(int argc, char** argv) {
    CLI::App app("rover85: slip and sinkage firmware of a microrover, driven on the host.");
    app.name("rover85");
    app.set_version_flag("--version", [] { return version_text(); });
    app.require_subcommand(1);
    app.footer(
        "Examples:\n"
        "  rover85 simulate --terrain wilcox1994 --roughness 0.02 --out out/first\n"
        "  rover85 replay out/first/traverse.rlog --out out/again\n"
        "  rover85 compare out/first/traverse.rlog\n"
        "  rover85 sweep slip --estimator map_grid --arithmetic fixed --seeds 40\n"
        "`rover85 COMMAND --help` shows the options of a command, with examples.");
    int exit_code = kExitPass;
    add_simulate_command(app, exit_code);
    add_replay_command(app, exit_code);
    add_compare_command(app, exit_code);
    add_sweep_command(app, exit_code);
    add_recover_command(app, exit_code);
    add_calibrate_command(app, exit_code);
    add_import_command(app, exit_code);
    add_report_command(app, exit_code);
    add_debug_command(app, exit_code);
    add_flash_command(app, exit_code);
    add_monitor_command(app, exit_code);
    add_board_command(app, exit_code);
    add_budget_command(app, exit_code);
    add_main_job_command(app, exit_code);
    try {
        app.parse(argc, argv);
    } catch (const CLI::RequiredError& error) {
        const std::vector<std::string> words = app.remaining();
        if (words.empty()) return app.exit(error) == 0 ? kExitPass : kExitUsage;
        fmt::print(stderr, "rover85: {}: no such command; `rover85 --help` lists them\n",
                   words.front());
        return kExitUsage;
    } catch (const CLI::ParseError& error) {
        return app.exit(error) == 0 ? kExitPass : kExitUsage;
    }
    return exit_code;
}
