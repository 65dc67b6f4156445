// hex_write.cpp - Intel HEX out.
#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <span>

#include "host_sim/image/image.hpp"

namespace host_sim {
namespace {

constexpr std::size_t kRecordDataSize = 16;

void append_record(std::string& out, uint16_t address, unsigned type,
                   std::span<const uint8_t> data) {
    unsigned sum = static_cast<unsigned>(data.size()) + (address >> 8) + address + type;
    fmt::format_to(std::back_inserter(out), ":{:02X}{:04X}{:02X}", data.size(), address, type);
    for (const uint8_t byte : data) {
        fmt::format_to(std::back_inserter(out), "{:02X}", byte);
        sum += byte;
    }
    fmt::format_to(std::back_inserter(out), "{:02X}\n", -sum & 0xFFu);
}

}  // namespace

std::string write_hex(const Image& image) {
    std::string out;
    for (const AddressRange& segment : image.segments()) {
        const std::size_t end = std::size_t{segment.last} + 1;
        for (std::size_t at = segment.first; at < end; at += kRecordDataSize) {
            const std::size_t size = std::min(kRecordDataSize, end - at);
            append_record(out, static_cast<uint16_t>(at), 0x00,
                          std::span(image.bytes).subspan(at, size));
        }
    }
    if (image.start) {
        const uint8_t entry[] = {0, 0, static_cast<uint8_t>(*image.start >> 8),
                                 static_cast<uint8_t>(*image.start)};
        append_record(out, 0, 0x05, entry);
    }
    append_record(out, 0, 0x01, {});
    return out;
}

}  // namespace host_sim
