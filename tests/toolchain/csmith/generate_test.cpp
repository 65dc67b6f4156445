#include "tests/toolchain/csmith/generate.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <set>

#include "tests/toolchain/csmith/kernels.hpp"
#include "tests/toolchain/csmith/process.hpp"
#include "tests/toolchain/csmith/profile.hpp"

namespace csmith_test {
namespace {

std::string text_of(const std::filesystem::path& path) {
    std::ifstream in(path);
    return {std::istreambuf_iterator<char>(in), {}};
}

/// Without the first line, which names the file.
std::string program_of(uint64_t seed) {
    const WorkFolder folder;
    const auto program = generate(seed, folder.path());
    if (!program) return {};
    const std::string text = text_of(program->source);
    return text.substr(text.find('\n'));
}

bool has(const std::vector<std::string>& words, const std::string& word) {
    return std::find(words.begin(), words.end(), word) != words.end();
}

TEST(ProfileOf, DependsOnTheSeedAlone) {
    for (uint64_t seed = 1; seed < 50; ++seed) {
        const Profile first = profile_of(seed);
        const Profile second = profile_of(seed);
        EXPECT_EQ(first.csmith, second.csmith);
        EXPECT_EQ(first.compiler, second.compiler);
        EXPECT_EQ(first.opaque, second.opaque);
    }
}

TEST(ProfileOf, HasEveryKindOften) {
    constexpr unsigned kSeeds = 400;
    constexpr unsigned kOften = kSeeds / 20;
    unsigned narrow = 0;
    unsigned no_volatiles = 0;
    unsigned opaque = 0;
    unsigned calls = 0;
    for (uint64_t seed = 1; seed <= kSeeds; ++seed) {
        const Profile profile = profile_of(seed);
        EXPECT_TRUE(has(profile.csmith, "--no-float"));
        if (has(profile.csmith, "--no-longlong")) ++narrow;
        if (has(profile.csmith, "--no-volatiles")) ++no_volatiles;
        if (profile.opaque) ++opaque;
        if (!profile.compiler.empty()) ++calls;
    }
    for (const unsigned count : {narrow, no_volatiles, opaque, calls}) {
        EXPECT_GT(count, kOften);
        EXPECT_LT(count, kSeeds - kOften);
    }
}

TEST(EscapesOf, NamesEveryVariableOnce) {
    const std::string text = escapes_of(
        "static long __undefined;\n"
        "static volatile int32_t g_2[3][7] = {{1L}};\n"
        "static int32_t *g_10 = &g_9;\n"
        "static struct S0 g_11[4];\n"
        "static const uint64_t  func_1(void);\n"
        "    static int32_t g_12 = 0;\n");
    EXPECT_EQ(text,
              "\n__attribute__((used)) void* rover_escape[] = "
              "{(void*)&g_2, (void*)&g_10, (void*)&g_11, 0};\n");
    EXPECT_EQ(escapes_of("static int x = 1;\n"), "");
}

TEST(Generate, GivesTheSameProgramForASeed) {
    const std::string first = program_of(3);
    ASSERT_NE(first.find("int main"), std::string::npos);
    EXPECT_EQ(first, program_of(3));
    EXPECT_NE(first, program_of(4));
}

TEST(Generate, KnowsThatIntHas16Bits) {
    // csmith takes widths from a file in the folder it runs in; a wrong one would be ignored.
    const WorkFolder folder;
    const auto program = generate(3, folder.path());
    ASSERT_TRUE(program);
    EXPECT_EQ(text_of(folder.path() / "platform.info"), "integer size = 2\npointer size = 2\n");
}

TEST(KernelProgram, DependsOnTheSeedAloneAndIsWithoutWarnings) {
    EXPECT_EQ(kernel_program(5), kernel_program(5));
    EXPECT_NE(kernel_program(5), kernel_program(6));
    const WorkFolder folder;
    const auto program = generate(5, folder.path(), Generator::kernels);
    ASSERT_TRUE(program);
    // What would be undefined: shifts too far, constants too large, variables without a value.
    std::vector<std::string> command = {"clang-19",
                                        "--target=msp430-none-elf",
                                        "-fsyntax-only",
                                        "-Werror=shift-count-overflow",
                                        "-Werror=uninitialized",
                                        "-Werror=constant-conversion",
                                        "-Werror=array-bounds"};
    for (const std::string& option : include_options()) {
        if (option != "-w") command.push_back(option);
    }
    command.push_back(program->source.string());
    const Ran ran = run_program(command, 20);
    EXPECT_EQ(ran.end, Ran::End::finished) << ran.text;
}

}  // namespace
}  // namespace csmith_test
