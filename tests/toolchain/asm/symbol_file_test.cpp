// symbol_file_test.cpp - the form of docs/spec/symbols.md, by hand and by the simulator's reader.
#include "toolchain/asm/symbol_file.hpp"

#include <gtest/gtest.h>

#include "host_sim/image/symbols.hpp"
#include "support.hpp"

namespace {

using namespace asm_test;
using namespace toolchain::assembly;

TEST(SymbolFile, ByHand) {
    LinkOptions options = rooted({"_Z5drivei"});
    const Program program = linked(R"(SECTION drive,code,TITLE 'drive(int)'
_Z5drivei: LDA slot
.loop:  JMP .loop
inner:  LDA word
        SECTION slot,frame
slot:   DS 1
        SECTION word,zero
word:   DS 2
)",
                                   options);
    EXPECT_EQ(symbol_file(program),
              "0000 0009 F drive(int) @ t.s85:2\n"
              "0006 0000 L inner @ t.s85:4\n"
              "8000 0001 L slot @ t.s85:6\n"
              "8001 0002 D word @ t.s85:8\n"
              "0000 0003 L - @ t.s85:2\n"
              "0003 0003 L - @ t.s85:3\n"
              "0006 0003 L - @ t.s85:4\n");
    const auto symbols = host_sim::read_symbols(symbol_file(program), "test");
    EXPECT_EQ(symbols.describe(0x0001), "drive(int)+1");
    EXPECT_EQ(symbols.source_at(0x0004)->source_line, 3u);
}

TEST(SymbolFile, TitlesThatOccurTwiceGiveWayToNames) {
    const Program program =
        linked("SECTION x,code,TITLE 'T::T()'\nC1: RET\nSECTION y,code,TITLE 'T::T()'\nC2: RET\n",
               rooted({"C1", "C2"}));
    const auto symbols = host_sim::read_symbols(symbol_file(program), "test");
    EXPECT_EQ(symbols.describe(0), "C1");
    EXPECT_EQ(symbols.describe(1), "C2");
}

TEST(SymbolFile, OverlaidFramesAreReadable) {
    const Program program = linked(
        "SECTION f,code\nf: LHLD p\nLHLD q\nSECTION f1,frame\np: DS 4\nSECTION f2,frame\nq: DS 2\n",
        rooted({"f"}));
    EXPECT_NO_THROW((void)host_sim::read_symbols(symbol_file(program), "test"));
}

}  // namespace
