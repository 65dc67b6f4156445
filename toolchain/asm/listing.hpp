// listing.hpp - a program as people read it: address, bytes, T-states, instruction, source line.
// Form         docs/spec/map.md.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "toolchain/asm/program.hpp"

namespace toolchain::assembly {

/// Text of a source line, or empty.
using SourceText = std::function<std::string(const std::string& file, uint32_t line)>;

/// Reads source files when they are asked for, and remembers them. A file that cannot be read has
/// no text.
[[nodiscard]] SourceText source_files();

/// @param source  gives the text of lines; may be empty
[[nodiscard]] std::string listing(const Program& program, const SourceText& source = {});

}  // namespace toolchain::assembly
