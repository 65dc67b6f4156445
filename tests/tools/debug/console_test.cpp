// console_test.cpp - lines, scripts, abbreviations, prompt, errors.
#include "tools/debug/console.hpp"

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "tests/tools/debug/bench.hpp"

namespace debug_console {
namespace {

using debug_test::Bench;
using testing::HasSubstr;
using testing::StartsWith;

std::string refusal(Console& console, const std::string& script) {
    std::istringstream input(script);
    try {
        console.run_script(input, "boot.rb85");
    } catch (const DebugError& error) {
        return error.what();
    }
    return "";
}

TEST(Console, CommandsMayBeShortened) {
    Bench bench;
    EXPECT_EQ(bench.console.find_command("s").name, "step");
    EXPECT_EQ(bench.console.find_command("STEP").name, "step");
    EXPECT_EQ(bench.console.find_command("reg").name, "registers");
    EXPECT_EQ(bench.console.find_command("u").name, "until") << "an alias wins";
    EXPECT_EQ(bench.console.find_command("snapshot").name, "snapshot") << "not snapshots";
    EXPECT_EQ(bench("re"), "refused: re: could be registers reset restore; write more of it");
    EXPECT_EQ(bench("fly"), "refused: fly: no such command; `help` lists them");
}

TEST(Console, EmptyLinesAndCommentsDoNothing) {
    Bench bench;
    EXPECT_EQ(bench(""), "");
    EXPECT_EQ(bench("   # step 5"), "");
    EXPECT_EQ(bench.t(), 0u);
    EXPECT_EQ(bench("echo after  the boot # really"), "after  the boot\n");
    EXPECT_EQ(bench(R"(echo "tab\there # too")"), "tab\there # too\n");
}

TEST(Console, EveryCommandRefusesWordsBehindItsArguments) {
    for (const char* line : {"step 1 2",        "over x",           "finish x",
                             "until +5 x",      "continue x",       "goto 0 x",
                             "break 0 x",       "ignore 1 2 3",     "registers x",
                             "set A 1 2",       "memory 0 1 2",     "disassemble 0 1 2",
                             "stack 1 2",       "where x",          "symbols a b",
                             "chips usart x",   "violations x",     "serial hex x",
                             "sensor 1 uv 1 2", "tach 1 2 3 4",     "detectors 1 2",
                             "service on x",    "trap bumper on x", "reset x",
                             "power x",         "snapshot a b",     "snapshots x",
                             "diff a b",        "source a b",       "help step x",
                             "quit x"}) {
        Bench bench;
        bench("break 100H");
        bench("snapshot a");
        EXPECT_THAT(bench(line), StartsWith("refused: ")) << line;
        EXPECT_EQ(bench.t(), 0u) << line;
        EXPECT_FALSE(bench.console.finished());
    }
}

TEST(Console, AScriptStopsAtItsFirstErrorAndNamesTheLine) {
    Bench bench;
    EXPECT_EQ(refusal(bench.console, "# boot\n\nstep\nbreak nowhere\nstep\n"),
              "boot.rb85:4: nowhere: no number, register or symbol (`symbols` lists those loaded)");
    EXPECT_EQ(bench.t(), 10u);
    EXPECT_EQ(refusal(bench.console, "step\nquit\nnonsense\n"), "");
    EXPECT_TRUE(bench.console.finished());
}

TEST(Console, AnInterruptedRunEndsTheScript) {
    Bench bench("here:   JMP here\n");
    bench.session.interrupted = [asked = 0]() mutable { return ++asked == 3; };
    EXPECT_EQ(refusal(bench.console, "step\ncontinue\nstep\n"),
              "boot.rb85:2: interrupted; the rest was not run");
}

TEST(Console, ScriptsMayNestButNotForEver) {
    Bench bench;
    std::string name = (std::filesystem::temp_directory_path() / "debug_script_XXXXXX").string();
    const int file = mkstemp(name.data());
    ASSERT_GE(file, 0);
    std::ofstream(name) << "echo inner\nfly\n";
    EXPECT_EQ(bench("source " + name),
              "refused: " + name + ":2: fly: no such command; `help` lists them");
    EXPECT_EQ(refusal(bench.console, "source \"" + name + "\"\n"),
              "boot.rb85:1: " + name + ":2: fly: no such command; `help` lists them");
    std::ofstream(name) << "source " << name << "\n";
    EXPECT_THAT(bench("source " + name), HasSubstr("nested more than 16 deep"));
    std::ofstream(name) << "step\n";
    EXPECT_THAT(bench("source " + name), HasSubstr("T 10 ")) << "the depth is counted back";
    std::filesystem::remove(name);
    EXPECT_EQ(bench("source " + name), "refused: " + name + ": cannot be read; check the path");
}

TEST(Console, InteractivePromptsRepeatsAndGoesOnAfterErrors) {
    Bench bench;
    std::ostringstream out;
    Session& session = bench.session;
    Console console(session, out);
    std::istringstream input("step\n\nfly\n\nquit\nstep\n");
    console.interact(input);
    EXPECT_EQ(session.board.state.cpu.t, 20u) << "the empty line repeated step";
    EXPECT_EQ(out.str(),
              "rb85> T 10 (0.003 ms), +10\n"
              ">  0100  31 00 00  LXI SP,0000H                10 T  main\n"
              "rb85> T 20 (0.007 ms), +10\n"
              ">  0103  3E 34     MVI A,34H                    7 T  main+3\n"
              "rb85> fly: no such command; `help` lists them\n"
              "rb85> fly: no such command; `help` lists them\n"
              "rb85> ");
    std::istringstream ended("step\n");
    Console other(session, out);
    other.interact(ended);
    EXPECT_FALSE(other.finished()) << "the end of the input leaves, too";
}

TEST(Console, HelpListsAndExplains) {
    Bench bench;
    EXPECT_THAT(bench("help"), HasSubstr("step (s)         execute instructions, one or COUNT\n"));
    EXPECT_EQ(bench("help goto"),
              "goto ADDRESS\nset PC; executes nothing\nAlso ends HALT.\n"
              "  goto main\n  goto $+3\n");
    EXPECT_THAT(bench("help fly"), StartsWith("refused: "));
}

TEST(Console, ACtrlCBeforeACommandIsNotForIt) {
    Bench bench("here:   JMP here\n");
    bool pressed = true;
    bench.session.interrupted = [&pressed] { return std::exchange(pressed, false); };
    EXPECT_THAT(bench("until 1000000"), StartsWith("T 1000000 "));
}

}  // namespace
}  // namespace debug_console
