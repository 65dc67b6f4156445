// eeprom_test.cpp - an image as the content of a part, and the first wrong byte.
#include "host_sim/image/eeprom.hpp"

#include <gtest/gtest.h>

namespace {

using host_sim::compare_content;
using host_sim::Image;
using host_sim::Mismatch;

TEST(EepromContent, WhatTheImageDoesNotHaveIsErased) {
    Image image;
    image.put(0, 0xC3);
    image.put(5, 0x00);
    EXPECT_EQ(host_sim::eeprom_content(image, 8),
              (std::vector<uint8_t>{0xC3, 0xFF, 0xFF, 0xFF, 0xFF, 0x00, 0xFF, 0xFF}));
}

TEST(EepromContent, TheLastByteFitsAndTheNextDoesNot) {
    Image image;
    image.put(0x1FFF, 0x12);
    EXPECT_EQ(host_sim::eeprom_content(image, 0x2000).back(), 0x12);
    EXPECT_THROW((void)host_sim::eeprom_content(image, 0x1FFF), host_sim::ImageError);
    image.put(0xFFFF, 0x34);
    EXPECT_EQ(host_sim::eeprom_content(image, 0x10000).back(), 0x34);
}

TEST(CompareContent, TheSameIsNothing) {
    const std::vector<uint8_t> bytes = {1, 2, 3};
    EXPECT_EQ(compare_content(bytes, bytes), std::nullopt);
    EXPECT_EQ(compare_content({}, {}), std::nullopt);
}

TEST(CompareContent, FirstWrongAddressAndCount) {
    const std::vector<uint8_t> expected = {1, 2, 3, 4, 5};
    const std::vector<uint8_t> found = {1, 2, 9, 4, 8};
    EXPECT_EQ(compare_content(expected, found), (Mismatch{2, 3, 9, 2}));
}

TEST(CompareContent, MissingAndSurplusBytesCount) {
    const std::vector<uint8_t> three = {1, 2, 3};
    const std::vector<uint8_t> five = {1, 2, 3, 4, 5};
    EXPECT_EQ(compare_content(five, three), (Mismatch{3, 4, std::nullopt, 2}));
    EXPECT_EQ(compare_content(three, five), (Mismatch{3, std::nullopt, 4, 2}));
}

}  // namespace
