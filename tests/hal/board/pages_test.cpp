// The pages for who builds a board against the constants that software uses.
#include <gtest/gtest.h>

#include <cstdint>
#include <fstream>
#include <iterator>
#include <regex>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "firmware/link/crc16.hpp"
#include "hal/board/rb85.hpp"

namespace {

std::string page(const std::string& name) {
    std::ifstream file(std::string(ROVER_SOURCE_DIR) + "/docs/" + name);
    std::stringstream text;
    text << file.rdbuf();
    EXPECT_FALSE(text.str().empty()) << name;
    return text.str();
}

/// Every part of `text` that matches, its groups.
std::vector<std::smatch> matches(const std::string& text, const std::regex& pattern) {
    return {std::sregex_iterator(text.begin(), text.end(), pattern), {}};
}

uint8_t hex(const std::string& digits) {
    return static_cast<uint8_t>(std::stoul(digits, nullptr, 16));
}

/// Ports whose bits a row's equation admits: "0010 0xx0".
std::pair<uint8_t, uint8_t> ports_of(std::string bits) {
    std::erase(bits, ' ');
    unsigned first = 0;
    unsigned last = 0;
    for (const char bit : bits) {
        first = first << 1 | (bit == '1' ? 1U : 0U);
        last = last << 1 | (bit == '0' ? 0U : 1U);
    }
    return {static_cast<uint8_t>(first), static_cast<uint8_t>(last)};
}

TEST(SchematicPage, DecodesThePortsOfTheBoard) {
    namespace rb85 = hal::rb85;
    struct Block {
        const char* select;
        uint8_t first;
        uint8_t last;
    };
    const std::vector<Block> blocks = {
        {"USART", rb85::kUsartData, rb85::kUsartControl},
        {"timer A", rb85::kTimerA, rb85::kTimerA + rb85::kTimerControl},
        {"timer B", rb85::kTimerB, rb85::kTimerB + rb85::kTimerControl},
        {"timer C", rb85::kTimerC, rb85::kTimerC + rb85::kTimerControl},
        {"82C55A A", rb85::kPpiA, rb85::kPpiA + rb85::kPpiControl},
        {"82C55A B", rb85::kPpiB, rb85::kPpiB + rb85::kPpiControl},
        {"AD574A", rb85::kAdc, rb85::kAdc + 1},
        {"presence", rb85::kPresence, rb85::kPresence},
        {"motor latches", rb85::kMotorDrive, rb85::kMotorSteerSign}};
    const std::string text = page("spec/schematic.md");
    const auto rows = matches(
        text, std::regex(R"(\| ([0-9A-F]{2})-([0-9A-F]{2}) \| ([^|]+) \| IO & a = ([01x ]{9}))"));
    ASSERT_EQ(rows.size(), blocks.size());
    for (std::size_t i = 0; i < rows.size(); ++i) {
        EXPECT_EQ(rows[i][3].str(), blocks[i].select);
        EXPECT_EQ(hex(rows[i][1]), blocks[i].first) << blocks[i].select;
        EXPECT_EQ(hex(rows[i][2]), blocks[i].last) << blocks[i].select;
        const auto [first, last] = ports_of(rows[i][4]);
        EXPECT_EQ(first, blocks[i].first) << blocks[i].select;
        // The motors' 74HC154 takes the last four of sixteen away.
        const bool motors = blocks[i].first == rb85::kMotorDrive;
        EXPECT_EQ(last, motors ? first + 15 : blocks[i].last) << blocks[i].select;
    }
}

TEST(BringUpPage, ItsFramesHaveTheRightCheck) {
    const std::string text = page("guides/bring-up.md");
    const auto frames = matches(text, std::regex(R"(printf '((?:\\x[0-9A-F]{2})+)')"));
    ASSERT_EQ(frames.size(), 2U);
    for (std::size_t i = 0; i < frames.size(); ++i) {
        const std::string digits = frames[i][1];
        std::vector<uint8_t> bytes;
        for (std::size_t at = 2; at < digits.size(); at += 4)
            bytes.push_back(hex(digits.substr(at, 2)));
        ASSERT_EQ(bytes.size(), 6U);
        EXPECT_EQ(bytes[0], 0xC5);
        EXPECT_EQ(bytes[1], 0x3A);
        EXPECT_EQ(bytes[2], i + 1);  // identity, status
        const uint16_t crc = rover::crc16_block(rover::kCrc16Start, &bytes[2], 2);
        EXPECT_EQ(bytes[4] | bytes[5] << 8, crc);
    }
}

}  // namespace
