// debug_command.hpp - `rover85 debug`: the console of the simulated board.
#pragma once

#include <CLI/CLI.hpp>

void add_debug_command(CLI::App& app, int& exit_code);
