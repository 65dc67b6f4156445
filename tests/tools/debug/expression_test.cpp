// expression_test.cpp - values and conditions against a board whose state is set by hand.
#include "tools/debug/expression.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tools/debug/debug_error.hpp"

namespace debug_console {
namespace {

class ExpressionTest : public testing::Test {
protected:
    ExpressionTest()
        : names_(host_sim::Symbols({symbol("main", 0x100), symbol("A", 0x7000)}, "t")) {
        state_.cpu.a = 5;
        state_.cpu.h = 0x80;
        state_.cpu.l = 0x10;
        state_.cpu.sp = 0x8010;
        state_.cpu.pc = 0x123;
        state_.cpu.t = 5'000'000'000;
        state_.memory.bytes[0x8010] = 0x34;
        state_.memory.bytes[0x8011] = 0x12;
        state_.memory.bytes[0xFFFF] = 0x77;
    }
    static host_sim::Symbol symbol(const char* name, uint16_t address) {
        host_sim::Symbol made;
        made.name = name;
        made.address = address;
        made.kind = host_sim::SymbolKind::function;
        return made;
    }
    int64_t value(const char* text) { return Expression::parse(text, names_).value(state_); }
    bool holds(const char* text) { return Condition::parse(text, names_).holds(state_); }

    Names names_;
    host_sim::BoardState state_;
};

TEST_F(ExpressionTest, JoinsNumbersRegistersSymbolsAndMemory) {
    EXPECT_EQ(value("0A3H"), 0xA3);
    EXPECT_EQ(value("main+3"), 0x103);
    EXPECT_EQ(value("main + 3 - 1"), 0x102);
    EXPECT_EQ(value("$"), 0x123);
    EXPECT_EQ(value("HL-10H"), 0x8000);
    EXPECT_EQ(value("T"), 5'000'000'000);
    EXPECT_EQ(value("[HL]"), 0x34);
    EXPECT_EQ(value("M"), 0x34);
    EXPECT_EQ(value("[8010H+1]+1"), 0x13);
    EXPECT_EQ(value("word[SP]"), 0x1234);
    EXPECT_EQ(value("word[0FFFFH]"), 0xFF77) << "the high byte comes from address 0: erased";
    EXPECT_EQ(value("[word[SP]-1234H+SP]"), 0x34);
    EXPECT_EQ(value("-1"), -1);
    EXPECT_EQ(value("'+'"), 43);
    EXPECT_EQ(value("A"), 5) << "registers win over symbols";
}

TEST_F(ExpressionTest, NamesWhatItDoesNotUnderstand) {
    for (const char* text :
         {"", "+", "1+", "mian", "[", "[]", "word[", "1 2", "A3H", "9999999999999999999999"}) {
        EXPECT_THROW(static_cast<void>(value(text)), DebugError) << text;
    }
    try {
        value("main+mian");
        FAIL();
    } catch (const DebugError& error) {
        EXPECT_STREQ(error.what(),
                     "mian: no number, register or symbol (`symbols` lists those loaded)");
    }
}

TEST_F(ExpressionTest, ConditionsCompare) {
    EXPECT_TRUE(holds("A==5"));
    EXPECT_TRUE(holds(" A == 5 "));
    EXPECT_FALSE(holds("A != 5"));
    EXPECT_TRUE(holds("A < 6"));
    EXPECT_FALSE(holds("A < 5"));
    EXPECT_TRUE(holds("A <= 5"));
    EXPECT_TRUE(holds("A > 4"));
    EXPECT_FALSE(holds("A > 5"));
    EXPECT_TRUE(holds("A >= 5"));
    EXPECT_FALSE(holds("A >= 6"));
    EXPECT_TRUE(holds("[HL] == 34H and word[SP] == 1234H and T > 1000"));
    EXPECT_FALSE(holds("A == 5 and Z == 1"));
    EXPECT_TRUE(Condition().holds(state_));
    EXPECT_EQ(Condition::parse(" A == 5 ", names_).text(), "A == 5");
}

TEST_F(ExpressionTest, ConditionsNeedAComparison) {
    for (const char* text : {"", "A", "A == ", "== 5", "A = 5", "A == 5 and", "A == 5 and B"}) {
        EXPECT_THROW(static_cast<void>(Condition::parse(text, names_)), DebugError) << text;
    }
}

}  // namespace
}  // namespace debug_console
