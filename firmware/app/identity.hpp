// identity.hpp - the block in ROM that says which image this is.
// Depends on   firmware/core/arith.hpp.
// Filled in    by the image's build behind the linker: source hash, size and check are 0 when
//              compiled. Read it through volatile: the compiler has seen the zeros.
// Normative    docs/spec/memory-map.md
#pragma once

#include "firmware/core/arith.hpp"

namespace rover {

/// 28 bytes without padding; words are little endian.
struct Identity {
    uint8_t magic[8];  ///< "ROVER85" and a zero
    uint8_t format;    ///< 1
    uint8_t version_major;
    uint8_t version_minor;
    uint8_t version_patch;
    uint8_t source_hash[4];  ///< u32 of the sources, low byte first
    uint8_t image_size[2];   ///< u16: the last ROM address in use, plus 1
    uint8_t image_crc[2];    ///< CRC-16/CCITT-FALSE of bytes 0 to size - 1, these two taken as 0
    uint8_t vehicle[8];      ///< ASCII, zeros behind it
};
static_assert(sizeof(Identity) == 28);

inline constexpr uint8_t kIdentityFormat = 1;
/// Of the downlink frame: everything behind the magic.
inline constexpr uint8_t kIdentityPayloadSize = sizeof(Identity) - 8;

/// The block of this firmware before it is stamped.
inline constexpr Identity kIdentity = {
    {'R', 'O', 'V', 'E', 'R', '8', '5', 0},  kIdentityFormat, 0, 1, 0, {0, 0, 0, 0}, {0, 0}, {0, 0},
    {'R', 'o', 'c', 'k', 'y', '3', '.', '2'}};

}  // namespace rover
