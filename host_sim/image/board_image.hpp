// board_image.hpp - the whole content of the board's EEPROM: loader, application, boot record.
// Depends on   host_sim/image/identity.hpp, firmware/config/eeprom_layout.hpp.
// Normative    docs/spec/loader.md
#pragma once

#include <array>
#include <cstdint>

#include "firmware/config/eeprom_layout.hpp"
#include "host_sim/image/identity.hpp"

namespace host_sim {

/// The loader as it lies in the EEPROM.
/// @param start    its first part, linked for 0000H-01FFH
/// @param program  its second, linked for the RAM that it is copied to
/// @errors  ImageError: one of them has bytes elsewhere
[[nodiscard]] Image loader_image(const Image& start, const Image& program);

using BootRecordBytes = std::array<uint8_t, rover::loader::kBootRecordSize>;

/// The record that makes this image bootable.
[[nodiscard]] BootRecordBytes boot_record(const ImageIdentity& identity);

/// Adds loader and boot record to a stamped application.
/// @errors  ImageError: the application has bytes where they go
void complete_for_board(Image& application, const ImageIdentity& identity, const Image& loader);

/// @errors  ImageError: the image has a boot record, and it is not that of `identity`
void check_boot_record(const Image& image, const ImageIdentity& identity);

/// The part of it that goes over the link: from kApplicationFirst to the end of the application,
/// in whole pages, erased bytes behind it.
[[nodiscard]] std::vector<uint8_t> application_pages(const Image& image,
                                                     const ImageIdentity& identity);

}  // namespace host_sim
