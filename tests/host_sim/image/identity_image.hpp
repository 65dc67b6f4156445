// identity_image.hpp - small images with an identity block, made by hand.
#pragma once

#include <string_view>

#include "host_sim/image/image.hpp"

namespace image_test {

inline constexpr uint16_t kFirst = 0x0C00;
inline constexpr uint16_t kBlock = 0x0C10;
inline constexpr uint16_t kLast = 0x0C40;

/// "ROVER85", 0, format 1, then zeros and the vehicle "Rocky3.2", as the firmware declares it.
inline void put_block(host_sim::Image& image, uint16_t at) {
    constexpr std::string_view kBytes{
        "ROVER85\0\1"  // magic, format
        "\0\0\0"       // version
        "\0\0\0\0"     // hash
        "\0\0\0\0"     // size, CRC
        "Rocky3.2",
        28};
    for (const char byte : kBytes) image.put(at++, static_cast<uint8_t>(byte));
}

/// 41H bytes from 0C00H on, all but the block 76H (HLT).
inline host_sim::Image unstamped() {
    host_sim::Image image;
    image.file = "a.hex";
    for (uint16_t at = kFirst; at <= kLast; ++at) image.put(at, 0x76);
    put_block(image, kBlock);
    return image;
}

}  // namespace image_test
