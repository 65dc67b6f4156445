// crc16_test.cpp - the check against its catalogue value and a bit-by-bit shift register.
#include "firmware/link/crc16.hpp"

#include <gtest/gtest.h>

#include <string_view>

namespace {

std::uint16_t crc_of(std::string_view text) {
    std::uint16_t crc = rover::kCrc16Start;
    for (const char c : text) crc = rover::crc16_add(crc, static_cast<std::uint8_t>(c));
    return crc;
}

TEST(Crc16, CheckValue) {
    EXPECT_EQ(crc_of("123456789"), 0x29B1);
    EXPECT_EQ(crc_of(""), 0xFFFF);
}

TEST(Crc16, IsTheShiftRegisterOfThePolynomialForEveryStateAndForEveryByte) {
    for (std::uint32_t state = 0; state < 65536; state += 1) {
        const auto byte = static_cast<std::uint8_t>(state * 167u >> 3);
        std::uint32_t expected = state ^ (std::uint32_t{byte} << 8);
        for (int bit = 0; bit < 8; ++bit) {
            expected = (expected & 0x8000u) != 0 ? (expected << 1) ^ 0x1021u : expected << 1;
        }
        ASSERT_EQ(rover::crc16_add(static_cast<std::uint16_t>(state), byte), expected & 0xFFFFu)
            << state;
    }
    for (std::uint32_t byte = 0; byte < 256; ++byte) {
        std::uint32_t expected = 0x1D0Fu ^ (byte << 8);
        for (int bit = 0; bit < 8; ++bit) {
            expected = (expected & 0x8000u) != 0 ? (expected << 1) ^ 0x1021u : expected << 1;
        }
        ASSERT_EQ(rover::crc16_add(0x1D0F, static_cast<std::uint8_t>(byte)), expected & 0xFFFFu);
    }
}

TEST(Crc16, ABlockIsItsBytes) {
    std::uint8_t bytes[256];
    std::uint16_t expected = 0x1234;
    for (unsigned count = 1; count <= 256; ++count) {
        bytes[count - 1] = static_cast<std::uint8_t>(count * 73u >> 1);
        expected = rover::crc16_add(expected, bytes[count - 1]);
        EXPECT_EQ(rover::crc16_block(0x1234, bytes, static_cast<std::uint8_t>(count)), expected);
    }
}

// What is computed at compile time takes another way to the table.
TEST(Crc16, IsTheSameAtCompileTime) {
    constexpr std::uint16_t kOfA = rover::crc16_add(rover::kCrc16Start, 'A');
    EXPECT_EQ(kOfA, crc_of("A"));
    EXPECT_EQ(kOfA, 0xB915);
}

}  // namespace
