// hex_read.cpp - Intel HEX in, one record a line.
#include <fmt/format.h>

#include <algorithm>
#include <span>

#include "host_sim/image/image.hpp"

namespace host_sim {
namespace {

constexpr std::string_view kDamaged = "the file is damaged: make or copy it again";
constexpr std::string_view kTooBig = "link the program for the 64 KB of the 8085";
constexpr std::string_view kTwice = "link the program so that nothing overlaps";

/// Bytes of a record that are not data: count, address (2), type, checksum.
constexpr std::size_t kOverhead = 5;

int digit_value(char digit) {
    if (digit >= '0' && digit <= '9') return digit - '0';
    if (digit >= 'A' && digit <= 'F') return digit - 'A' + 10;
    if (digit >= 'a' && digit <= 'f') return digit - 'a' + 10;
    return -1;
}

class HexReader {
public:
    HexReader(std::string_view text, std::string_view file) : text_(text) {
        image_.file = file;
        image_.lines.assign(kAddressSpaceSize, 0);
    }

    Image run() {
        while (!text_.empty()) {
            ++line_;
            const std::size_t end = std::min(text_.find('\n'), text_.size());
            std::string_view line = text_.substr(0, end);
            text_.remove_prefix(std::min(end + 1, text_.size()));
            if (line.ends_with('\r')) line.remove_suffix(1);
            if (!line.empty()) record(line);
        }
        if (end_line_ == 0) {
            throw ImageError(image_.file, line_, "the file ends without an end record (type 01)",
                             kDamaged);
        }
        if (image_.present.none()) {
            throw ImageError(image_.file, 0, "the image has no bytes", "check how it was made");
        }
        return std::move(image_);
    }

private:
    [[noreturn]] void fail(std::string_view what, std::string_view advice = kDamaged) const {
        throw ImageError(image_.file, line_, what, advice);
    }

    /// Text of one line to `bytes_`, with everything checked that all types share.
    void decode(std::string_view line) {
        if (line.front() != ':') fail("does not start with ':'", "give an Intel HEX file");
        line.remove_prefix(1);
        for (std::size_t i = 0; i < line.size(); ++i) {
            if (digit_value(line[i]) >= 0) continue;
            fail(fmt::format("column {} is no hexadecimal digit", i + 2));
        }
        if (line.size() % 2 != 0) fail(fmt::format("has an odd number of digits, {}", line.size()));
        bytes_.clear();
        for (std::size_t i = 0; i < line.size(); i += 2) {
            bytes_.push_back(
                static_cast<uint8_t>(digit_value(line[i]) << 4 | digit_value(line[i + 1])));
        }
        if (bytes_.size() < kOverhead) fail("is too short to be a record");
        if (bytes_.size() != kOverhead + bytes_[0]) {
            fail(fmt::format("says {} data bytes, but has {}", bytes_[0],
                             bytes_.size() - kOverhead));
        }
        unsigned sum = 0;
        for (const uint8_t byte : bytes_) sum += byte;
        if ((sum & 0xFFu) != 0) {
            fail(fmt::format("checksum is {:02X}, but the bytes give {:02X}", bytes_.back(),
                             (bytes_.back() - sum) & 0xFFu));
        }
    }

    void record(std::string_view line) {
        if (end_line_ != 0) {
            fail(fmt::format("comes after the end record of line {}", end_line_),
                 "give one image per file");
        }
        decode(line);
        const std::span<const uint8_t> data(bytes_.data() + 4, bytes_[0]);
        const auto address = static_cast<uint16_t>(bytes_[1] << 8 | bytes_[2]);
        switch (bytes_[3]) {
            case 0x00:
                put(address, data);
                break;
            case 0x01:
                need_size(data, 0);
                // Assemblers of the 8-bit format say here where the program starts.
                if (address != 0) start(address);
                end_line_ = line_;
                break;
            case 0x02:
            case 0x04:
                need_size(data, 2);
                if (data[0] != 0 || data[1] != 0) {
                    fail("sets a base above the first 64 KB", kTooBig);
                }
                break;
            case 0x03:
            case 0x05:
                need_size(data, 4);
                if (data[0] != 0 || data[1] != 0) fail("starts the program above FFFFH", kTooBig);
                start(static_cast<uint16_t>(data[2] << 8 | data[3]));
                break;
            default:
                fail(fmt::format("record type {:02X} is unknown", bytes_[3]),
                     "give an Intel HEX file");
        }
    }

    void need_size(std::span<const uint8_t> data, std::size_t size) const {
        if (data.size() == size) return;
        fail(fmt::format("record type {:02X} has {} data bytes instead of {}", bytes_[3],
                         data.size(), size));
    }

    void put(uint16_t first, std::span<const uint8_t> data) {
        if (first + data.size() > kAddressSpaceSize) {
            fail(fmt::format("{} bytes from {:04X}H on go beyond FFFFH", data.size(), first),
                 kTooBig);
        }
        for (std::size_t i = 0; i < data.size(); ++i) {
            const auto address = static_cast<uint16_t>(first + i);
            if (image_.present[address]) {
                fail(fmt::format("address {:04X}H is given again, first at line {}", address,
                                 image_.lines[address]),
                     kTwice);
            }
            image_.put(address, data[i]);
            image_.lines[address] = static_cast<uint32_t>(line_);
        }
    }

    void start(uint16_t address) {
        if (image_.start && *image_.start != address) {
            fail(fmt::format("starts at {:04X}H, but line {} at {:04X}H", address, start_line_,
                             *image_.start),
                 "keep one of them");
        }
        image_.start = address;
        start_line_ = line_;
    }

    std::string_view text_;
    Image image_;
    std::vector<uint8_t> bytes_;  ///< of the current record
    std::size_t line_ = 0;
    std::size_t end_line_ = 0;
    std::size_t start_line_ = 0;
};

}  // namespace

Image read_hex(std::string_view text, std::string_view file) {
    return HexReader(text, file).run();
}

}  // namespace host_sim
