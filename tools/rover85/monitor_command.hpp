// monitor_command.hpp - `rover85 monitor`: what a rover says, as it says it.
// Depends on   CLI11.     Guide  docs/guides/monitoring.md
#pragma once

#include <CLI/CLI.hpp>

/// Adds `monitor` to the command line.
/// @param exit_code  set when it has run: 0; 1 when the simulated board fails; 3 for a port that
///                   cannot be used, no telemetry, or a file that cannot be written (one line on
///                   standard error). Must outlive `app`.
void add_monitor_command(CLI::App& app, int& exit_code);
