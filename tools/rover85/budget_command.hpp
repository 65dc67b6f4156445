// budget_command.hpp - `rover85 budget`: options and help; the work is tools/budget.
// Depends on   CLI11.     Guide  docs/design/budget.md
#pragma once

#include <CLI/CLI.hpp>

/// Adds `budget` to the command line.
/// @param exit_code  set when it has run: 0; 1 when a number is not the reviewed one, a function
/// has
///                   no module, or the image fails on the board; 3 for files that cannot be used.
///                   Must outlive `app`.
void add_budget_command(CLI::App& app, int& exit_code);
