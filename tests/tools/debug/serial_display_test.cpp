// serial_display_test.cpp - characters from the board as lines.
#include "tools/debug/serial_display.hpp"

#include <gtest/gtest.h>

#include <string>

namespace debug_console {
namespace {

using Character = host_sim::chips::I8251a::TransmittedByte;

std::vector<Character> characters(const std::string& text, uint64_t start_t) {
    std::vector<Character> list;
    for (const char byte : text) {
        Character character;
        character.byte = static_cast<uint8_t>(byte);
        character.start_t = start_t;
        start_t += 1600;  // ten bits at 19,200 baud
        list.push_back(character);
    }
    return list;
}

TEST(SerialDisplay, ShowsWholeLinesAndTheRestWhenAsked) {
    std::string shown;
    SerialDisplay display([&shown](std::string_view text) { shown += text; });
    display.add(characters("OK\nab", 100));
    EXPECT_EQ(shown, "serial T 100: \"OK\\n\"\n");
    display.add(characters("c", 8100));
    EXPECT_EQ(shown, "serial T 100: \"OK\\n\"\n");
    display.flush();
    EXPECT_EQ(shown, "serial T 100: \"OK\\n\"\nserial T 4900: \"abc\"\n");
    const std::string before = shown;
    display.flush();
    EXPECT_EQ(shown, before) << "nothing twice";
}

TEST(SerialDisplay, HexadecimalRowsAre16Bytes) {
    std::string shown;
    SerialDisplay display([&shown](std::string_view text) { shown += text; });
    display.set_mode(SerialDisplay::Mode::hex);
    display.add(characters("0123456789ABCDEF\n", 0));
    display.flush();
    EXPECT_EQ(shown,
              "serial T 0: 30 31 32 33 34 35 36 37 38 39 41 42 43 44 45 46\n"
              "serial T 25600: 0A\n");
}

TEST(SerialDisplay, LongLinesAreCutAndOffIsSilent) {
    std::string shown;
    SerialDisplay display([&shown](std::string_view text) { shown += text; });
    display.add(characters(std::string(65, 'x'), 0));
    EXPECT_EQ(shown, "serial T 0: \"" + std::string(64, 'x') + "\"\n");
    display.flush();
    shown.clear();
    display.set_mode(SerialDisplay::Mode::off);
    display.add(characters("unseen\n", 0));
    display.flush();
    EXPECT_EQ(shown, "");
}

}  // namespace
}  // namespace debug_console
