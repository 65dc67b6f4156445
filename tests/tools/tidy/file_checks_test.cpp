// file_checks_test.cpp - every rule that looks at one file, with text that breaks it and text that
// does not. The rules are those of the repository.
#include "tools/tidy/file_checks.hpp"

#include <gtest/gtest.h>
#include <fstream>
#include <iterator>
#include <set>

namespace {

const tidy::Rules& repository_rules() {
    static const tidy::Rules rules = [] {
        std::ifstream in(ROVER_SOURCE_DIR "/tools/tidy/rules.toml");
        return tidy::parse_rules(std::string{std::istreambuf_iterator<char>(in), {}});
    }();
    return rules;
}

/// "line:rule" of every violation.
std::multiset<std::string> found(const std::string& path, const std::string& text) {
    std::multiset<std::string> result;
    for (const auto& violation : tidy::check_file({path, text}, repository_rules())) {
        result.insert(std::to_string(violation.line) + ":" + violation.rule);
    }
    return result;
}

using Found = std::multiset<std::string>;

/// A firmware header whose third line is `code`.
Found in_firmware(const std::string& code) {
    return found("firmware/safety/a.hpp", "// a.hpp - text.\n#pragma once\n" + code + "\n");
}

std::string repeated(const std::string& text, int count) {
    std::string result;
    for (int i = 0; i < count; ++i) result += text;
    return result;
}

struct Case {
    const char* rule;
    const char* bad;
    const char* good;
};

class FirmwareRule : public testing::TestWithParam<Case> {};

TEST_P(FirmwareRule, RefusesTheBadLineAndAcceptsTheGoodOne) {
    const Found expected = {std::string("3:") + GetParam().rule};
    EXPECT_EQ(in_firmware(GetParam().bad), expected) << GetParam().bad;
    EXPECT_EQ(in_firmware(GetParam().good), Found{}) << GetParam().good;
}

INSTANTIATE_TEST_SUITE_P(
    Table, FirmwareRule,
    testing::Values(
        Case{"no-float", "inline float f();", "// a float in a comment"},
        Case{"no-float", "inline double x = 1.0;", "constexpr double kX = 1.0;"},
        Case{"no-float", "constexpr double f(int8_t x);", "static_assert(double{1} > 0);"},
        Case{"explicit-width", "int f();", "int16_t f();"},
        Case{"explicit-width", "unsigned char f();", "uint8_t f();"},
        Case{"explicit-width", "long f();", "int32_t longitude();"},
        Case{"explicit-width", "uint_fast8_t f();", "uint8_t f();"},
        Case{"no-64-bit", "uint64_t f();", "uint32_t f();"},
        Case{"no-64-bit", "inline constexpr auto kX = 1ull;", "inline constexpr auto kX = 1u;"},
        Case{"no-heap", "inline uint8_t* p = new uint8_t;", "uint8_t new_count();"},
        Case{"no-heap", "void f() { free(p); }", "struct S { S() = delete; };"},
        Case{"no-virtual", "struct S { virtual void f(); };", "struct S { void f(); };"},
        Case{"no-exceptions", "inline void f() { throw 1; }", "Status try_again();"},
        Case{"no-std", "std::uint8_t f();", "uint8_t f();"},
        Case{"system-include", "#include <cstdint>", "#include <stdint.h>"},
        Case{"no-function-pointer", "void f(void (*g)(uint8_t));", "void f(uint8_t (&g)[4]);"},
        Case{"no-conditional-compilation", "#ifdef X", "// #ifdef X"},
        Case{"named-shift", "inline uint8_t f(uint8_t a) { return a >> 3; }",
             "constexpr uint8_t kMask = 1u << 3;"},
        Case{"named-shift", "inline void f(uint8_t a) { a <<= 1; }", "enum E { a = 1u << 3 };"},
        Case{"no-macro", "#define X 1", "#define ROVER_ASSERT(x) x"},
        Case{"no-using-namespace", "using namespace hal;",
             "void f() {\n    using namespace hal;\n}"}));

TEST(FirmwareRules, DoNotApplyToHostCode) {
    EXPECT_EQ(found("host_sim/a.cpp", "// a.cpp - text.\nstd::int64_t f(double x, int y);\n"),
              Found{});
    EXPECT_EQ(found("firmware/core/a.hpp", "// a.\n#pragma once\nauto f() { return a >> 3; }\n"),
              Found{});
    EXPECT_EQ(found("hal/target/a.hpp", "// a.\n#pragma once\n#if X\n#endif\n"), Found{});
}

TEST(TextRules, ApplyToEveryKindOfFile) {
    for (const char* path : {"docs/a.md", "tools/run", "a/CMakeLists.txt", "tools/a.toml"}) {
        EXPECT_EQ(found(path, "a \n"), Found{"1:trailing-whitespace"}) << path;
        EXPECT_EQ(found(path, "a\r\n"), Found{"1:trailing-whitespace"}) << path;
        EXPECT_EQ(found(path, "a\tb\n"), Found{"1:no-tab"}) << path;
        EXPECT_EQ(found(path, "a"), Found{"1:final-newline"}) << path;
        EXPECT_EQ(found(path, ""), Found{}) << path;
    }
}

// The marks are put together here so that this file does not carry them itself.
TEST(TextRules, AnUnfinishedMarkNeedsAnIssueNumber) {
    for (const std::string mark : {"TO"
                                   "DO",
                                   "FIX"
                                   "ME",
                                   "X"
                                   "XX",
                                   "HA"
                                   "CK"}) {
        EXPECT_EQ(found("docs/a.md", mark + ": later\n"), Found{"1:issue-number"});
        EXPECT_EQ(found("docs/a.md", mark + "(#12): later\n"), Found{});
        EXPECT_EQ(found("docs/a.md", "a" + mark + "b\n"), Found{});
    }
}

TEST(TextRules, PathsOfOneMachineAreRefused) {
    const std::string home = std::string("/ho") + "me/";
    EXPECT_EQ(found("docs/a.md", "see " + home + "me/x\n"), Found{"1:machine-path"});
    EXPECT_EQ(found("tools/a.cpp", "// a.\nauto p = \"" + home + "x\";\n"),
              Found{"2:machine-path"});
    EXPECT_EQ(found("docs/a.md", "see docs" + home + "x and ../shared/data\n"), Found{});
}

TEST(FileHeader, EveryHeaderOpensWithACommentAndPragmaOnce) {
    EXPECT_EQ(found("hal/a.hpp", "#pragma once\n"), Found{"1:file-header"});
    EXPECT_EQ(found("hal/a.hpp", "// a.hpp - text.\n"), Found{"1:pragma-once"});
    EXPECT_EQ(found("hal/a.hpp", "// a.hpp - text.\n#pragma once\n"), Found{});
}

TEST(FileHeader, ASourceMayOpenWithItsHeaderInstead) {
    EXPECT_EQ(found("tools/a.cpp", "#include \"tools/a.hpp\"\n"), Found{});
    EXPECT_EQ(found("tools/a.cpp", "#include <vector>\n"), Found{"1:file-header"});
}

TEST(LineLength, CountsCharactersNotBytes) {
    EXPECT_EQ(found("tools/a.cpp", "// " + repeated("x", 97) + "\n"), Found{});
    EXPECT_EQ(found("tools/a.cpp", "// " + repeated("x", 98) + "\n"), Found{"1:line-length"});
    EXPECT_EQ(found("tools/a.cpp", "// " + repeated("\u00b0", 97) + "\n"), Found{});
    EXPECT_EQ(found("docs/a.md", repeated("x", 200) + "\n"), Found{});
}

TEST(FunctionLength, IsFiftyLinesInFirmwareAndSeventyElsewhere) {
    const auto function = [](int lines) {  // in all, with head and closing brace
        return "// a.\n#pragma once\nvoid f() {\n" + repeated("    g();\n", lines - 2) + "}\n";
    };
    EXPECT_EQ(found("firmware/a.hpp", function(50)), Found{});
    EXPECT_EQ(found("firmware/a.hpp", function(51)), Found{"3:function-length"});
    EXPECT_EQ(found("hal/a.hpp", function(51)), Found{"3:function-length"});
    EXPECT_EQ(found("tools/a.hpp", function(70)), Found{});
    EXPECT_EQ(found("tools/a.hpp", function(71)), Found{"3:function-length"});
}

TEST(FileLength, DependsOnTheKindAndSparesGeneratedFiles) {
    const auto lines = [](int count) { return repeated("int x;\n", count); };
    EXPECT_EQ(found("tools/a.hpp", "// a.\n#pragma once\n" + lines(298)), Found{});
    EXPECT_EQ(found("tools/a.hpp", "// a.\n#pragma once\n" + lines(299)), Found{"1:file-length"});
    EXPECT_EQ(found("tools/a.cpp", "// a.\n" + lines(499)), Found{});
    EXPECT_EQ(found("tools/a.cpp", "// a.\n" + lines(500)), Found{"1:file-length"});
    EXPECT_EQ(found("toolchain/codegen/a.cpp", "// a.\n" + lines(599)), Found{});
    EXPECT_EQ(found("tools/a.hpp", "// Generated by x.\n#pragma once\n" + lines(999)), Found{});
}

TEST(TidyAllow, AllowsOneRuleOnItsLineAndTheNext) {
    EXPECT_EQ(in_firmware("int f();  // tidy-allow(explicit-width): the name main needs it"),
              Found{});
    EXPECT_EQ(in_firmware("// tidy-allow(explicit-width): why\nint f();\nint g();"),
              Found{"5:explicit-width"});
    EXPECT_EQ(in_firmware("int f();  // tidy-allow(no-float): why"), Found{"3:explicit-width"});
    EXPECT_EQ(in_firmware("int f();  // tidy-allow(explicit-width)"), Found{"3:explicit-width"});
}

}  // namespace
