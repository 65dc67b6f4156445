// main_job_command.hpp - `rover85 main-job`: what ./tools/run does: drives measured ground when the
// data sets are beside the project, a built-in synthetic course when they are not.
#pragma once

#include <CLI/CLI.hpp>

void add_main_job_command(CLI::App& app, int& exit_code);
