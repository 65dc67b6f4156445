// crc16_small_test.cpp - the CRC without a table is the polynomial's.
#include "firmware/loader/crc16_small.hpp"

#include <gtest/gtest.h>

#include <string_view>

namespace {

/// CRC-16/CCITT-FALSE bit by bit: x^16 + x^12 + x^5 + 1.
uint16_t by_the_polynomial(uint16_t crc, uint8_t byte) {
    unsigned rest = crc ^ unsigned { byte } << 8;
    for (int bit = 0; bit < 8; ++bit) rest = (rest & 0x8000) != 0 ? rest << 1 ^ 0x1021 : rest << 1;
    return static_cast<uint16_t>(rest);
}

TEST(Crc16Small, EveryArgument) {
    for (unsigned crc = 0; crc < 0x10000; ++crc) {
        for (unsigned byte = 0; byte < 256; byte += crc % 7 + 1) {
            const auto from = static_cast<uint16_t>(crc);
            const auto next = static_cast<uint8_t>(byte);
            ASSERT_EQ(rover::loader::crc16_add_small(from, next), by_the_polynomial(from, next))
                << crc << ' ' << byte;
        }
    }
    for (unsigned byte = 0; byte < 256; ++byte) {  // only the high byte of crc meets the new one
        const auto next = static_cast<uint8_t>(byte);
        ASSERT_EQ(rover::loader::crc16_add_small(0, next), by_the_polynomial(0, next));
    }
}

TEST(Crc16Small, CheckValue) {
    uint16_t crc = 0xFFFF;
    for (const char letter : std::string_view("123456789")) {
        crc = rover::loader::crc16_add_small(crc, static_cast<uint8_t>(letter));
    }
    EXPECT_EQ(crc, 0x29B1);
}

}  // namespace
