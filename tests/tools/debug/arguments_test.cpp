// arguments_test.cpp - numbers, times and words as people type them.
#include "tools/debug/arguments.hpp"

#include <gtest/gtest.h>

#include "tools/debug/debug_error.hpp"

namespace debug_console {
namespace {

TEST(ParseNumber, TakesIntelAndCStyle) {
    EXPECT_EQ(parse_number("0A3H"), 0xA3);
    EXPECT_EQ(parse_number("0a3h"), 0xA3);
    EXPECT_EQ(parse_number("0x00A3"), 0xA3);
    EXPECT_EQ(parse_number("163"), 163);
    EXPECT_EQ(parse_number("1010B"), 10);
    EXPECT_EQ(parse_number("0B1H"), 0xB1);
    EXPECT_EQ(parse_number("'A'"), 65);
    EXPECT_EQ(parse_number("8000H"), 0x8000);
}

TEST(ParseNumber, RefusesEverythingElse) {
    for (const char* text : {"", "A3H", "12G", "0x", "0xG", "2B", "-1", "H", "''", "12 "}) {
        EXPECT_FALSE(parse_number(text).has_value()) << text;
    }
    EXPECT_FALSE(parse_number("99999999999999999999").has_value());
}

// 3.072 MHz: 1 ms is 3072 T, 1 us 3.072 T, 10 us 30.72 T.
TEST(ParseTime, IsAbsoluteOrRelativeInTStatesOrTime) {
    EXPECT_EQ(parse_time("5000", 100), 5000u);
    EXPECT_EQ(parse_time("+500", 100), 600u);
    EXPECT_EQ(parse_time("+20H", 100), 132u);
    EXPECT_EQ(parse_time("10ms", 100), 30720u);
    EXPECT_EQ(parse_time("+2.5ms", 100), 7780u);
    EXPECT_EQ(parse_time("10us", 0), 30u);
    EXPECT_EQ(parse_time("1s", 0), 3072000u);
}

TEST(ParseTime, RefusesWhatIsNone) {
    for (const char* text : {"", "+", "soon", "5 ms", "5min", "-5", "+-5", "1e99s", "nans"}) {
        EXPECT_THROW(static_cast<void>(parse_time(text, 0)), DebugError) << text;
    }
}

TEST(WithoutComment, LeavesStringsAlone) {
    EXPECT_EQ(without_comment("step 3 # three"), "step 3 ");
    EXPECT_EQ(without_comment("# all of it"), "");
    EXPECT_EQ(without_comment(R"(send "a # b \" # c" # d)"), R"(send "a # b \" # c" )");
    EXPECT_EQ(without_comment("print a#b"), "print a#b");
}

TEST(Arguments, AreTakenWordByWord) {
    Arguments arguments("  one, two\tTHREE  ");
    EXPECT_EQ(arguments.peek(), "one");
    EXPECT_EQ(arguments.word("X"), "one");
    EXPECT_FALSE(arguments.take("three"));
    EXPECT_EQ(arguments.word("X"), "two");
    EXPECT_EQ(arguments.rest(), "THREE");
    EXPECT_TRUE(arguments.take("three"));
    EXPECT_TRUE(arguments.empty());
    EXPECT_THROW(arguments.word("X"), DebugError);
    arguments.expect_end();
    Arguments more("a b");
    EXPECT_THROW(more.expect_end(), DebugError);
    EXPECT_EQ(more.take_rest(), "a b");
}

TEST(Arguments, StringsHaveEscapes) {
    Arguments arguments(R"("a b\n\x7E\"" 5)");
    EXPECT_EQ(arguments.take_quoted(), "a b\n~\"");
    EXPECT_FALSE(arguments.take_quoted().has_value());
    EXPECT_EQ(arguments.word("X"), "5");
    for (const char* text : {R"("open)", R"("\q")", R"("\x7")", R"("\)", R"("\xZZ")"}) {
        Arguments wrong(text);
        EXPECT_THROW(wrong.take_quoted(), DebugError) << text;
    }
}

TEST(Quote, IsReadBackForEveryByte) {
    std::string all;
    for (int byte = 0; byte < 256; ++byte) all += static_cast<char>(byte);
    const std::string text = quote(all);
    Arguments arguments(text);
    EXPECT_EQ(arguments.take_quoted(), all);
    EXPECT_EQ(quote("K\n"), "\"K\\n\"");
    EXPECT_EQ(quote(std::string("\0~\x7F", 3)), "\"\\x00~\\x7F\"");
}

TEST(SameWord, IgnoresTheCaseOfLettersOnly) {
    EXPECT_TRUE(same_word("Step", "sTEP"));
    EXPECT_FALSE(same_word("step", "steps"));
    EXPECT_FALSE(same_word("a[", "a{"));
}

}  // namespace
}  // namespace debug_console
