// simulate_command.hpp - `rover85 simulate`: one traverse in the simulated world.
#pragma once

#include <CLI/CLI.hpp>

void add_simulate_command(CLI::App& app, int& exit_code);
