// recover_command.hpp - `rover85 recover`: salvages a torn .rlog.
#pragma once

#include <CLI/CLI.hpp>

void add_recover_command(CLI::App& app, int& exit_code);
