// The command line of i85cc. Source: docs/guides/compiling.md.
#include "tools/i85cc/options.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace {

using i85cc::Options;
using i85cc::parse_options;
using testing::ElementsAre;
using toolchain::assembly::AddressRange;
using toolchain::driver::Text;
using toolchain::ir::Optimisation;

std::string mistake_in(const std::vector<std::string>& arguments) {
    try {
        (void)parse_options(arguments);
    } catch (const i85cc::UsageError& error) {
        return error.what();
    }
    return {};
}

TEST(Options, DefaultsAreThoseOfTheGuide) {
    const Options options = parse_options({"-o", "a.hex", "a.cpp"});
    EXPECT_EQ(options.output, "a.hex");
    EXPECT_EQ(options.request.level, Optimisation::size);
    EXPECT_FALSE(options.request.undocumented);
    EXPECT_FALSE(options.request.allow_recursion);
    EXPECT_TRUE(options.request.allow_constructors);
    EXPECT_EQ(options.request.rom, (AddressRange{0x0000, 0x7FFF}));
    EXPECT_EQ(options.request.ram, (AddressRange{0x8000, 0xFEFF}));
    EXPECT_FALSE(options.request.stack_bytes);
    EXPECT_FALSE(options.emit);
}

TEST(Options, SourcesBehindSeparateStandAlone) {
    const Options options =
        parse_options({"a.cpp", "-o", "x.hex", "--separate", "b.c", "-O2", "c.c"});
    ASSERT_EQ(options.request.sources.size(), 3U);
    EXPECT_EQ(options.request.sources[0].path, "a.cpp");
    EXPECT_FALSE(options.request.sources[0].separate);
    EXPECT_TRUE(options.request.sources[1].separate);
    EXPECT_TRUE(options.request.sources[2].separate);
}

TEST(Options, LevelsAndTheLastOneCounts) {
    const auto level = [](const std::vector<std::string>& options) {
        std::vector<std::string> arguments = {"-o", "a.hex", "a.c"};
        arguments.insert(arguments.end(), options.begin(), options.end());
        return parse_options(arguments).request.level;
    };
    EXPECT_EQ(level({"-O0"}), Optimisation::none);
    EXPECT_EQ(level({"-O1"}), Optimisation::less);
    EXPECT_EQ(level({"-O2"}), Optimisation::more);
    EXPECT_EQ(level({"-Os"}), Optimisation::size);
    EXPECT_EQ(level({"-O0", "-O2"}), Optimisation::more);
    EXPECT_EQ(mistake_in({"-O3", "-o", "a.hex", "a.c"}),
              "-O3: no such level: -O0, -O1, -O2 or -Os");
}

TEST(Options, TakeValuesBehindASpaceOrAnEqualsSign) {
    const Options options =
        parse_options({"--rom=0x100-3FFFh", "--ram", "16384-0FFFFH", "--stack=40", "--keep", "f",
                       "--keep=g", "-o", "a.hex", "a.c"});
    EXPECT_EQ(options.request.rom, (AddressRange{0x0100, 0x3FFF}));
    EXPECT_EQ(options.request.ram, (AddressRange{0x4000, 0xFFFF}));
    EXPECT_EQ(options.request.stack_bytes, 40U);
    EXPECT_THAT(options.request.keep, ElementsAre("f", "g"));
}

TEST(Options, PassOnWhatIsForClang) {
    const Options options = parse_options({"-I", "inc", "-Iother", "-DA=1", "-U", "B", "-include",
                                           "pre.h", "-std=c++20", "-Wall", "-fshort-enums", "-w",
                                           "-g", "-pedantic", "-o", "a.hex", "a.c"});
    EXPECT_THAT(options.request.front_end,
                ElementsAre("-I", "inc", "-Iother", "-DA=1", "-U", "B", "-include", "pre.h",
                            "-std=c++20", "-Wall", "-fshort-enums", "-w", "-pedantic"));
    EXPECT_EQ(options.request.sources.size(), 1U);
}

TEST(Options, Switches) {
    const Options options =
        parse_options({"--cpu=8085u", "--allow-recursion", "--no-constructors", "--table-multiply",
                       "--report", "--time", "-v", "-o", "a.hex", "a.c"});
    EXPECT_TRUE(options.request.table_multiply);
    EXPECT_TRUE(options.request.undocumented);
    EXPECT_TRUE(options.request.allow_recursion);
    EXPECT_FALSE(options.request.allow_constructors);
    EXPECT_TRUE(options.report);
    EXPECT_TRUE(options.times);
    EXPECT_TRUE(options.request.verbose);
    EXPECT_FALSE(
        parse_options({"--cpu=8085u", "--cpu=8085", "-o", "a.hex", "a.c"}).request.undocumented);
}

TEST(Options, StepsAreLeftOutByName) {
    const Options options =
        parse_options({"--without", "carry-answers", "--without=lhlx", "-o", "a.hex", "a.c"});
    for (const toolchain::StepName& name : toolchain::step_names()) {
        const bool left_out =
            name.step == toolchain::Step::carry_answers || name.step == toolchain::Step::lhlx;
        EXPECT_EQ(options.request.steps.contains(name.step), !left_out) << name.name;
    }
    EXPECT_THAT(
        [] { (void)parse_options({"--without", "luck", "-o", "a.hex", "a.c"}); },
        testing::ThrowsMessage<i85cc::UsageError>(testing::AllOf(
            testing::HasSubstr("--without: no such step 'luck'"), testing::HasSubstr("homes"))));
}

TEST(Options, StagesNeedNoOutput) {
    EXPECT_EQ(parse_options({"--emit=llvm", "a.c"}).emit, Text::llvm);
    EXPECT_EQ(parse_options({"--emit=mir", "a.c"}).emit, Text::mir);
    EXPECT_EQ(parse_options({"--emit", "asm", "-o", "a.s", "a.c"}).emit, Text::assembly);
}

TEST(Options, HelpAndVersionNeedNothing) {
    EXPECT_TRUE(parse_options({"--help"}).help);
    EXPECT_TRUE(parse_options({"-h"}).help);
    EXPECT_TRUE(parse_options({"--version"}).version);
}

TEST(Options, HelpNamesEveryOption) {
    const std::string help = i85cc::help_text();
    for (const char* option : {"-O0",
                               "-Os",
                               "--cpu=8085u",
                               "--allow-recursion",
                               "--no-constructors",
                               "--table-multiply",
                               "--without",
                               "--separate",
                               "--keep",
                               "--rom",
                               "--ram",
                               "--stack",
                               "--emit=",
                               "--report",
                               "--time",
                               "-v",
                               "--version",
                               "-I",
                               "-D",
                               "-U",
                               "-include",
                               "-std=",
                               "-W",
                               "-f",
                               "I85CC_CLANG"}) {
        EXPECT_THAT(help, testing::HasSubstr(option));
    }
}

struct Mistake {
    std::vector<std::string> arguments;
    std::string message;
};

class Mistakes : public testing::TestWithParam<Mistake> {};

TEST_P(Mistakes, AreNamed) {
    EXPECT_EQ(mistake_in(GetParam().arguments), GetParam().message);
}

INSTANTIATE_TEST_SUITE_P(
    Options, Mistakes,
    testing::Values(
        Mistake{{}, "no source is given: name a .c or .cpp file, or see i85cc --help"},
        Mistake{{"a.c"}, "no output is given: add -o OUT.hex"},
        Mistake{{"-o"}, "-o: its value is missing: see i85cc --help"},
        Mistake{{"-I"}, "-I: its value is missing: see i85cc --help"},
        Mistake{{"a.c", "-o", "a.out"}, "-o a.out: the image's name has to end in .hex"},
        Mistake{{"a.c", "-o", "dir/.hex"}, "-o dir/.hex: the image's name has to end in .hex"},
        Mistake{{"--bogus", "a.c"}, "--bogus: unknown option: see i85cc --help"},
        Mistake{{"-x", "a.c"}, "-x: unknown option: see i85cc --help"},
        Mistake{{"-lm", "a.c"}, "-lm: unknown option: see i85cc --help"},
        Mistake{{"-"}, "a source has an empty name: name a .c or .cpp file"},
        Mistake{{""}, "a source has an empty name: name a .c or .cpp file"},
        Mistake{{"--cpu=z80"}, "--cpu=z80: no such processor: 8085 or 8085u"},
        Mistake{{"--emit=hex"}, "--emit: 'hex' is no stage: llvm, mir or asm"},
        Mistake{{"--rom=8000h"},
                "--rom: '8000h' is not a range of addresses: write FIRST-LAST, such as "
                "8000H-0FEFFH"},
        Mistake{{"--ram=2-1"},
                "--ram: '2-1' is not a range of addresses: write FIRST-LAST, such as 8000H-0FEFFH"},
        Mistake{{"--ram=0-10000h"},
                "--ram: '0-10000h' is not a range of addresses: write FIRST-LAST, such as "
                "8000H-0FEFFH"},
        Mistake{{"--stack=many"}, "--stack: 'many' is not a number of bytes"}));

}  // namespace
