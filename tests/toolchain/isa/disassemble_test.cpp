// disassemble_test.cpp - Intel syntax, by hand from the manual's assembly language examples.
#include "toolchain/isa/disassemble.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace {

using toolchain::isa::disassemble;
using toolchain::isa::intel_hex;

std::string text_of(std::vector<uint8_t> code, const toolchain::isa::DisassembleOptions& o = {}) {
    return disassemble(code, o).text;
}

TEST(Disassemble, NumbersAreInIntelsForm) {
    EXPECT_EQ(text_of({0x3E, 0xA3}), "MVI A,0A3H");
    EXPECT_EQ(text_of({0x3E, 0x05}), "MVI A,05H");
    EXPECT_EQ(text_of({0x21, 0x34, 0x12}), "LXI H,1234H");
    EXPECT_EQ(text_of({0xC3, 0x00, 0xF8}), "JMP 0F800H");
    EXPECT_EQ(text_of({0xD3, 0x08}), "OUT 08H");
    EXPECT_EQ(text_of({0x7E}), "MOV A,M");
    EXPECT_EQ(text_of({0xFF}), "RST 7");
    EXPECT_EQ(intel_hex(0x9FFF, 4), "9FFFH");
    EXPECT_EQ(intel_hex(0xA000, 4), "0A000H");
}

TEST(Disassemble, SymbolsReplaceAddressesAndNotData) {
    toolchain::isa::DisassembleOptions options;
    options.address_text = [](uint16_t address) {
        return address == 0x1234 ? std::string("start") : std::string();
    };
    EXPECT_EQ(text_of({0xCD, 0x34, 0x12}, options), "CALL start");
    EXPECT_EQ(text_of({0x3A, 0x34, 0x12}, options), "LDA start");
    EXPECT_EQ(text_of({0xCD, 0x35, 0x12}, options), "CALL 1235H");
    EXPECT_EQ(text_of({0x21, 0x34, 0x12}, options), "LXI H,1234H");
}

TEST(Disassemble, UndocumentedOpcodesAreNamedOrGivenAsBytes) {
    EXPECT_EQ(text_of({0x08}), "DSUB");
    EXPECT_EQ(text_of({0xDD, 0x34, 0x12}), "JNK 1234H");
    const auto strict = disassemble(std::vector<uint8_t>{0xDD, 0x34, 0x12},
                                    {.documented_only = true, .address_text = {}});
    EXPECT_EQ(strict.text, "DB 0DDH");
    EXPECT_EQ(strict.bytes, 1);
    EXPECT_EQ(text_of({0x08}, {.documented_only = true, .address_text = {}}), "DB 08H");
}

TEST(Disassemble, AnInstructionThatIsCutOffIsOneByteOfData) {
    const auto cut = disassemble(std::vector<uint8_t>{0xC3, 0x34});
    EXPECT_EQ(cut.text, "DB 0C3H");
    EXPECT_EQ(cut.bytes, 1);
    EXPECT_THROW((void)disassemble({}), std::invalid_argument);
}

TEST(Disassemble, TheLengthIsThatOfTheInstruction) {
    EXPECT_EQ(disassemble(std::vector<uint8_t>{0x00, 0, 0}).bytes, 1);
    EXPECT_EQ(disassemble(std::vector<uint8_t>{0x28, 0, 0}).bytes, 2);
    EXPECT_EQ(disassemble(std::vector<uint8_t>{0x22, 0, 0}).bytes, 3);
}

}  // namespace
