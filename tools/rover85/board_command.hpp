// board_command.hpp - `rover85 board`: a simulated board on the desk, its link a serial port.
// Depends on   CLI11.     Guide  docs/guides/monitoring.md
#pragma once

#include <CLI/CLI.hpp>

/// Adds `board` to the command line.
/// @param exit_code  set when it has run: 0; 1 when the board fails; 3 for an image or a file that
///                   cannot be used (one line on standard error). Must outlive `app`.
void add_board_command(CLI::App& app, int& exit_code);
