// program_test.cpp - ranges and finding symbols.
#include "toolchain/asm/program.hpp"

#include <gtest/gtest.h>

namespace {

using namespace toolchain::assembly;

TEST(Program, RangesIncludeBothEnds) {
    EXPECT_EQ((AddressRange{0x0000, 0xFFFF}.size()), 0x10000u);
    EXPECT_EQ((AddressRange{0x8000, 0x8000}.size()), 1u);
    EXPECT_EQ((Region{0xFF00, 0x100}.end()), 0x10000u);
}

TEST(Program, FindsGlobalNamesOnly) {
    Program program;
    program.symbols = {{".x", 1}, {"x", 2}};
    ASSERT_NE(program.find("x"), nullptr);
    EXPECT_EQ(program.find("x")->value, 2);
    EXPECT_EQ(program.find(".x"), nullptr);
    EXPECT_EQ(program.find("y"), nullptr);
}

}  // namespace
