// checksum.cpp - see checksum.hpp.
#include "host_sim/image/checksum.hpp"

#include <zlib.h>

namespace host_sim {

uint16_t crc16_ccitt_false(std::span<const uint8_t> bytes) {
    uint32_t crc = 0xFFFF;
    for (const uint8_t byte : bytes) {
        crc ^= static_cast<uint32_t>(byte) << 8;
        for (int bit = 0; bit < 8; ++bit) {
            const bool carry = (crc & 0x8000u) != 0;
            crc = (crc << 1) & 0xFFFFu;
            if (carry) crc ^= 0x1021u;
        }
    }
    return static_cast<uint16_t>(crc);
}

uint32_t crc32(std::span<const uint8_t> bytes) {
    return static_cast<uint32_t>(::crc32_z(::crc32_z(0, nullptr, 0), bytes.data(), bytes.size()));
}

uint16_t byte_sum(std::span<const uint8_t> bytes) {
    uint32_t sum = 0;
    for (const uint8_t byte : bytes) sum += byte;
    return static_cast<uint16_t>(sum);
}

}  // namespace host_sim
