// image_files.cpp - see image_files.hpp.
#include "toolchain/asm/image_files.hpp"

#include <fmt/format.h>

#include <array>
#include <cstdint>
#include <iterator>
#include <span>

namespace toolchain::assembly {
namespace {

constexpr std::size_t kRecordSize = 16;

void add_record(std::string& out, std::size_t address, unsigned type,
                std::span<const uint8_t> data) {
    fmt::format_to(std::back_inserter(out), ":{:02X}{:04X}{:02X}", data.size(), address, type);
    std::size_t sum = data.size() + (address >> 8) + address + type;
    for (const uint8_t byte : data) {
        fmt::format_to(std::back_inserter(out), "{:02X}", byte);
        sum += byte;
    }
    fmt::format_to(std::back_inserter(out), "{:02X}\n", (0x100 - (sum & 0xFF)) & 0xFF);
}

}  // namespace

std::string write_hex(const Program& program) {
    const Image& image = program.image;
    std::string out;
    for (std::size_t at = 0; at < kMemorySize;) {
        std::size_t end = at;
        while (end < kMemorySize && end - at < kRecordSize && image.present[end]) ++end;
        if (end == at) {
            ++at;
            continue;
        }
        add_record(out, at, 0, std::span(image.bytes).subspan(at, end - at));
        at = end;
    }
    if (program.start) {
        const std::array<uint8_t, 4> start = {0, 0, static_cast<uint8_t>(*program.start >> 8),
                                              static_cast<uint8_t>(*program.start & 0xFF)};
        add_record(out, 0, 5, start);
    }
    add_record(out, 0, 1, {});
    return out;
}

std::string write_bin(const Program& program) {
    std::string out;
    std::size_t used = 0;
    for (std::size_t at = program.rom.first; at <= program.rom.last; ++at) {
        const bool present = program.image.present[at];
        out += static_cast<char>(present ? program.image.bytes[at] : 0xFF);
        if (present) used = out.size();
    }
    out.resize(used);
    return out;
}

}  // namespace toolchain::assembly
