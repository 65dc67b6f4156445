// sweep_command.hpp - `rover85 sweep`: options and help; the work is host_sim/campaign.
// Depends on   CLI11.
#pragma once

#include <CLI/CLI.hpp>

/// Adds `sweep slip`, `sweep table1` and `sweep alarm` to the command line.
/// @param exit_code  set when one of them has run: 0, or 2 for options that make no sense together.
///                   Must outlive `app`.
void add_sweep_command(CLI::App& app, int& exit_code);
