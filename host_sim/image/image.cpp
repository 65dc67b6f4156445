// image.cpp - occupied ranges, the range check, and the message of an ImageError.
#include "host_sim/image/image.hpp"

#include <fmt/format.h>

namespace host_sim {
namespace {

std::string message(std::string_view file, std::size_t line, std::string_view what,
                    std::string_view advice) {
    return line == 0 ? fmt::format("{}: {}; {}", file, what, advice)
                     : fmt::format("{}:{}: {}; {}", file, line, what, advice);
}

}  // namespace

ImageError::ImageError(std::string_view file, std::size_t line, std::string_view what,
                       std::string_view advice)
    : std::runtime_error(message(file, line, what, advice)), line_(line) {}

std::vector<AddressRange> Image::segments() const {
    std::vector<AddressRange> found;
    for (std::size_t address = 0; address < kAddressSpaceSize; ++address) {
        if (!present[address]) continue;
        if (address == 0 || !present[address - 1]) {
            found.push_back({static_cast<uint16_t>(address), 0});
        }
        found.back().last = static_cast<uint16_t>(address);
    }
    return found;
}

std::optional<AddressRange> Image::extent() const {
    const auto all = segments();
    if (all.empty()) return {};
    return AddressRange{all.front().first, all.back().last};
}

void check_range(const Image& image, AddressRange range, std::string_view what) {
    for (std::size_t address = 0; address < kAddressSpaceSize; ++address) {
        if (!image.present[address] || (address >= range.first && address <= range.last)) continue;
        const std::size_t line = image.lines.empty() ? 0 : image.lines[address];
        throw ImageError(image.file, line,
                         fmt::format("address {:04X}H is outside of {} {:04X}H-{:04X}H", address,
                                     what, range.first, range.last),
                         "link the program for this memory");
    }
}

}  // namespace host_sim
