// flash_command.hpp - `rover85 flash`: an image to a memory part; today to files for a programmer.
// Depends on   CLI11.     Guide  docs/guides/flashing.md
// Tests        tests/tools/rover85/flash_command_test.cpp
#pragma once

#include <CLI/CLI.hpp>

/// Adds `flash` to the command line.
/// @param exit_code  set when it has run: 0; 1 when what was read back differs; 2 for a backend
/// that
///                   does not exist yet; 3 for an image that cannot be used or a file that cannot
///                   be written (one line on standard error). Must outlive `app`.
void add_flash_command(CLI::App& app, int& exit_code);
