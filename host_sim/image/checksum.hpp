// checksum.hpp - the check sums of program images.
// Depends on   the standard library, zlib.
// Source       CRC-16: polynomial 1021H of ITU-T V.41, start FFFFH, most significant bit first, no
//              reflection. CRC-32: ISO/IEC 8802-3, as in zip and PNG. Written apart from the
//              firmware's own CRC-16, which the image checks itself with.
#pragma once

#include <cstdint>
#include <span>

namespace host_sim {

/// CRC-16/CCITT-FALSE. "123456789" gives 29B1H.
[[nodiscard]] uint16_t crc16_ccitt_false(std::span<const uint8_t> bytes);

/// CRC-32. "123456789" gives CBF43926H.
[[nodiscard]] uint32_t crc32(std::span<const uint8_t> bytes);

/// The lower 16 bits of the sum of all bytes: the "checksum" that EPROM programmers show.
[[nodiscard]] uint16_t byte_sum(std::span<const uint8_t> bytes);

}  // namespace host_sim
