// expression_test.cpp - sums of numbers and addresses, by hand.
#include "toolchain/asm/expression.hpp"

#include <gtest/gtest.h>

#include "toolchain/asm/source_lines.hpp"

namespace {

using namespace toolchain::assembly;

/// Section 0 is relocatable and has p at 2, q at 7; section 1 is at 1000H and has r at 4.
Names sample_names() {
    Names names;
    names.symbol = [](const std::string& symbol) -> Value {
        if (symbol == "p") return {0, {{"p", 0, 2}}};
        if (symbol == "q") return {0, {{"q", 0, 7}}};
        if (symbol == "r") return {0, {{"r", 1, 4}}};
        if (symbol == "five") return {5};
        return {0, {{symbol}}};
    };
    names.here = [] { return Value{0x100}; };
    names.address = [](int section) {
        return section == 1 ? std::optional<int32_t>(0x1000) : std::nullopt;
    };
    return names;
}

int32_t number(std::string_view text) {
    const Value value = evaluate(text, sample_names());
    EXPECT_TRUE(value.bases.empty()) << text;
    return value.number;
}

std::string mistake(std::string_view text) {
    try {
        (void)evaluate(text, sample_names());
    } catch (const Mistake& error) {
        return error.what();
    }
    return "accepted";
}

TEST(Expression, Numbers) {
    EXPECT_EQ(number("10"), 10);
    EXPECT_EQ(number("0FFh"), 255);
    EXPECT_EQ(number("101b"), 5);
    EXPECT_EQ(number("'A'+1"), 66);
    EXPECT_EQ(number("-(five-7)+$"), 0x102);
    EXPECT_EQ(number("LOW(1234H)+HIGH(-1)"), 0x34 + 0xFF);
}

TEST(Expression, DifferencesAreNumbers) {
    EXPECT_EQ(number("q-p"), 5);
    EXPECT_EQ(number("-p+q+1"), 6);
    EXPECT_EQ(number("away-away"), 0);
    EXPECT_EQ(number("0-r"), -0x1004);  // its section has an address
}

TEST(Expression, AnAddressStaysSymbolic) {
    const Value sum = evaluate("3+q-1", sample_names());
    ASSERT_EQ(sum.bases.size(), 1u);
    EXPECT_EQ(sum.bases[0].symbol, "q");
    EXPECT_EQ(sum.number, 2);
    const Value high = evaluate("high(away+2)", sample_names());
    EXPECT_EQ(high.part, Part::high);
    EXPECT_EQ(high.number, 2);
}

TEST(Expression, MistakesAreSaid) {
    EXPECT_EQ(mistake("1+"), "an expression lacks a number");
    EXPECT_EQ(mistake("12G"), "'12G' is not a number");
    EXPECT_EQ(mistake("65536"), "'65536' is beyond 16 bits");
    EXPECT_EQ(mistake("-32768-1"), "'-32768-1' is beyond 16 bits");
    EXPECT_EQ(mistake("'AB'"), "'AB' is not one character");
    EXPECT_EQ(mistake("p+q"), "'p+q' is neither a number nor one address plus a number");
    EXPECT_EQ(mistake("-away"), "'-away' is neither a number nor one address plus a number");
    EXPECT_EQ(mistake("LOW(p)+1"), "LOW or HIGH of an address stands alone, as LOW(TABLE+1)");
    EXPECT_EQ(mistake("LOW(HIGH(p))"), "LOW and HIGH do not nest");
}

}  // namespace
