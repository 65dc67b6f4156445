// What i85cc refuses: one clear message with file and line, exit code 1, no files.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "toolchain/driver/process.hpp"
#include "toolchain/driver/work_folder.hpp"

namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using toolchain::driver::Command;
using toolchain::driver::Outcome;

struct Refusal {
    const char* name;
    const char* file;
    std::string text;
    std::vector<std::string> pieces;  ///< of the message
    std::vector<std::string> options{};
};

void PrintTo(const Refusal& refusal, std::ostream* stream) {
    *stream << refusal.name;
}

std::set<std::string> names_in(const fs::path& folder) {
    std::set<std::string> names;
    for (const auto& entry : fs::directory_iterator(folder)) {
        names.insert(entry.path().filename().string());
    }
    return names;
}

/// Runs i85cc in a folder.
Outcome run_in(const fs::path& folder, const std::vector<std::string>& arguments) {
    const toolchain::driver::WorkFolder logs;
    Command command{{"env", "-C", folder.string(), I85CC_PROGRAM}, logs.path() / "log"};
    command.arguments.insert(command.arguments.end(), arguments.begin(), arguments.end());
    const std::vector<Command> commands = {command};
    return toolchain::driver::run_all(commands, 1).at(0);
}

class Refusals : public testing::TestWithParam<Refusal> {};

TEST_P(Refusals, AreOneMessageAndNoFiles) {
    const Refusal& refusal = GetParam();
    const toolchain::driver::WorkFolder folder;
    std::ofstream(folder.path() / refusal.file) << refusal.text;
    std::vector<std::string> arguments = refusal.options;
    arguments.insert(arguments.end(), {"-o", "out.hex", refusal.file});
    const Outcome outcome = run_in(folder.path(), arguments);
    EXPECT_EQ(outcome.exit_code, 1);
    EXPECT_EQ(outcome.signal, 0);
    EXPECT_THAT(outcome.messages, HasSubstr("i85cc: "));
    for (const std::string& piece : refusal.pieces) EXPECT_THAT(outcome.messages, HasSubstr(piece));
    EXPECT_EQ(names_in(folder.path()), std::set<std::string>{refusal.file});
}

const std::string kMain = "int main(void) { return 0; }\n";
const std::string kUseF = "int main(void) { return f(1) > 1; }\n";

INSTANTIATE_TEST_SUITE_P(
    FrontEnd, Refusals,
    testing::Values(
        Refusal{"SyntaxError",
                "a.c",
                "int main(void) {\n  return 0\n}\n",
                {"a.c:2:11: error: expected ';' after return statement",
                 "i85cc: a.c: not compiled: see the messages above"}},
        Refusal{"ThreadLocal",
                "a.c",
                "_Thread_local int t;\n" + kMain,
                {"a.c:1:1: error: thread-local storage is not supported"}},
        Refusal{"Exception",
                "a.cpp",
                "int main() {\n  throw 1;\n}\n",
                {"a.cpp:2:3: error: cannot use 'throw' with exceptions disabled"}},
        Refusal{"RunTimeTypes",
                "a.cpp",
                "struct A { virtual void f(); };\nstruct B : A {};\n"
                "B* g(A* a) { return dynamic_cast<B*>(a); }\nint main() {}\n",
                {"a.cpp:3:21: error: use of dynamic_cast requires -frtti"}},
        Refusal{"InterruptWithParameters",
                "a.c",
                "#include <i85.h>\nI85_INTERRUPT(I85_TRAP) void f(int a) { (void)a; }\n" + kMain,
                {"a.c:2:30: error: ",
                 "'interrupt' attribute only applies to functions that have no "
                 "parameters"}},
        Refusal{"MissingHeader",
                "a.c",
                "#include <stdio.h>\n" + kMain,
                {"a.c:1:10: fatal error: 'stdio.h' file not found"}}),
    [](const auto& test) { return test.param.name; });

INSTANTIATE_TEST_SUITE_P(
    Names, Refusals,
    testing::Values(
        Refusal{"UndefinedFunction",
                "a.c",
                "int f(int);\nint main(void) {\n  return f(1);\n}\n",
                {"i85cc: a.c:3: 'f' is used but not defined: add the source that defines it"}},
        Refusal{"UndefinedVariable",
                "a.cpp",
                "namespace n { extern int v; }\nint main() {\n  return n::v;\n}\n",
                {"i85cc: a.cpp:3: 'n::v' is used but not defined"}},
        Refusal{
            "Heap",
            "a.cpp",
            "int* volatile p;\nint main() {\n  p = new int;\n}\n",
            {"i85cc: a.cpp:3: 'operator new(unsigned int)' is used but not defined: there is no "
             "heap: use objects with static storage"}},
        Refusal{"Atomic",
                "a.c",
                "_Atomic int x;\nint main(void) {\n  return x;\n}\n",
                {"i85cc: a.c:3: '__atomic_load' is used but not defined: there are no atomic "
                 "operations"}},
        Refusal{"NoMain",
                "a.c",
                "int f(void) { return 0; }\n",
                {"i85cc: no source defines 'main': it is where the program starts"}},
        Refusal{"KeepOfNothing",
                "a.c",
                kMain,
                {"i85cc: 'f' is to be kept, but no source defines it: check the name"},
                {"--keep", "f"}},
        Refusal{"NoSuchVector",
                "a.c",
                "#include <i85.h>\n\nI85_INTERRUPT(4) void f(void) {}\n" + kMain,
                {"i85cc: a.c:3: 'f': the 8085 has no interrupt at 04H"}},
        Refusal{"OneVectorTwice",
                "a.c",
                "#include <i85.h>\nI85_INTERRUPT(I85_TRAP) void f(void) {}\n"
                "I85_INTERRUPT(I85_TRAP) void g(void) {}\n" +
                    kMain,
                {"i85cc: a.c:3: 'f' and 'g' both serve the interrupt at 24H: keep one"}},
        Refusal{"CallOfAnInterruptFunction",
                "a.c",
                "#include <i85.h>\nI85_INTERRUPT(I85_TRAP) void f(void) {}\n"
                "int main(void) {\n  f();\n}\n",
                {"i85cc: a.c:4: the interrupt function 'f' is called"}},
        Refusal{"Constructor",
                "a.cpp",
                "int f();\nint f() { return *(volatile int*)0x8000; }\nstruct A { int n = f(); };\n"
                "A object;\nint main() { return object.n; }\n",
                {"i85cc: a.cpp:4: 'object' is constructed at run time, and --no-constructors "
                 "forbids it: make it constinit"},
                {"--no-constructors"}}),
    [](const auto& test) { return test.param.name; });

// At -O0 the optimiser removes nothing before it is seen.
INSTANTIATE_TEST_SUITE_P(
    Language, Refusals,
    testing::Values(
        Refusal{"Double",
                "a.c",
                "double f(double x) {\n  return x * 2;\n}\n" + kUseF,
                {"i85cc: a.c:", "in f: floating point: the 8085 has none; use a Q format"},
                {"-O0"}},
        Refusal{"FloatVariable",
                "a.c",
                "float f = 1;\nint main(void) {\n  return f > 0;\n}\n",
                {"a.c:3: in main: floating point"},
                {"-O0"}},
        Refusal{"VariableArguments",
                "a.c",
                "#include <stdarg.h>\nint f(int n, ...) {\n  va_list a;\n  va_start(a, n);\n"
                "  return va_arg(a, int);\n}\nint main(void) { return f(1, 2); }\n",
                {"i85cc: a.c:2: in f: a variable argument list",
                 "a.c:7: in main: a call with a "
                 "variable number of arguments"}},
        Refusal{"VariableSize",
                "a.c",
                "volatile int n;\nint main(void) {\n  volatile char a[n];\n  a[0] = 1;\n"
                "  return a[0];\n}\n",
                {"i85cc: a.c:3: in main: a variable whose size is known only at run time"}},
        Refusal{"Alloca",
                "a.c",
                "volatile int n;\nint main(void) {\n  volatile char* a = __builtin_alloca(n);\n"
                "  a[0] = 1;\n  return a[0];\n}\n",
                {"i85cc: a.c:3: in main: a variable whose size is known only at run time"}},
        Refusal{"InlineAssembly",
                "a.c",
                "int main(void) {\n  __asm__(\"nop\");\n}\n",
                {"i85cc: a.c:2: in main: inline assembly: use the functions of i85.h"}},
        Refusal{"AssemblyOutside",
                "a.c",
                "__asm__(\"nop\");\n" + kMain,
                {"i85cc: a.c: assembly outside of functions is not supported"}},
        Refusal{"ComputedGoto",
                "a.c",
                "volatile int n;\nint main(void) {\n  void* p = n ? &&a : &&b;\n  goto *p;\na:\n  "
                "return 1;\n"
                "b:\n  return 2;\n}\n",
                {"i85cc: a.c:", "in main: a computed goto: use a switch"},
                {"-O0"}},
        Refusal{"Vector",
                "a.c",
                "typedef int V __attribute__((vector_size(8)));\nvolatile V v;\n"
                "int main(void) {\n  v = v + v;\n  return v[0];\n}\n",
                {"a.c:4: in main: a vector"}},
        Refusal{"AtomicUpdate",
                "a.c",
                "char c;\nint main(void) {\n  return __sync_fetch_and_add(&c, 1);\n}\n",
                {"i85cc: a.c:3: in main: an atomic read-modify-write: disable interrupts around "
                 "it"}},
        Refusal{"PortFromAVariable",
                "a.c",
                "#include <i85.h>\nvolatile unsigned char p;\nint main(void) {\n"
                "  __i85_out(p, 1);\n}\n",
                {"i85cc: a.c:4: in main: a port number must be known at compile time"}},
        Refusal{"LoopBoundOutside",
                "a.c",
                "#include <i85.h>\nint main(void) {\n  I85_LOOP_BOUND(3);\n}\n",
                {"i85cc: a.c:3: in main: __i85_loop_bound is not in a loop"}},
        Refusal{"FrameAddress",
                "a.c",
                "int main(void) {\n  return (int)__builtin_frame_address(0);\n}\n",
                {"i85cc: a.c:", "no built-in function of another processor"}}),
    [](const auto& test) { return test.param.name; });

INSTANTIATE_TEST_SUITE_P(
    CallsAndMemory, Refusals,
    testing::Values(
        Refusal{"Recursion",
                "a.c",
                "volatile int k;\nint f(int n) {\n  return n ? n * f(n - 1) + f(n - 2) : 1;\n}\n"
                "int main(void) { return f(k); }\n",
                {"recursion: f -> f (a.c:3): static frames hold one call at a time: make it a "
                 "loop, or use --allow-recursion"}},
        Refusal{"MutualRecursion",
                "a.c",
                "int odd(int n);\nint even(int n) { return n ? odd(n - 1) : 1; }\n"
                "int odd(int n) {\n  return n ? even(n - 1) : 0;\n}\n"
                "int main(void) { return even(7); }\n",
                {"recursion: even -> odd (a.c:2) -> even (a.c:4): "},
                {"-O0"}},
        Refusal{"RecursionThroughAPointer",
                "a.c",
                "int (*volatile p)(int);\nint f(int n) {\n  return n ? p(n - 1) : 3;\n}\n"
                "int main(void) {\n  p = f;\n  return f(4);\n}\n",
                {"recursion: f -> f (a.c:3, through a pointer): "}},
        Refusal{"RomIsFull",
                "a.c",
                "const char x[40000] = {1};\nvolatile int k;\nint main(void) { return x[k]; }\n",
                {"i85cc: ROM: ", " there (0000H-7FFFH), 72", " too many; largest: x 40000, "}},
        Refusal{"RamIsFull",
                "a.c",
                "volatile char x[40000];\nint main(void) { return x[5]; }\n",
                {"i85cc: RAM: ", " there (8000H-FEFFH), 7", " too many; largest: x 40000, "}},
        Refusal{"NoRam",
                "a.c",
                "volatile char x[9];\nint main(void) { return x[5]; }\n",
                {"i85cc: RAM: ", "1 there (9000H-9000H), ", " too many; largest: x 9, "},
                {"--ram", "9000h-9000h"}},
        Refusal{"SmallStack",
                "a.c",
                "volatile int k;\n__attribute__((noinline)) void f(void) { k++; }\n"
                "int main(void) {\n  f();\n}\n",
                {"i85cc: the stack has 1 bytes, but calls and interrupts take up to ",
                 ": raise --stack, or leave it out"},
                {"--stack", "1"}},
        Refusal{"RangesOverlap",
                "a.c",
                kMain,
                {"i85cc: ROM 0000H-7FFFH and RAM 7FFFH-8FFFH overlap: correct --rom or --ram"},
                {"--ram", "7fffh-8fffh"}},
        Refusal{"TooLargeAnObject",
                "a.c",
                "char x[70000];\n" + kMain,
                {"a.c:1:8: error: array is too large"}}),
    [](const auto& test) { return test.param.name; });

// -- The command line and files ------------------------------------------------------------------

class Program : public testing::Test {
protected:
    Program() { std::ofstream(path() / "a.c") << kMain; }
    [[nodiscard]] const fs::path& path() const { return folder_.path(); }
    [[nodiscard]] Outcome run(const std::vector<std::string>& arguments) const {
        return run_in(path(), arguments);
    }

private:
    toolchain::driver::WorkFolder folder_;
};

TEST_F(Program, RefusesUnknownOptions) {
    const Outcome outcome = run({"--fast", "-o", "out.hex", "a.c"});
    EXPECT_EQ(outcome.exit_code, 1);
    EXPECT_EQ(outcome.messages, "i85cc: --fast: unknown option: see i85cc --help\n");
}

TEST_F(Program, RefusesTwoDefinitionsOfOneName) {
    const Outcome outcome = run({"-o", "out.hex", "a.c", "a.c"});
    EXPECT_EQ(outcome.exit_code, 1);
    EXPECT_EQ(outcome.messages,
              "i85cc: a.c: 'main' is defined in another source too: keep one definition\n");
}

TEST_F(Program, WritesFiveFilesOrNone) {
    EXPECT_EQ(run({"-o", "out.hex", "a.c"}).messages, "");
    EXPECT_EQ(names_in(path()), (std::set<std::string>{"a.c", "out.bin", "out.hex", "out.lst",
                                                       "out.map", "out.sym"}));
    fs::create_directory(path() / "other.lst");
    const Outcome outcome = run({"-o", "other.hex", "a.c"});
    EXPECT_EQ(outcome.exit_code, 1);
    EXPECT_EQ(outcome.messages,
              "i85cc: other.lst: cannot be written: it is a folder: choose "
              "another name\n");
    EXPECT_FALSE(fs::exists(path() / "other.hex"));
}

TEST_F(Program, WritesTheSameBytesEachTime) {
    std::ofstream(path() / "b.cpp")
        << "#include <string.h>\n#include <i85.h>\n"
           "static int f(int a) { return a * 3; }\nint v = f(__i85_in(1));\n"
           "char t[9];\nint main() { memset(t, v, 9); return t[3]; }\n";
    std::set<std::string> contents;
    for (const char* name : {"one", "two"}) {
        fs::create_directory(path() / name);
        EXPECT_EQ(run({"-o", name + std::string("/out.hex"), "b.cpp"}).messages, "");
        std::string all;
        for (const char* extension : {"hex", "bin", "map", "lst", "sym"}) {
            std::ifstream file(path() / name / (std::string("out.") + extension), std::ios::binary);
            all += std::string{std::istreambuf_iterator<char>(file), {}};
        }
        EXPECT_THAT(all, testing::Not(HasSubstr("/i85cc-")));  // no name of a temporary file
        contents.insert(all);
    }
    EXPECT_EQ(contents.size(), 1U);
}

TEST_F(Program, RefusesSourcesThatCannotBeRead) {
    const Outcome outcome = run({"-o", "out.hex", "b.c"});
    EXPECT_EQ(outcome.exit_code, 1);
    EXPECT_EQ(outcome.messages,
              "i85cc: b.c: cannot be read: No such file or directory: check the path\n");
}

TEST_F(Program, ExplainsItself) {
    const Outcome help = run({"--help"});
    EXPECT_EQ(help.exit_code, 0);
    EXPECT_THAT(help.messages, testing::StartsWith("i85cc [OPTIONS] -o OUT.hex SOURCES..."));
    const Outcome version = run({"--version"});
    EXPECT_EQ(version.exit_code, 0);
    EXPECT_THAT(version.messages, testing::MatchesRegex("i85cc [0-9]+\\.[0-9]+\\.[0-9]+\n"));
}

/// The text of the first block of that kind in the guide.
std::string block_of_the_guide(const std::string& kind) {
    std::ifstream file(ROVER_SOURCE_DIR "/docs/guides/compiling.md");
    const std::string page{std::istreambuf_iterator<char>(file), {}};
    const std::string fence = "\n\n```" + kind + "\n";
    const std::size_t start = page.find(fence) + fence.size();
    return page.substr(start, page.find("```", start) - start);
}

TEST_F(Program, TheGuidesExampleWorks) {
    std::ofstream(path() / "squares.c") << block_of_the_guide("c");
    const toolchain::driver::WorkFolder logs;
    std::istringstream lines(block_of_the_guide(""));
    std::string said;
    for (std::string line; std::getline(lines, line);) {
        ASSERT_EQ(line.find("build/bin/"), 0U) << line;
        const bool compiles = line.find("build/bin/i85cc ") == 0;
        line.replace(0, line.find(' '), compiles ? I85CC_PROGRAM : I85RUN_PROGRAM);
        const std::vector<Command> commands = {
            {{"env", "-C", path().string(), "sh", "-c", line}, logs.path() / "log"}};
        const Outcome outcome = toolchain::driver::run_all(commands, 1).at(0);
        EXPECT_EQ(outcome.exit_code, 0) << line << outcome.messages;
        said = outcome.messages;
    }
    // 385 = 1 + 4 + ... + 100 = 0181H, the low byte first.
    EXPECT_THAT(said, HasSubstr("dump          result: 2 bytes"));
    EXPECT_THAT(said, HasSubstr(" 81 01"));
}

TEST_F(Program, SurvivesSourcesThatAreNone) {
    std::ofstream(path() / "empty.c");
    std::ofstream(path() / "zeros.cpp") << std::string(5000, '\0');
    std::ofstream(path() / "noise.c") << "\xff\xfe{{{((\\\n#include \"noise.c\"\n";
    std::ofstream(path() / "noise.bc") << "BC\xC0\xDE garbage";
    std::ofstream(path() / "empty.ll");
    const std::set<std::string> before = names_in(path());
    for (const char* source : {"empty.c", "zeros.cpp", "noise.c", "noise.bc", "empty.ll"}) {
        const Outcome outcome = run({"-o", "out.hex", source});
        EXPECT_EQ(outcome.exit_code, 1) << source;
        EXPECT_THAT(outcome.messages, HasSubstr("i85cc: ")) << source;
        EXPECT_THAT(outcome.messages, testing::Not(HasSubstr("internal error"))) << source;
    }
    EXPECT_EQ(names_in(path()), before);
}

TEST_F(Program, PrintsStagesOrWritesThem) {
    const Outcome printed = run({"--emit=mir", "a.c"});
    EXPECT_EQ(printed.exit_code, 0);
    EXPECT_THAT(printed.messages, HasSubstr("function main"));
    EXPECT_EQ(run({"--emit=mir", "-o", "a.mir", "a.c"}).messages, "");
    std::ifstream file(path() / "a.mir");
    EXPECT_EQ((std::string{std::istreambuf_iterator<char>(file), {}}), printed.messages);
}

TEST_F(Program, LeavesNoTemporaryFilesWhenItIsEnded) {
    const fs::path temporary = path() / "tmp";
    fs::create_directory(temporary);
    std::ofstream(path() / "clang") << "#!/bin/sh\nexec sleep 3\n";
    fs::permissions(path() / "clang", fs::perms::owner_all);
    const std::string script = std::string("exec 2>/dev/null; ") + I85CC_PROGRAM +
                               " --emit=mir a.c & for i in $(seq 600); do "
                               "test -n \"$(ls tmp)\" && break; sleep 0.05; done; "
                               "ls tmp | wc -l; kill -TERM $!; wait $!; echo $?; ls tmp | wc -l";
    const toolchain::driver::WorkFolder logs;
    const std::vector<Command> commands = {
        {{"env", "-C", path().string(), "TMPDIR=" + temporary.string(), "I85CC_CLANG=./clang", "sh",
          "-c", script},
         logs.path() / "log"}};
    EXPECT_EQ(toolchain::driver::run_all(commands, 1).at(0).messages, "1\n143\n0\n");
}

TEST_F(Program, LeavesNoTemporaryFiles) {
    const fs::path temporary = path() / "tmp";
    fs::create_directory(temporary);
    std::ofstream(path() / "bad.c") << "int main(void) { return }";
    const std::string setting = "TMPDIR=" + temporary.string();
    for (const char* source : {"a.c", "bad.c"}) {
        const toolchain::driver::WorkFolder logs;
        const std::vector<Command> commands = {
            {{"env", "-C", path().string(), setting, I85CC_PROGRAM, "--emit=mir", source},
             logs.path() / "log"}};
        EXPECT_EQ(toolchain::driver::run_all(commands, 1).at(0).exit_code,
                  source == std::string("bad.c") ? 1 : 0);
        EXPECT_EQ(names_in(temporary), std::set<std::string>{});
    }
}

}  // namespace
