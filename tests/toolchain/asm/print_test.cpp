// print_test.cpp - items and modules as source.
#include "toolchain/asm/print.hpp"

#include <gtest/gtest.h>

#include "support.hpp"

namespace {

using namespace asm_test;
using namespace toolchain::assembly;

TEST(Print, Items) {
    EXPECT_EQ(item_text(instruction(0x41)), "MOV   B,C");
    EXPECT_EQ(item_text(instruction(0x3E, {"", -1})), "MVI   A,0FFH");
    EXPECT_EQ(item_text(instruction(0x3E, {"t", 1, Part::low})), "MVI   A,LOW(t+1)");
    EXPECT_EQ(item_text(instruction(0xC3, {"f"})), "JMP   f");
    EXPECT_EQ(item_text(instruction(0x21, {"", 0x8000})), "LXI   H,8000H");
    EXPECT_EQ(item_text(instruction(0xFF)), "RST   7");
    EXPECT_EQ(item_text(instruction(0xC9)), "RET");
    EXPECT_EQ(item_text(data_bytes({1, 0xAB})), "DB    01H,0ABH");
    EXPECT_EQ(item_text(data_word({"t", -2})), "DW    t-2");
    EXPECT_EQ(item_text(space(3)), "DS    3");
    EXPECT_EQ(item_text(label("x")), "");
}

constexpr std::string_view kSource = R"(SECTION drive,code,FUNCTION drive,TITLE 'it''s drive(int)'
drive:
        ;@t 14 to 20
        LDA   "a b"
.x:
        JMP   .x
SECTION frame,frame,OFFSET 6
"a b":
        DS    2
SECTION log,persistent,AT 0FF00H
        DS    4
SECTION t,constant,ALIGN 16
        DB    01H
        DB    02H
        DW    drive+1
SIZE EQU 4
)";

TEST(Print, AModuleComesBackAsItsSource) {
    EXPECT_EQ(source_text(module_of(kSource)), kSource);
}

}  // namespace
