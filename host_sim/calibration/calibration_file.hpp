// calibration_file.hpp - the calibration record as a TOML file.
// Depends on   hal/calibration.hpp, host_sim/log/log_io.hpp (LogError).
// Format       docs/spec/calibration.md (normative).
// Tests        tests/host_sim/calibration/calibration_file_test.cpp
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "hal/calibration.hpp"

namespace host_sim {

/// Names of the angle channels in files and options, by hal::AngleChannel.
std::string_view angle_channel_name(hal::AngleChannel channel);

/// The text of a record. One record and one list of comments have exactly one text.
/// @param comments  lines for the top of the file, written after "# "; no line breaks in them
/// @errors  LogError when parse_calibration would refuse the record
std::string encode_calibration(const hal::Calibration& record,
                               const std::vector<std::string>& comments = {});

/// Reads a record. Every key is required, every other key refused.
/// @param name  file name, for messages
/// @errors  LogError with the line: not TOML, another format or version, a key missing, unknown, of
///          the wrong type or out of range, or wheel radius, counts per turn and rim travel per
///          count that contradict one another by more than 1 %
hal::Calibration parse_calibration(std::string_view text, std::string_view name);

/// Reads a file. @errors as parse_calibration, and when the file cannot be read
hal::Calibration load_calibration(const std::filesystem::path& path);

/// Writes a file: whole or not at all (beside it first, then renamed).
/// @errors  as encode_calibration, and when the file cannot be written
void save_calibration(const std::filesystem::path& path, const hal::Calibration& record,
                      const std::vector<std::string>& comments = {});

}  // namespace host_sim
