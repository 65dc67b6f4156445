// image_beside.hpp - the image that belongs to this program: rover85.hex beside the executable.
// Depends on   host_sim/image; Linux, for the path of the running program.
#pragma once

#include <filesystem>
#include <string>

/// Folder of the running program.
[[nodiscard]] std::filesystem::path program_folder();

/// rover85.hex in `folder`, by default the program's own; it may not exist.
[[nodiscard]] std::filesystem::path image_beside(
    const std::filesystem::path& folder = program_folder());

/// What `rover85 --version` prints: the native controller, then the image beside the program if
/// there is one, each on a line. An image that cannot be used is named with its fault.
[[nodiscard]] std::string version_text(const std::filesystem::path& folder = program_folder());
