// compare_command.hpp - `rover85 compare`: both targets on the same log, every output of every
// step.
#pragma once

#include <CLI/CLI.hpp>

void add_compare_command(CLI::App& app, int& exit_code);
