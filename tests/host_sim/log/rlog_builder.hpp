// rlog_builder.hpp - builds .rlog bytes by hand from docs/spec/log-format.md, right or wrong ones,
// with an own bitwise CRC-32. Nothing here comes from the code under test.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace log_test {

/// CRC-32 (IEEE 802.3) bit by bit: polynomial 04C11DB7 reflected, start and final XOR all ones.
class BitwiseCrc {
public:
    void add(std::string_view bytes) {
        for (const char byte : bytes) {
            remainder_ ^= static_cast<unsigned char>(byte);
            for (int bit = 0; bit < 8; ++bit) {
                remainder_ =
                    (remainder_ & 1u) != 0 ? remainder_ >> 1 ^ 0xEDB88320u : remainder_ >> 1;
            }
        }
    }
    [[nodiscard]] std::uint32_t value() const { return ~remainder_; }

private:
    std::uint32_t remainder_ = 0xFFFFFFFFu;
};

inline std::string little(std::uint64_t value, int bytes) {
    std::string out;
    for (; bytes > 0; --bytes, value >>= 8) out += static_cast<char>(value & 0xFFu);
    return out;
}

/// Bytes from hexadecimal digits; spaces and line feeds do not count.
inline std::string from_hex(std::string_view digits) {
    std::string out;
    int high = -1;
    for (const char digit : digits) {
        if (digit == ' ' || digit == '\n') continue;
        const int value = digit <= '9' ? digit - '0' : (digit | 0x20) - 'a' + 10;
        if (high < 0) {
            high = value;
        } else {
            out += static_cast<char>(high * 16 + value);
            high = -1;
        }
    }
    return out;
}

/// Builds a file record by record, with the running checksum of the specification.
class RlogBuilder {
public:
    explicit RlogBuilder(std::uint16_t major = 1, std::uint16_t minor = 0) {
        add_covered("\x89RLOG\r\n\x1A" + little(major, 2) + little(minor, 2));
        bytes += little(crc_.value(), 4);
    }
    RlogBuilder& record(std::uint8_t type, std::string_view payload) {
        offsets.push_back(bytes.size());
        add_covered(little(payload.size(), 4) + little(offsets.size() - 1, 4) + little(type, 1) +
                    std::string(payload));
        bytes += little(crc_.value(), 4);
        return *this;
    }

    std::string bytes;
    std::vector<std::size_t> offsets;  ///< start of every record

private:
    void add_covered(const std::string& covered) {
        bytes += covered;
        crc_.add(covered);
    }
    BitwiseCrc crc_;
};

/// Head payload: vehicle "v", nominal calibration, no image, no notes.
inline std::string plain_head() {
    std::string out = little(1, 4) + "v" + little(1, 2);
    for (const unsigned gain : {16384u, 16384u, 16384u, 27307u, 27307u}) {
        out += little(32760, 2) + little(gain, 2) + little(0, 1);
    }
    return out + little(1040, 2) + little(2000, 2) + little(13383, 2) + little(0, 2) +
           little(0, 4) + little(0, 4);
}

/// Offsets in plain_step(), from the specification's table.
inline constexpr std::size_t kSectionsAt = 4, kAdcAt = 7, kTachPresentAt = 35, kTachAt = 36,
                             kScanAt = 48, kRangePresentAt = 49, kRangeAt = 50, kReceivedAt = 67,
                             kPlainStepSize = 68;

/// Step payload with inputs only, every sensor absent.
inline std::string plain_step(std::uint32_t time_ms) {
    std::string out = little(time_ms, 4) + little(0, 1) + little(time_ms / 10, 2);
    for (int i = 0; i < 14; ++i) out += little(0xFFFF, 2);
    out += little(0, 1 + 6 * 2);         // tachometers: presence, counts
    out += little(0, 1) + little(0, 1);  // scan count, range presence
    for (int i = 0; i < 8; ++i) out += little(0, 2);
    return out + little(0, 1) + little(0, 1);  // detector bits, received bytes
}

}  // namespace log_test
