// Registers are numbered as the instruction set numbers them.
#include "toolchain/codegen/machine.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <string_view>

#include "toolchain/isa/instruction_set.hpp"

namespace {

using namespace toolchain::codegen;

TEST(Machine, RegistersAreNumberedAsInMov) {
    constexpr std::string_view kLetters = "BCDEHL?A";
    for (const Register which : {Register::b, Register::c, Register::d, Register::e, Register::h,
                                 Register::l, Register::a}) {
        const auto number = static_cast<unsigned>(which);
        const auto mov = static_cast<uint8_t>(0x40 | 7U << 3 | number);
        EXPECT_EQ(toolchain::isa::instruction(mov).text(),
                  fmt::format("MOV A,{}", kLetters[number]));
    }
    // 6 is memory there, so a set has it free for the flags.
    EXPECT_EQ(toolchain::isa::instruction(0x7E).text(), "MOV A,M");
    EXPECT_EQ(static_cast<unsigned>(Register::flags), 6U);
}

TEST(Machine, ASetHasABitForEach) {
    EXPECT_EQ(set_of(Register::b), 1);
    EXPECT_EQ(set_of(Register::a), 0x80);
    EXPECT_EQ(set_of(Register::flags) | 0xBF, kAllRegisters);
}

}  // namespace
