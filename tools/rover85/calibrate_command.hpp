// calibrate_command.hpp - `rover85 calibrate`: options and help; the work is host_sim/calibration.
// Depends on   CLI11.     Format  docs/spec/calibration.md
// Tests        tests/tools/rover85/calibrate_command_test.cpp
#pragma once

#include <CLI/CLI.hpp>

/// Adds `calibrate` to the command line.
/// @param exit_code  set when it has run: 0; 2 for options that make no sense together; 3 for a log
///                   that cannot be read or does not hold what is needed (one line on standard
///                   error, nothing written). Must outlive `app`.
void add_calibrate_command(CLI::App& app, int& exit_code);
