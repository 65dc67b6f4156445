// map_file_test.cpp - the form of docs/spec/map.md. T-states from Intel's table, added by hand.
#include "toolchain/asm/map_file.hpp"

#include <gtest/gtest.h>

#include "support.hpp"

namespace {

using namespace asm_test;
using namespace toolchain::assembly;

TEST(MapFile, ByHand) {
    LinkOptions options = rooted({"f", "g"});
    options.rom = {0x0000, 0x00FF};
    options.ram = {0x8000, 0x80FF};
    options.stack_size = 16;
    const Program program = linked(R"(SECTION f,code,FUNCTION f,TITLE 'f(int)'
f:      LDA slot
        MOV B,A
        RET
        SECTION f.table,constant,FUNCTION f
table:  DS 4
        SECTION f.frame,frame,FUNCTION f
slot:   DS 2
        SECTION g,code
g:      ;@t 30 to 44
        ;@stack 2
.loop:  DCR B           ;@loop 3
        JNZ .loop
        LXI H,table
        LHLD v
        RET
        SECTION v,initialised
v:      DW 7
)",
                                   options);
    EXPECT_EQ(map_file(program), R"(# rover85 map 1
range ROM 0000 00FF used 22 free 234
range RAM 8000 80FF used 20 free 236
region frames 8000 0002
region data 8002 0002
region image 0014 0002
region zero 8000 0000
region stack 80F0 0010
section 0000 0005 code 0000 f
section 0005 0004 constant 0005 f.table
section 0009 000B code 0009 g
section 8000 0002 frame 8000 f.frame
section 8002 0002 initialised 0014 v
function 0000 rom 9 ram 2 t 27 27 stack - f(int)
function 0009 rom 11 ram 0 t 30 44 stack 2 g
note 0009 t 30 to 44
note 0009 stack 2
note 0009 loop 3
)");  // f: LDA 13, MOV 4, RET 10
}

TEST(MapFile, OnlyStraightCodeHasAnExactTime) {
    const auto straight = [](std::string_view source) {
        return straight_t_states(module_of(source).sections.at(0));
    };
    EXPECT_EQ(straight("x: PUSH B\nPOP B\nRET\n"), 32u);  // 12+10+10
    EXPECT_EQ(straight("PUSH B\n"), std::nullopt);        // goes on behind its end
    EXPECT_EQ(straight("RNZ\nRET\n"), std::nullopt);
    EXPECT_EQ(straight("CALL x\nRET\n"), std::nullopt);
    EXPECT_EQ(straight("RET\nNOP\n"), std::nullopt);
    EXPECT_EQ(straight("SECTION x,constant\nDB 0C9H\n"), std::nullopt);
}

TEST(MapFile, RoutinesOfASectionAreTakenTogether) {
    const Module module =
        parse("SECTION u,code\n;   t 20 to 30\nf: RNZ\nRET\n;   t 10 to 12\ng: RET\n",
              {"u.s85", {}, true});
    const auto functions = function_sizes(link({module}, rooted({"f"})));
    ASSERT_EQ(functions.size(), 1u);
    EXPECT_EQ(functions[0].t_states, (TStates{10, 30}));
    EXPECT_EQ(functions[0].rom_bytes, 3u);
}

}  // namespace
