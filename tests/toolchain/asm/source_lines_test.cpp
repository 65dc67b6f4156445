// source_lines_test.cpp - fields of a line, by hand.
#include "toolchain/asm/source_lines.hpp"

#include <gtest/gtest.h>

namespace {

using namespace toolchain::assembly;
using Operands = std::vector<std::string>;

TEST(SourceLines, Fields) {
    const SourceLine line = split_line("loop:  mvi A , ';' ; a comment; more");
    EXPECT_EQ(line.label, "loop");
    EXPECT_EQ(line.operation, "MVI");
    EXPECT_EQ(line.operands, (Operands{"A", "';'"}));
    EXPECT_EQ(line.note, "");

    const SourceLine quoted = split_line("\"f(int, char): x\": LXI H,HIGH(a,b)");
    EXPECT_EQ(quoted.label, "f(int, char): x");
    EXPECT_EQ(quoted.operands, (Operands{"H", "HIGH(a,b)"}));

    const SourceLine equate = split_line("SIZE equ 4 ;@loop 7");
    EXPECT_EQ(equate.label, "SIZE");
    EXPECT_EQ(equate.operation, "EQU");
    EXPECT_EQ(equate.note, "loop 7");
}

TEST(SourceLines, WhatIsASymbol) {
    for (const char* good : {"x", "_Z3foov", "mul.cells", ".loop", "?1", "@a", "\"a b\"", "SPX"}) {
        EXPECT_TRUE(is_symbol(good)) << good;
    }
    for (const char* bad : {"", "1x", "a", "SP", "psw", "a b", "\"", "\"\"", "\"a", "x+1"}) {
        EXPECT_FALSE(is_symbol(bad)) << bad;
    }
}

TEST(SourceLines, NamesThatNeedQuotesGetThem) {
    for (const char* name : {"plain", "a", "M", "two words", "f(int)", "1st"}) {
        EXPECT_EQ(symbol_name(symbol_text(name)), name);
        EXPECT_TRUE(is_symbol(symbol_text(name))) << name;
    }
    EXPECT_EQ(symbol_text("plain"), "plain");
    EXPECT_EQ(symbol_text("a"), "\"a\"");
}

TEST(SourceLines, Strings) {
    EXPECT_EQ(string_operand("'it''s'"), "it's");
    EXPECT_EQ(string_operand("''"), "");
    EXPECT_EQ(string_operand("'A'+'B'"), std::nullopt);
    EXPECT_EQ(string_operand("A"), std::nullopt);
}

TEST(SourceLines, FindsOutsideOfQuotesAndParentheses) {
    EXPECT_EQ(find_outside("LOW(a+b)+c", "+"), 8u);
    EXPECT_EQ(find_outside("'+'-1", "+-"), 3u);
    EXPECT_EQ(find_outside("abc", "+"), 3u);
    EXPECT_EQ(trimmed(" \t x y\r"), "x y");
    EXPECT_EQ(upper_case("Mov1"), "MOV1");
}

TEST(SourceLines, MistakesAreSaid) {
    EXPECT_THROW((void)split_line("DB 1,,2"), Mistake);
    EXPECT_THROW((void)split_line("SP: NOP"), Mistake);
    EXPECT_THROW((void)split_line("x: EQU 4"), Mistake);
}

}  // namespace
