// What LLVM makes of loops and divisions when it knows what they cost here.
#include "toolchain/ir/costs.hpp"

#include <gtest/gtest.h>

#include <string>

#include "tests/toolchain/ir/ir_program.hpp"

namespace {

std::size_t count(const std::string& text, const std::string& word) {
    std::size_t found = 0;
    for (std::size_t at = text.find(word); at != text.npos; at = text.find(word, at + 1)) ++found;
    return found;
}

std::string optimised(const std::string& source, const std::string& level) {
    llvm::LLVMContext context;
    std::string text;
    llvm::raw_string_ostream stream(text);
    ir_test::compile(source, level, context)->print(stream, nullptr);
    return text;
}

class Costs : public testing::TestWithParam<std::string> {};

// The closed form is a product or two.
TEST_P(Costs, ALoopThatCountsStays) {
    const std::string text = optimised(
        "extern \"C\" unsigned char f(unsigned char n, unsigned char s) {\n"
        "    unsigned char sum = 0;\n"
        "    for (unsigned char i = 0; i < n; ++i) { sum += s; s += 16; }\n"
        "    return sum;\n}\n",
        GetParam());
    EXPECT_EQ(count(text, " mul "), 0U) << text;
    EXPECT_GE(count(text, " phi "), 2U) << text;
}

// One call gives both; quotient times divisor would be another.
TEST_P(Costs, ARemainderIsNotMadeOfTheQuotient) {
    const std::string text = optimised(
        "extern \"C\" unsigned f(unsigned a, unsigned b) { return a / b ^ a % b; }\n", GetParam());
    EXPECT_EQ(count(text, "= udiv "), 1U) << text;
    EXPECT_EQ(count(text, "= urem "), 1U) << text;
    EXPECT_EQ(count(text, " mul "), 0U) << text;
}

INSTANTIATE_TEST_SUITE_P(Levels, Costs, testing::Values("1", "2", "s"),
                         [](const auto& test) { return "O" + test.param; });

}  // namespace
