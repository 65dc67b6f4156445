// assemble_test.cpp - the tests' assembler: every instruction back and forth, directives, refusals.
// Expected bytes are taken from Intel's opcode tables by hand.
#include "tests/support/assemble.hpp"

#include <gtest/gtest.h>

#include "toolchain/isa/disassemble.hpp"
#include "toolchain/isa/instruction_set.hpp"

namespace {

using test_support::assemble;
using test_support::AssembleError;
using Bytes = std::vector<uint8_t>;

std::string error_of(std::string_view source) {
    try {
        (void)assemble(source);
    } catch (const AssembleError& error) {
        return error.what();
    }
    return "accepted";
}

TEST(Assemble, EveryOpcodeComesBackFromItsDisassembly) {
    // Operand bytes with a letter in front and with a digit, so that both forms of hex occur.
    for (const auto& [low, high] : {std::pair{0x34, 0x12}, std::pair{0xCD, 0xAB}}) {
        for (unsigned opcode = 0; opcode < 256; ++opcode) {
            Bytes bytes = {static_cast<uint8_t>(opcode), static_cast<uint8_t>(low),
                           static_cast<uint8_t>(high)};
            const auto text = toolchain::isa::disassemble(bytes);
            bytes.resize(text.bytes);
            const auto back = assemble(text.text + "\n");
            EXPECT_EQ(back.bytes, bytes) << text.text;
            EXPECT_EQ(back.origin, 0) << text.text;
        }
    }
}

TEST(Assemble, AProgramByHand) {
    const auto program = assemble(R"(
; adds the numbers 1 to 10
COUNT   EQU  10
        org  100H          ; lower case is fine
START:  LXI  SP,STACK
        MVI  B,COUNT
        XRA  A
LOOP:   ADD  B
        DCR  B
        JNZ  LOOP
        STA  SUM
        HLT
SUM:    DB   0
TEXT:   DB   'A;B','it''s',0FFH,-1,101B,'A'+1
WORDS:  DW   START,1234H,$,TEXT-SUM
        DS   3
STACK   EQU  $+2
        END
        this is not read
)");
    EXPECT_EQ(program.origin, 0x0100);
    const Bytes expected = {
        0x31, 0x28, 0x01,                                              // 100 LXI SP,126+2
        0x06, 0x0A,                                                    // 103 MVI B
        0xAF, 0x80, 0x05,                                              // 105 XRA A, ADD B, DCR B
        0xC2, 0x06, 0x01,                                              // 108 JNZ 106
        0x32, 0x0F, 0x01, 0x76,                                        // 10B STA 10F, HLT
        0x00,                                                          // 10F
        'A',  ';',  'B',  'i',  't',  '\'', 's',  0xFF, 0xFF, 5, 'B',  // 110
        0x00, 0x01, 0x34, 0x12, 0x1B, 0x01, 0x01, 0x00,                // 11B; $ is the line's start
        0x00, 0x00, 0x00};                                             // 123
    EXPECT_EQ(program.bytes, expected);
    EXPECT_EQ(program.symbols.at("START"), 0x0100);
    EXPECT_EQ(program.symbols.at("LOOP"), 0x0106);
    EXPECT_EQ(program.symbols.at("COUNT"), 10);
    EXPECT_EQ(program.symbols.at("STACK"), 0x0128);
}

TEST(Assemble, OrgFillsGapsWithZero) {
    const auto program = assemble("ORG 8\nRET\nORG 0CH\nX: NOP\n HLT");
    EXPECT_EQ(program.origin, 8);
    EXPECT_EQ(program.bytes, (Bytes{0xC9, 0, 0, 0, 0x00, 0x76}));
    EXPECT_EQ(program.symbols.at("X"), 0x0C);
}

TEST(Assemble, TheTopByteOfMemoryCanBeUsed) {
    EXPECT_EQ(assemble("ORG 0FFFFH\nHLT").bytes, Bytes{0x76});
    EXPECT_EQ(error_of("ORG 0FFFFH\nNOP\nHLT"), "line 3: the program goes beyond 0FFFFH");
}

TEST(Assemble, UndocumentedInstructionsHaveBothTheirNames) {
    EXPECT_EQ(assemble("JNX5 1234H\nJX5 1234H\nJK 1234H\nDSUB\nLDHI 5").bytes,
              (Bytes{0xDD, 0x34, 0x12, 0xFD, 0x34, 0x12, 0xFD, 0x34, 0x12, 0x08, 0x28, 0x05}));
}

TEST(Assemble, MistakesAreRefusedWithLineAndReason) {
    EXPECT_EQ(error_of("NOP\nMOVE A,B"), "line 2: 'MOVE' is neither instruction nor directive");
    EXPECT_EQ(error_of("MOV M,M"), "line 1: MOV does not take 'M,M'");
    EXPECT_EQ(error_of("MVI B,C"), "line 1: MVI does not take 'B,C'");
    EXPECT_EQ(error_of("RST 8"), "line 1: RST does not take '8'");
    EXPECT_EQ(error_of("NOP 1"), "line 1: NOP does not take '1'");
    EXPECT_EQ(error_of("MVI A,256"), "line 1: '256' is beyond 8 bits");
    EXPECT_EQ(error_of("MVI A,-129"), "line 1: '-129' is beyond 8 bits");
    EXPECT_EQ(error_of("LXI H,65536"), "line 1: '65536' is beyond 16 bits");
    EXPECT_EQ(error_of("LXI H,65535+1"), "line 1: '65535+1' is beyond 16 bits");
    EXPECT_EQ(error_of("JMP AWAY"), "line 1: 'AWAY' is not defined");
    EXPECT_EQ(error_of("A1: NOP\nA1: NOP"), "line 2: 'A1' is defined twice");
    EXPECT_EQ(error_of("SP: NOP"), "line 1: 'SP' cannot be a label");
    EXPECT_EQ(error_of("ORG 5\nNOP\nORG 5"), "line 3: ORG 0005H goes back from 0006H");
    EXPECT_EQ(error_of("DS LATER\nLATER: NOP"), "line 1: 'LATER' is not defined");
    EXPECT_EQ(error_of("DB 1,,2"), "line 1: an operand is empty");
    EXPECT_EQ(error_of("DB 12G"), "line 1: '12G' is not a number");
    EXPECT_EQ(error_of("DB 1+"), "line 1: an expression lacks a number");
    EXPECT_EQ(error_of("DB"), "line 1: DB without operands");
    EXPECT_EQ(error_of("EQU 5"), "line 1: 'EQU' is neither instruction nor directive");
    EXPECT_EQ(error_of("X: EQU 5"), "line 1: 'X' is written without a colon in front of EQU");
}

}  // namespace
