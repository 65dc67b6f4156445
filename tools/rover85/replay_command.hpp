// replay_command.hpp - `rover85 replay` and `rover85 report`: from a recorded log to results.
#pragma once

#include <CLI/CLI.hpp>

void add_replay_command(CLI::App& app, int& exit_code);
void add_report_command(CLI::App& app, int& exit_code);
