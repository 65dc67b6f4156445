// import_command.hpp - `rover85 import`: options and help; the work is host_sim/import.
// Depends on   CLI11.
// Tests        tests/tools/rover85/import_command_test.cpp
#pragma once

#include <CLI/CLI.hpp>

/// Adds `import borealtc` and `import omni` to the command line.
/// @param exit_code  set when one of them has run: 0, or 3 for a recording that is refused (one
///                   line on standard error, nothing written). Must outlive `app`.
void add_import_command(CLI::App& app, int& exit_code);
