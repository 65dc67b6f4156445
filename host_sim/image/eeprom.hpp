// eeprom.hpp - an image as the content of a whole memory part, and what a part holds instead.
// Depends on   host_sim/image/image.hpp.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "host_sim/image/image.hpp"

namespace host_sim {

/// Every byte of a part of `size` bytes at address 0: the image's, and FFH where it has none.
/// @param size  [1, 65536]
/// @errors  ImageError: the image does not fit
[[nodiscard]] std::vector<uint8_t> eeprom_content(const Image& image, std::size_t size);

/// How what was read differs from what was meant.
struct Mismatch {
    std::size_t first = 0;            ///< address
    std::optional<uint8_t> expected;  ///< there; nothing: behind the end
    std::optional<uint8_t> found;     ///< nothing: what was read ends before
    std::size_t count = 0;            ///< wrong bytes; missing and surplus ones count

    bool operator==(const Mismatch&) const = default;
};

/// @return  nothing when they are the same
[[nodiscard]] std::optional<Mismatch> compare_content(std::span<const uint8_t> expected,
                                                      std::span<const uint8_t> found);

}  // namespace host_sim
