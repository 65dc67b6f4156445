// Jumps, labels and constants of a finished function.
#include "toolchain/codegen/peephole.hpp"

#include <gtest/gtest.h>

#include "tests/toolchain/codegen/code_items.hpp"
#include "tests/toolchain/codegen/coder_fixture.hpp"

namespace {

using namespace toolchain::codegen;
using codegen_test::item;
using codegen_test::jump;
using codegen_test::label;
using codegen_test::number;
using codegen_test::text_of;

constexpr uint8_t kMviA = 0x3E;
constexpr uint8_t kInrB = 0x04;

std::string improved(std::vector<CodeItem> items) {
    improve(items);
    return text_of(items);
}

TEST(Peephole, JumpsToWhatFollowsDisappearWithTheirLabel) {
    EXPECT_EQ(improved({jump(op::kJmp, 1), label(1), item(kInrB), item(op::kRet)}), "INR B; RET");
}

TEST(Peephole, JumpsToJumpsGoAllTheWay) {
    std::vector<CodeItem> items = {jump(op::kJz, 1), item(kInrB),       item(op::kRet),
                                   label(1),         jump(op::kJmp, 2), item(kInrB),
                                   label(2),         item(kInrB),       item(op::kRet)};
    improve(items);
    EXPECT_EQ(text_of(items), "JZ a16; INR B; RET; L:; INR B; RET");
    EXPECT_EQ(items[0].operand.id, 2U);
}

TEST(Peephole, JumpsToReturnsReturn) {
    EXPECT_EQ(improved({jump(op::kJz, 1), item(kInrB), label(1), item(op::kRet)}),
              "RZ; INR B; RET");
    EXPECT_EQ(improved({jump(op::kJnc, 1), item(kInrB), label(1), item(op::kRet)}),
              "RNC; INR B; RET");
}

TEST(Peephole, ThereIsNoReturnOnK) {
    EXPECT_EQ(improved({jump(op::kJk, 1), item(kInrB), label(1), item(op::kRet)}),
              "JK a16; INR B; L:; RET");
    EXPECT_EQ(improved({jump(op::kJk, 1), item(op::kRet), label(1), item(kInrB), item(op::kRet)}),
              "JK a16; RET; L:; INR B; RET");
}

TEST(Peephole, AJumpOnKOverAJumpIsTheOtherOne) {
    EXPECT_EQ(improved({label(2), item(kInrB), jump(op::kJk, 1), jump(op::kJmp, 2), label(1),
                        item(op::kRet)}),
              "L:; INR B; JNK a16; RET");
}

TEST(Peephole, CodeThatNobodyReachesDisappears) {
    EXPECT_EQ(improved({item(op::kRet), item(kInrB), item(kInrB)}), "RET");
}

TEST(Peephole, ZeroIsXraWhereNoFlagIsRead) {
    EXPECT_EQ(improved({number(kMviA, 0), item(op::kRet)}), "XRA A; RET");
    EXPECT_EQ(improved({number(kMviA, 1), item(op::kRet)}), "MVI A,d8; RET");
    // The carry of DAD goes into ADC.
    EXPECT_EQ(improved({item(0x29), number(kMviA, 0), item(0x8F), item(op::kRet)}),
              "DAD H; MVI A,d8; ADC A; RET");
    // INR leaves the carry alone: RAL still reads the one from before.
    EXPECT_EQ(improved({number(kMviA, 0), item(kInrB), item(op::kRal), item(op::kRet)}),
              "MVI A,d8; INR B; RAL; RET");
    EXPECT_EQ(improved({number(kMviA, 0), item(0xB8), item(op::kRal), item(op::kRet)}),
              "XRA A; CMP B; RAL; RET");
}

TEST(Peephole, AnEndlessLoopStays) {
    EXPECT_EQ(improved({label(1), jump(op::kJmp, 1)}), "L:; JMP a16");
}

}  // namespace
