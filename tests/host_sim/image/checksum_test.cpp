// checksum_test.cpp - the published check values.
#include "host_sim/image/checksum.hpp"

#include <gtest/gtest.h>

#include <string_view>
#include <vector>

namespace {

std::vector<uint8_t> bytes_of(std::string_view text) {
    return {text.begin(), text.end()};
}

// Check values of "123456789" as the catalogues of CRCs give them (CRC-16/IBM-3740, alias
// CCITT-FALSE; CRC-32/ISO-HDLC).
TEST(Checksum, CheckValues) {
    EXPECT_EQ(host_sim::crc16_ccitt_false(bytes_of("123456789")), 0x29B1);
    EXPECT_EQ(host_sim::crc32(bytes_of("123456789")), 0xCBF43926u);
    EXPECT_EQ(host_sim::byte_sum(bytes_of("123456789")), 9 * 0x35);
}

TEST(Checksum, OfNothing) {
    EXPECT_EQ(host_sim::crc16_ccitt_false({}), 0xFFFF);
    EXPECT_EQ(host_sim::crc32({}), 0u);
    EXPECT_EQ(host_sim::byte_sum({}), 0);
}

// By hand: 32,768 x FFH = 7F8000H, of which 8000H remain.
TEST(Checksum, TheSumOfAnErasedPartWraps) {
    EXPECT_EQ(host_sim::byte_sum(std::vector<uint8_t>(32768, 0xFF)), 0x8000);
}

TEST(Checksum, EveryFlippedBitIsSeen) {
    std::vector<uint8_t> bytes = bytes_of("rover85 rover85");
    const uint16_t crc16 = host_sim::crc16_ccitt_false(bytes);
    const uint32_t crc32 = host_sim::crc32(bytes);
    for (std::size_t bit = 0; bit < bytes.size() * 8; ++bit) {
        bytes[bit / 8] ^= static_cast<uint8_t>(1u << (bit % 8));
        EXPECT_NE(host_sim::crc16_ccitt_false(bytes), crc16) << bit;
        EXPECT_NE(host_sim::crc32(bytes), crc32) << bit;
        bytes[bit / 8] ^= static_cast<uint8_t>(1u << (bit % 8));
    }
}

}  // namespace
