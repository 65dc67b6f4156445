// load.cpp - see load.hpp.
#include "tools/debug/load.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <span>

#include "toolchain/isa/disassemble.hpp"
#include "tools/debug/debug_error.hpp"

namespace debug_console {

using host_sim::Image;
using toolchain::isa::intel_hex;

Image read_image(const std::filesystem::path& file, std::optional<uint16_t> load_address) {
    const std::string content = host_sim::read_image_file(file);
    if (!content.starts_with(':')) {
        return host_sim::read_bin(content, load_address.value_or(0), file.string());
    }
    if (load_address) {
        throw DebugError(file.string() +
                         ": is Intel HEX and says itself where it belongs; leave out --load");
    }
    return host_sim::read_hex(content, file.string());
}

void load_image(const Image& image, host_sim::Board& board) {
    const auto& map = board.state.map;
    for (const host_sim::AddressRange& segment : image.segments()) {
        for (unsigned address = segment.first; address <= segment.last; ++address) {
            const bool ram = address >= map.ram_first && address <= map.ram_last;
            if (ram || address <= map.eeprom_last) continue;
            throw host_sim::ImageError(
                image.file, image.lines.empty() ? 0 : image.lines[address],
                fmt::format("a byte at {}, where the board has no memory", intel_hex(address, 4)),
                "link it for EEPROM 0000H-7FFFH and the RAM that is fitted (--ram)");
        }
    }
    const std::span<const uint8_t> bytes(image.bytes);
    for (const auto& [first, last] : image.segments()) {
        const unsigned eeprom_end = std::min<unsigned>(last, map.eeprom_last) + 1U;
        if (first < eeprom_end) board.program(bytes.subspan(first, eeprom_end - first), first);
        for (unsigned address = std::max<unsigned>(first, map.ram_first); address <= last;
             ++address) {
            board.state.memory.bytes[address] = bytes[address];
        }
    }
}

host_sim::Symbols find_symbols(const std::filesystem::path& file,
                               const std::filesystem::path& image_file) {
    if (!file.empty()) return host_sim::load_symbols(file);
    std::filesystem::path beside = image_file;
    beside.replace_extension(".sym");
    return std::filesystem::exists(beside) ? host_sim::load_symbols(beside) : host_sim::Symbols();
}

}  // namespace debug_console
