// rom_check_test.cpp - the check of an image, with its own two bytes taken as zero.
#include "firmware/boot/rom_check.hpp"

#include <gtest/gtest.h>

#include <random>
#include <vector>

namespace {

/// CRC-16/CCITT-FALSE, bit by bit from its polynomial.
std::uint16_t check_of(const std::vector<std::uint8_t>& bytes) {
    unsigned crc = 0xFFFF;
    for (const std::uint8_t byte : bytes) {
        for (int bit = 7; bit >= 0; --bit) {
            const bool one = ((crc >> 15) ^ (byte >> bit & 1U)) != 0;
            crc = (crc << 1 & 0xFFFFU) ^ (one ? 0x1021U : 0U);
        }
    }
    return static_cast<std::uint16_t>(crc);
}

std::vector<std::uint8_t> image_of(std::size_t size, std::size_t check_at) {
    std::mt19937 random(static_cast<unsigned>(size));
    std::vector<std::uint8_t> image(size);
    for (std::uint8_t& byte : image) byte = static_cast<std::uint8_t>(random());
    image[check_at] = image[check_at + 1] = 0;
    const std::uint16_t check = check_of(image);
    image[check_at] = static_cast<std::uint8_t>(check & 0xFF);
    image[check_at + 1] = static_cast<std::uint8_t>(check >> 8);
    return image;
}

bool intact(const std::vector<std::uint8_t>& image, std::size_t check_at, int* calls = nullptr) {
    return rover::rom_is_intact(image.data(), static_cast<std::uint16_t>(image.size()),
                                static_cast<std::uint16_t>(check_at), [&] {
                                    if (calls != nullptr) ++*calls;
                                });
}

TEST(RomCheck, AcceptsAnImageOfAnySizeWithItsCheckAnywhere) {
    for (const std::size_t size : {2U, 3U, 255U, 256U, 257U, 258U, 12288U, 32768U}) {
        for (const std::size_t at : {std::size_t{0}, size / 2, size - 2}) {
            if (at + 2 > size) continue;
            EXPECT_TRUE(intact(image_of(size, at), at)) << size << " at " << at;
        }
    }
}

TEST(RomCheck, NoticesEveryWrongBit) {
    auto image = image_of(600, 300);
    for (std::size_t bit = 0; bit < 600 * 8; ++bit) {
        image[bit / 8] = static_cast<std::uint8_t>(image[bit / 8] ^ 1U << bit % 8);
        EXPECT_FALSE(intact(image, 300)) << "bit " << bit;
        image[bit / 8] = static_cast<std::uint8_t>(image[bit / 8] ^ 1U << bit % 8);
    }
}

TEST(RomCheck, AnImageThatWasNeverStampedFails) {
    std::vector<std::uint8_t> image(100, 1);
    EXPECT_FALSE(rover::rom_is_intact(image.data(), 0, 50, [] {}));
    EXPECT_FALSE(rover::rom_is_intact(image.data(), 51, 50, [] {}));
}

TEST(RomCheck, SaysThatItIsAliveOften) {
    int calls = 0;
    EXPECT_TRUE(intact(image_of(12288, 6000), 6000, &calls));
    EXPECT_EQ(calls, 6000 / 256 + (12288 - 6002) / 256);  // in front of each whole block
}

}  // namespace
