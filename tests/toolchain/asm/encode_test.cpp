// encode_test.cpp - bytes of items; opcodes from Intel's table.
#include "toolchain/asm/encode.hpp"

#include <gtest/gtest.h>

#include "support.hpp"

namespace {

using namespace asm_test;
using namespace toolchain::assembly;

class Encode : public testing::Test {
protected:
    Encode() {
        program_.sections.resize(2);
        program_.symbols = {
            {"table", 0x12FE}, {"small", 0x00FF}, {".x", 0x0102, 0, LabelKind::label, 1}};
    }
    Bytes bytes(const Item& item) { return encode(item, 1, SymbolValues(program_)); }
    std::string mistake(const Item& item, std::size_t section = 1) {
        try {
            (void)encode(item, section, SymbolValues(program_));
        } catch (const Mistake& error) {
            return error.what();
        }
        return "accepted";
    }

    Program program_;
};

TEST_F(Encode, ValuesAndParts) {
    EXPECT_EQ(bytes(instruction(0x21, {"table", 3})), (Bytes{0x21, 0x01, 0x13}));       // LXI H
    EXPECT_EQ(bytes(instruction(0x3E, {"table", 3, Part::low})), (Bytes{0x3E, 0x01}));  // MVI A
    EXPECT_EQ(bytes(instruction(0x3E, {"table", 3, Part::high})), (Bytes{0x3E, 0x13}));
    EXPECT_EQ(bytes(instruction(0x3E, {"", -128})), (Bytes{0x3E, 0x80}));
    EXPECT_EQ(bytes(instruction(0x3E, {"small"})), (Bytes{0x3E, 0xFF}));
    EXPECT_EQ(bytes(instruction(0xC3, {".x"})), (Bytes{0xC3, 0x02, 0x01}));  // JMP
    EXPECT_EQ(bytes(instruction(0xC9)), (Bytes{0xC9}));
    EXPECT_EQ(bytes(data_word({"", -2})), (Bytes{0xFE, 0xFF}));
    EXPECT_EQ(bytes(data_byte({"table", 0, Part::high})), (Bytes{0x12}));
    EXPECT_EQ(bytes(space(2)), (Bytes{0, 0}));
    EXPECT_EQ(bytes(label("x")), Bytes());
}

TEST_F(Encode, WhatDoesNotFitIsRefused) {
    EXPECT_EQ(mistake(instruction(0x3E, {"small", 1})), "'small+1' is 0100H, beyond 8 bits");
    EXPECT_EQ(mistake(instruction(0x3E, {"", -129})), "'-129' is FF7FH, beyond 8 bits");
    EXPECT_EQ(mistake(instruction(0x21, {"table", 0xED02})), "'table+60674' is beyond 16 bits");
    EXPECT_EQ(mistake(instruction(0x21, {"table", 0xED01})), "accepted");
    EXPECT_EQ(mistake(instruction(0x21, {"gone"})), "'gone' is not defined");
    EXPECT_EQ(mistake(instruction(0x21, {".x"}), 0), "'.x' is not defined");
}

TEST_F(Encode, OperandsAsText) {
    EXPECT_EQ(operand_text({"table", -3, Part::high}), "HIGH(table-3)");
    EXPECT_EQ(operand_text({"a", 0}), "\"a\"");
    EXPECT_EQ(operand_text({"", 12}), "12");
}

}  // namespace
