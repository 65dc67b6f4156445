// show_commands_test.cpp - registers, memory, listings and stack as text; changes by hand.
#include "tests/tools/debug/bench.hpp"
#include "tools/debug/commands.hpp"

namespace debug_console {
namespace {

using debug_test::Bench;
using testing::HasSubstr;
using testing::StartsWith;

TEST(ShowCommands, RegistersShowEverythingOfTheProcessor) {
    Bench bench;
    bench("tbreak call");
    bench("c");
    bench("set A 0A3H");
    bench("set F 54H");
    EXPECT_EQ(bench("registers"),
              "PC 0126H main+38  SP 0000H\n"
              "A 0A3H  BC 0000H  DE 0000H  HL 0150H\n"
              "F 54H: S0 Z1 K0 AC1 P1 V0 CY0\n"
              "IE 1, masked 6.5 5.5, pending 5.5\n"
              "pins TRAP 0, RST 7.5 1, RST 6.5 0, RST 5.5 1, SID 0, SOD 0\n"
              "T 164 (0.053 ms), 20 instructions\n");
}

TEST(ShowCommands, SetChangesRegistersAndSaysWhatItCannot) {
    Bench bench;
    bench("set HL main+3");
    EXPECT_EQ(bench("print HL"), "259 = 0103H main+3\n");
    bench("set CY = 1");
    EXPECT_EQ(bench("print CY"), "1 = 01H\n");
    EXPECT_EQ(bench("set A 100H"), "refused: 256 does not fit: A holds 0 to 255");
    EXPECT_EQ(bench("set X 1"), "refused: X: no register; memory is changed with `poke`");
    EXPECT_EQ(bench("set T 1"), "refused: T cannot be set");
    EXPECT_EQ(bench("set A"), "refused: VALUE is missing");
    EXPECT_EQ(bench("print 0-1"), "-1\n");
    EXPECT_EQ(bench("print 10000H"), "65536\n");
    EXPECT_EQ(bench("print"), "refused: VALUE is missing");
}

TEST(ShowCommands, DisassembleShowsLabelsTStatesAndMarks) {
    Bench bench;
    bench("break call");
    bench("c");
    EXPECT_EQ(bench("disassemble call 3"),
              "call:\n"
              ">* 0126  CD 2D 01  CALL print                  18 T\n"
              "loop:\n"
              "   0129  76        HLT                          5 T\n"
              "   012A  C3 29 01  JMP main+41                 10 T\n");
    EXPECT_EQ(bench("d"),
              "print:\n"
              "   012D  7E        MOV A,M                      7 T\n"
              "   012E  B7        ORA A                        4 T\n"
              "   012F  C8        RZ                        6/12 T\n"
              "wait:\n"
              "   0130  DB 09     IN 09H                      10 T\n"
              "   0132  E6 01     ANI 01H                      7 T\n"
              "   0134  CA 30 01  JZ print+3                7/10 T\n"
              "   0137  7E        MOV A,M                      7 T\n"
              "   0138  D3 08     OUT 08H                     10 T\n")
        << "goes on behind the last listing";
}

TEST(ShowCommands, MemoryShowsBytesAndCharacters) {
    Bench bench;
    bench("poke 8000H \"Rover\" 0 7FH 0x41");
    EXPECT_EQ(bench("memory 8000H 9"),
              "8000  52 6F 76 65 72 00 7F 41 00                       Rover..A.\n");
    EXPECT_EQ(bench("memory 8000H..8001H"),
              "8000  52 6F                                            Ro\n");
    const std::string more = bench("m");
    EXPECT_EQ(more, bench("memory 8002H")) << "goes on behind the last one";
    EXPECT_THAT(bench("memory 0FFFEH"), HasSubstr("FFFE  00 00  "));
    EXPECT_THAT(bench("m"), StartsWith("0000  C3 00 01 ")) << "wraps";
}

TEST(ShowCommands, PokeReachesRamAndEeprom) {
    Bench bench;
    bench("poke 7FFFH 11H 22H");
    EXPECT_EQ(bench.session.board.state.memory.bytes[0x7FFF], 0x11);
    EXPECT_EQ(bench.session.board.state.eeprom.data()[0x7FFF], 0x11);
    EXPECT_EQ(bench.session.board.state.memory.bytes[0x8000], 0x22);
    EXPECT_EQ(bench("poke 8000H 256"), "refused: 256 is 256; BYTE is from 0 to 255");
    EXPECT_EQ(bench("poke 8000H"), "refused: BYTE is missing");
    EXPECT_EQ(bench("poke 0FFFFH 1 2"), "refused: 10000H: no memory there; nothing was changed");
    EXPECT_EQ(bench.session.board.state.memory.bytes[0xFFFF], 0);
    host_sim::BoardOptions options;
    options.memory_map.ram_last = 0x87FF;
    Bench small(debug_test::kProgram, options);
    EXPECT_EQ(small("poke 8800H 1"), "refused: 8800H: no memory there; nothing was changed");
}

TEST(ShowCommands, StackAndWhereNameTheCallers) {
    Bench bench;
    bench("tbreak wait");
    bench("c");
    EXPECT_EQ(bench("where"),
              "#0  0130H print+3\n"
              "#1  012DH print called from 0126H main+38\n");
    EXPECT_EQ(bench("stack"), "FFFE  0129H main+41\n");
    EXPECT_EQ(bench("stack 5"), "FFFE  0129H main+41\n") << "the address space ends";
    bench("poke 9000H 34H 12H");
    bench("set SP 9000H");
    EXPECT_THAT(bench("stack 2"), StartsWith("9000  1234H text+4324"));
    EXPECT_EQ(bench("bt"), "#0  0130H print+3\n");
}

TEST(ShowCommands, WhereTellsInterruptsAndGuesses) {
    Bench bench;
    bench("break tick");
    bench("c");
    EXPECT_EQ(bench("where"),
              "#0  013EH tick\n"
              "#1  003CH by RST 7.5 at 012AH main+42\n");
    bench("delete all");
    bench("reset");
    bench("until +190");
    EXPECT_EQ(bench("where"),
              "#0  012FH print+2\n"
              "#1  012DH print perhaps called from 0126H main+38\n");
}

TEST(ShowCommands, SymbolsAreListed) {
    Bench bench;
    EXPECT_EQ(bench("symbols PRI"), "012D  print\n");
    EXPECT_EQ(bench("symbols zzz"), "no symbol has that in its name\n");
    EXPECT_THAT(bench("symbols"), HasSubstr("013E  tick\n"));
}

TEST(ShowCommands, ChipsAreListedAndShown) {
    Bench bench;
    bench("until 200");
    EXPECT_THAT(bench("chips"), StartsWith("usart     8251A at 08H: telemetry and command link\n"));
    EXPECT_THAT(bench("chips usart"), HasSubstr("  command: 05h\n"));
    EXPECT_THAT(bench("chips watchdog"),
                StartsWith("watchdog: one-shot on SOD\n  output: quiet, fires at T 1536"));
    EXPECT_THAT(bench("chips all"), HasSubstr("motors: motor latches at 30H\n"));
    EXPECT_EQ(bench("chips 6502"), "refused: 6502: no such chip; `chips` lists them");
}

TEST(ShowCommands, ViolationsAreCounted) {
    Bench bench("        OUT 0F0H\n        STA 4000H\nhere:   JMP here\n");
    EXPECT_EQ(bench("violations"), "0 violation(s)\n");
    bench("step");
    EXPECT_EQ(bench("violations"),
              "1 violation(s)\n"
              "first: OUT 0F0H of 00H to no chip, by 0000H at T 10 (0.003 ms)\n");
    bench("step");
    EXPECT_EQ(bench("violations"),
              "2 violation(s)\n"
              "first: OUT 0F0H of 00H to no chip, by 0000H at T 10 (0.003 ms)\n"
              "last:  write of 00H to 4000H here+16379 that the EEPROM ignored, by 0002H at T 23 "
              "(0.007 ms)\n");
}

}  // namespace
}  // namespace debug_console
