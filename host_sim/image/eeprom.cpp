// eeprom.cpp - see eeprom.hpp.
#include "host_sim/image/eeprom.hpp"

#include <algorithm>

namespace host_sim {

std::vector<uint8_t> eeprom_content(const Image& image, std::size_t size) {
    check_range(image, {0, static_cast<uint16_t>(size - 1)}, "the EEPROM");
    std::vector<uint8_t> content(size, kErasedByte);
    for (std::size_t at = 0; at < size; ++at) {
        if (image.present[at]) content[at] = image.bytes[at];
    }
    return content;
}

std::optional<Mismatch> compare_content(std::span<const uint8_t> expected,
                                        std::span<const uint8_t> found) {
    const auto at = [](std::span<const uint8_t> bytes, std::size_t i) -> std::optional<uint8_t> {
        if (i >= bytes.size()) return {};
        return bytes[i];
    };
    std::optional<Mismatch> mismatch;
    for (std::size_t i = 0; i < std::max(expected.size(), found.size()); ++i) {
        if (at(expected, i) == at(found, i)) continue;
        if (!mismatch) mismatch = Mismatch{i, at(expected, i), at(found, i), 0};
        ++mismatch->count;
    }
    return mismatch;
}

}  // namespace host_sim
