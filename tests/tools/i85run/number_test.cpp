// number_test.cpp - numbers, ranges and places of the command line.
#include "tools/i85run/number.hpp"

#include <gtest/gtest.h>

namespace {

using i85run::parse_number;
using i85run::parse_place;
using i85run::parse_range;

TEST(I85runNumber, HexadecimalAndDecimal) {
    EXPECT_EQ(parse_number("0x8000", 0xFFFF), 0x8000u);
    EXPECT_EQ(parse_number("0XfF", 0xFFFF), 0xFFu);
    EXPECT_EQ(parse_number("8000h", 0xFFFF), 0x8000u);
    EXPECT_EQ(parse_number("0FFH", 0xFFFF), 0xFFu);
    EXPECT_EQ(parse_number("8000", 0xFFFF), 8000u);
    EXPECT_EQ(parse_number("0", 0xFFFF), 0u);
}

TEST(I85runNumber, TheGreatestIsAllowedAndNoMore) {
    EXPECT_EQ(parse_number("0xFFFF", 0xFFFF), 0xFFFFu);
    EXPECT_EQ(parse_number("65535", 0xFFFF), 0xFFFFu);
    EXPECT_FALSE(parse_number("0x10000", 0xFFFF));
    EXPECT_FALSE(parse_number("65536", 0xFFFF));
    EXPECT_FALSE(parse_number("4294967296", 0xFFFF)) << "2^32 is not 0";
}

TEST(I85runNumber, EverythingElseIsRefused) {
    for (const char* text : {"", "h", "0x", "FFh", "ffff", "-1", "+1", "0x-1", " 1", "1 ", "12g",
                             "1.5", "0x12h", "main"}) {
        EXPECT_FALSE(parse_number(text, 0xFFFF)) << "'" << text << "'";
    }
}

TEST(I85runNumber, TStatesAreDecimalUpTo64Bits) {
    EXPECT_EQ(i85run::parse_t_states("0"), 0u);
    EXPECT_EQ(i85run::parse_t_states("18446744073709551615"), ~uint64_t{0});
    for (const char* text : {"", "18446744073709551616", "-1", "0x10", "1e6", "5 "}) {
        EXPECT_FALSE(i85run::parse_t_states(text)) << "'" << text << "'";
    }
}

TEST(I85runNumber, RangesAreInclusiveAndInOrder) {
    const auto range = parse_range("0:0x7FFF");
    ASSERT_TRUE(range);
    EXPECT_EQ(range->first, 0);
    EXPECT_EQ(range->last, 0x7FFF);
    EXPECT_TRUE(parse_range("5:5"));
    for (const char* text : {"", "5", "5:", ":5", "6:5", "0:0x10000", "1:2:3"}) {
        EXPECT_FALSE(parse_range(text)) << "'" << text << "'";
    }
}

TEST(I85runNumber, APlaceMayHaveALength) {
    const auto bare = parse_place("result");
    ASSERT_TRUE(bare);
    EXPECT_EQ(bare->place, "result");
    EXPECT_FALSE(bare->length);
    const auto sized = parse_place("0x8000:16");
    ASSERT_TRUE(sized);
    EXPECT_EQ(sized->place, "0x8000");
    EXPECT_EQ(sized->length, 16u);
    EXPECT_EQ(parse_place("0:65536")->length, 0x10000u);
    EXPECT_EQ(parse_place("rover::state:2")->place, "rover::state");
    for (const char* text : {"a:0", "a:65537", "a:", "a:b"}) {
        EXPECT_FALSE(parse_place(text)) << "'" << text << "'";
    }
}

}  // namespace
