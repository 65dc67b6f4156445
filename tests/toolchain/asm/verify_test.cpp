// verify_test.cpp - each kind of damage is found.
#include "toolchain/asm/verify.hpp"

#include <gtest/gtest.h>

#include "support.hpp"

namespace {

using namespace asm_test;
using namespace toolchain::assembly;

std::string findings(const Program& program, bool undocumented = false) {
    std::string text;
    for (const Diagnostic& one : verify(program, {undocumented})) text += one.message() + '\n';
    return text;
}

TEST(Verify, UndocumentedInstructionsOnlyIfAllowed) {
    const Program program = linked("SECTION f,code\nf: DSUB\nRET\n", rooted({"f"}));
    EXPECT_EQ(findings(program), "t.s85:2: 0000H: DSUB is not documented for the 8085\n");
    EXPECT_EQ(findings(program, true), "");
}

TEST(Verify, JumpsMustMeetInstructions) {
    const Program program =
        linked("SECTION f,code\nf: JMP f+1\nCALL t\nJMP f+3\nJMP 5\nSECTION t,constant\nt: DB 1\n",
               rooted({"f"}));
    EXPECT_EQ(findings(program),
              "t.s85:2: 0000H: JMP   f+1 goes to 0001H, where no instruction is\n"
              "t.s85:3: 0003H: CALL  t goes to 000CH, where no instruction is\n");
}

TEST(Verify, TheImageHoldsTheInstructions) {
    Program program = linked("SECTION f,code\nf: NOP\nRET\n", rooted({"f"}));
    program.image.bytes[1] = 0x76;
    EXPECT_EQ(findings(program), "t.s85:3: 0001H: RET, but the image has 76H there\n");
    program.image.bytes[1] = 0xC9;
    program.image.present.reset(1);
    EXPECT_EQ(findings(program), "t.s85:3: the image has no byte at 0001H\n");
}

TEST(Verify, RegionsLieInRamAndApart) {
    Program program = linked("SECTION f,code\nf: RET\n", rooted({"f"}));
    program.stack = {0xFE00, 0x100};
    program.zero = {0x8000, 4};
    EXPECT_EQ(findings(program), "");
    program.data = {0x8003, 2};
    EXPECT_EQ(findings(program), "zero: this region overlaps another one\n");
    program.data = {0x7FFF, 1};
    EXPECT_EQ(findings(program), "data: this region is not in RAM\n");
    program.data = {};
    program.rom = {0x100, 0x1FF};
    EXPECT_EQ(findings(program), "f: section 'f' is not in ROM\n");
}

}  // namespace
