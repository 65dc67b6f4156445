// listing_test.cpp - a small listing, letter by letter. Bytes and T-states from Intel's table.
#include "toolchain/asm/listing.hpp"

#include <gtest/gtest.h>

#include "support.hpp"

namespace {

using namespace asm_test;
using namespace toolchain::assembly;

TEST(Listing, ByHand) {
    const Program program = linked(R"(SECTION f,code,TITLE 'f(int)'
f:      LDA slot
.loop:  DCR A           ;@loop 3
        JNZ .loop
        RET
        SECTION slot,initialised
slot:   DB 1,'abcde'
more:   DS 2
)",
                                   rooted({"f"}));
    const SourceText source = [](const std::string&, uint32_t line) -> std::string {
        return line == 3 ? "    --a;" : "";
    };
    EXPECT_EQ(listing(program, source),
              R"(; T: T-states; of a conditional instruction not taken/taken
; addr bytes          T  instruction

; code f, 0000H, 8 bytes; f(int)
                           ; t.s85:2
0000                       f:
0000  3A 00 80       13      LDA   slot
                           ; t.s85:3  --a;
0003                       .loop:
                           ;@loop 3
0003  3D              4      DCR   A
                           ; t.s85:4
0004  C2 03 00     7/10      JNZ   .loop
                           ; t.s85:5
0007  C9             10      RET

; initialised slot, 8000H, 8 bytes, in ROM at 0008H
                           ; t.s85:7
8000                       slot:
8000  01                     DB    01H
8001  61 62 63 64            DB    61H,62H,63H,64H
8005  65                     DB    65H
                           ; t.s85:8
8006                       more:
8006                         DS    2
)");
}

TEST(Listing, ReadsSourceFiles) {
    const SourceText source = source_files();
    const std::string here = ROVER_SOURCE_DIR "/tests/toolchain/asm/listing_test.cpp";
    EXPECT_EQ(source(here, 2), "#include \"toolchain/asm/listing.hpp\"");
    EXPECT_EQ(source(here, 0), "");
    EXPECT_EQ(source(here, 100000), "");
    EXPECT_EQ(source("no such file", 1), "");
}

}  // namespace
