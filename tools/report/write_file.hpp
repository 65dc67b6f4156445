// write_file.hpp - writes a file as a whole or not at all.
#pragma once

#include <filesystem>
#include <string_view>

namespace report {

/// Writes `text` beside `file` and renames it into place: a reader never meets half a file.
/// @errors  std::runtime_error naming the file, the reason and what to do; `file` is untouched
void write_file(const std::filesystem::path& file, std::string_view text);

}  // namespace report
