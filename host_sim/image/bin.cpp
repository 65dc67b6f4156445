// bin.cpp - raw bytes in and out.
#include <fmt/format.h>

#include "host_sim/image/image.hpp"

namespace host_sim {

Image read_bin(std::string_view content, uint16_t load_address, std::string_view file) {
    if (content.empty()) throw ImageError(file, 0, "the file is empty", "give a program image");
    const std::size_t room = kAddressSpaceSize - load_address;
    if (content.size() > room) {
        throw ImageError(file, 0,
                         fmt::format("has {} bytes, but from {:04X}H on there are only {}",
                                     content.size(), load_address, room),
                         "give a lower load address or a smaller image");
    }
    Image image;
    image.file = file;
    for (std::size_t i = 0; i < content.size(); ++i) {
        image.put(static_cast<uint16_t>(load_address + i), static_cast<uint8_t>(content[i]));
    }
    return image;
}

std::string write_bin(const Image& image, AddressRange range, uint8_t fill) {
    std::string out;
    for (std::size_t address = range.first; address <= range.last; ++address) {
        out += static_cast<char>(image.present[address] ? image.bytes[address] : fill);
    }
    return out;
}

}  // namespace host_sim
