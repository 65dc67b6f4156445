// load.hpp - a program image and its symbols, from files into a session.
// Depends on   session.hpp, host_sim/image.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>

#include "host_sim/image/image.hpp"
#include "tools/debug/session.hpp"

namespace debug_console {

/// Reads an image: Intel HEX when it begins with a colon, otherwise BIN.
/// @param load_address  of a BIN, 0 when not given; @errors std::runtime_error when given for HEX
/// @errors host_sim::ImageError
[[nodiscard]] host_sim::Image read_image(const std::filesystem::path& file,
                                         std::optional<uint16_t> load_address);

/// Puts the bytes into EEPROM and RAM, as an outside programmer does.
/// @errors host_sim::ImageError naming the first byte for which there is no memory
void load_image(const host_sim::Image& image, host_sim::Board& board);

/// The symbols in `file`; when none is given those beside the image, with the ending .sym, if they
/// exist. @errors host_sim::ImageError
[[nodiscard]] host_sim::Symbols find_symbols(const std::filesystem::path& file,
                                             const std::filesystem::path& image_file);

}  // namespace debug_console
