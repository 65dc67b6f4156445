// log_output.hpp - writes a log as its name says: .rlog or .csv.
// Depends on   host_sim/log/log_io.hpp.
// Tests        tests/tools/rover85/log_output_test.cpp
#pragma once

#include <filesystem>
#include <string>

#include "host_sim/log/log.hpp"

/// CLI11 validator for output names.
/// @return  empty for a name that ends in .rlog or .csv, else what is wrong
std::string check_log_name(const std::string& path);

/// Writes the log; the file appears whole or not at all.
/// @errors  host_sim::LogError: another extension, or the file cannot be written
void write_log(const std::filesystem::path& path, const host_sim::Log& log);

/// One line for people: steps, duration, channels present.
std::string describe_log(const host_sim::Log& log);
