// run_commands_test.cpp - what running and breakpoint commands print, exact to the T-state.
#include "tests/tools/debug/bench.hpp"
#include "tools/debug/commands.hpp"

namespace debug_console {
namespace {

using debug_test::Bench;
using testing::HasSubstr;
using testing::StartsWith;

TEST(RunCommands, StepShowsTimeAndTheNextInstruction) {
    Bench bench;
    EXPECT_EQ(bench("step"),
              "T 10 (0.003 ms), +10\n"
              ">  0100  31 00 00  LXI SP,0000H                10 T  main\n");
    EXPECT_EQ(bench("step 3"),
              "T 37 (0.012 ms), +27\n"
              ">  0107  3E 00     MVI A,00H                    7 T  main+7\n");
    EXPECT_THAT(bench("step 0"), StartsWith("refused: 0 is 0; COUNT is from 1"));
}

TEST(RunCommands, BreakAndContinue) {
    Bench bench;
    EXPECT_EQ(bench("break print if M == 'O'"), "breakpoint 1: 012DH print if M == 'O'\n");
    EXPECT_EQ(bench("continue"),
              "breakpoint 1: 012DH print if M == 'O'\n"
              "T 182 (0.059 ms), +182\n"
              ">* 012D  7E        MOV A,M                      7 T  print\n");
    EXPECT_EQ(bench("break"), "1: 012DH print if M == 'O', 1 hit(s)\n");
    bench("tbreak loop");
    bench("disable 1");
    bench("ignore 1 3");
    EXPECT_EQ(bench("break"),
              "1: 012DH print if M == 'O', 1 hit(s), disabled, ignores 3 more\n"
              "2: 0129H main+41, 0 hit(s), temporary\n");
    EXPECT_THAT(bench("c"), StartsWith("serial T "));
    EXPECT_EQ(bench.pc(), bench.symbol("loop"));
    EXPECT_EQ(bench("break"), "1: 012DH print if M == 'O', 1 hit(s), disabled, ignores 3 more\n");
    bench("enable 1");
    bench("delete 1");
    EXPECT_EQ(bench("break"), "no breakpoints\n");
    EXPECT_EQ(bench("delete 7"), "refused: no breakpoint 7; `break` lists them");
}

TEST(RunCommands, BreakpointsOfEveryKindAreMade) {
    Bench bench;
    EXPECT_EQ(bench("break port 08H out if A == 'K'"), "breakpoint 1: port 08H out if A == 'K'\n");
    EXPECT_EQ(bench("break port 9 in"), "breakpoint 2: port 09H in\n");
    EXPECT_EQ(bench("break port 9"), "breakpoint 3: port 09H\n");
    EXPECT_EQ(bench("break write count..8010H"), "breakpoint 4: write 8000H count to 8010H\n");
    EXPECT_EQ(bench("break access 9000H"), "breakpoint 5: access 9000H count+4096\n");
    EXPECT_EQ(bench("break read 8001H"), "breakpoint 6: read 8001H count+1\n");
    EXPECT_EQ(bench("break interrupt 7.5"), "breakpoint 7: RST 7.5\n");
    EXPECT_EQ(bench("tbreak interrupt any"), "breakpoint 8: any interrupt\n");
    EXPECT_EQ(bench("break interrupt rst85"),
              "refused: rst85: no interrupt of this board; use trap, rst75, rst65, rst55 or any");
    EXPECT_THAT(bench("break port 256"), StartsWith("refused: 256 is 256; PORT is from 0 to 255"));
    EXPECT_THAT(bench("break write 9000H..8000H"), StartsWith("refused: "));
    EXPECT_THAT(bench("break print unless A"), StartsWith("refused: "));
    EXPECT_THAT(bench("break if A == 1"), StartsWith("refused: "));
    bench("c");
    EXPECT_EQ(bench("print A"), "78 = 4EH\n") << "the first one to hit was OUT 09H, the mode";
}

// The printer sends O, K and a line feed; the condition finds the second one.
TEST(RunCommands, APortConditionFindsTheCharacter) {
    Bench bench;
    bench("break port 08H out if A == 'K'");
    const std::string output = bench("continue");
    EXPECT_THAT(output, StartsWith("breakpoint 1: OUT 08H of 4BH by 0138H print+11\n"));
    EXPECT_EQ(bench("print HL-text"), "1 = 01H\n");
}

TEST(RunCommands, UntilStopsAtTheFirstBoundary) {
    Bench bench;
    EXPECT_THAT(bench("until 30"), StartsWith("T 37 (0.012 ms), +37\n"));
    EXPECT_THAT(bench("until +1"), StartsWith("T 44 (0.014 ms), +7\n"));
    EXPECT_EQ(bench("until 44"),
              "refused: T 44 is not ahead: it is T 44 now; +TIME counts from here");
    bench("until 1ms");
    EXPECT_GE(bench.t(), 3072u);
    EXPECT_THAT(bench("until main"), StartsWith("refused: main: not a time"));
    EXPECT_THAT(bench("until"), "refused: TIME is missing");
}

TEST(RunCommands, OverAndFinish) {
    Bench bench;
    bench("tbreak call");
    bench("c");
    EXPECT_THAT(bench("over"), HasSubstr(">  0129  76        HLT                          5 T"));
    bench("reset");
    bench("tbreak wait");
    bench("c");
    EXPECT_THAT(bench("finish"), HasSubstr(">  0129  76        HLT"));
}

TEST(RunCommands, GotoSetsPcAndExecutesNothing) {
    Bench bench;
    EXPECT_EQ(bench("goto print+1"), ">  012E  B7        ORA A                        4 T\n");
    EXPECT_EQ(bench.t(), 0u);
    EXPECT_EQ(bench("goto $-1"), ">  012D  7E        MOV A,M                      7 T\n");
}

TEST(RunCommands, WatchdogResetsAreTold) {
    Bench bench("here:   JMP here\n");
    // 0.5 s of silence are 1,536,000 T.
    EXPECT_THAT(bench("until 600ms"), StartsWith("the board was reset 1 time(s) on the way; the "
                                                 "watchdog has fired 1 time(s)\n"));
}

TEST(RunCommands, HaltIsTold) {
    Bench bench;
    EXPECT_THAT(bench("until 20000"), HasSubstr(", in HALT\n"));
}

}  // namespace
}  // namespace debug_console
