// outputs.hpp - a program's files: all of them, or none.
// Depends on   toolchain/asm.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "toolchain/asm/program.hpp"

namespace toolchain::driver {

struct OutputFile {
    std::filesystem::path path{};
    std::string contents{};
};

/// OUT.hex, .bin, .map, .lst, .sym of a program.
[[nodiscard]] std::vector<OutputFile> output_files(const assembly::Program& program,
                                                   const std::filesystem::path& hex);

/// Writes all under other names beside their places, then renames them. What is there already stays
/// as it is if one cannot be written.
/// @errors  Failed
void write_all(const std::vector<OutputFile>& files);

}  // namespace toolchain::driver
