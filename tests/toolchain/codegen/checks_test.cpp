// Programs that are refused because of their calls, and the words for it.
#include "toolchain/codegen/checks.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/toolchain/codegen/call_programs.hpp"

namespace {

using namespace toolchain::codegen;
using codegen_test::module_with_calls;
using Lines = std::vector<std::string>;

Lines refusals(const Module& module, bool allow_recursion = false) {
    return call_refusals(module, CallGraph(module), allow_recursion);
}

TEST(Checks, APlainProgramPasses) {
    EXPECT_EQ(refusals(module_with_calls({{1}, {}})), Lines{});
}

TEST(Checks, ACycleIsNamedOnceWithItsLines) {
    const Module module = module_with_calls({{1}, {2}, {1}});
    EXPECT_EQ(refusals(module),
              Lines{"t.c:11: recursion: f1 -> f2 (t.c:11) -> f1 (t.c:21): static frames hold one "
                    "call at a time: make it a loop, or use --allow-recursion"});
    EXPECT_EQ(refusals(module, true), Lines{});
}

TEST(Checks, CppNamesAreReadable) {
    Module module = module_with_calls({{0}});
    module.symbols[0] = "_Z4walki";
    ASSERT_EQ(refusals(module).size(), 1U);
    EXPECT_TRUE(refusals(module)[0].starts_with("t.c:1: recursion: walk(int) -> walk(int)"));
}

TEST(Checks, AnInterruptFunctionIsNotCalled) {
    Module module = module_with_calls({{1}, {}});
    module.functions[1].interrupt = 0x3C;
    EXPECT_EQ(refusals(module),
              Lines{"t.c:1: interrupt function 'f1' is called: only the processor enters it: move "
                    "its work into a function of its own"});
}

TEST(Checks, AnInterruptFunctionHasAVectorAndNoValues) {
    Module module = module_with_calls({{1}, {}, {}, {}});
    module.functions[0].interrupt = 0x2D;
    module.functions[2].interrupt = 0x34;
    module.functions[2].result_size = 1;
    module.functions[3].interrupt = 0x34;
    const Lines lines = refusals(module);
    ASSERT_EQ(lines.size(), 3U);
    EXPECT_EQ(lines[0],
              "t.c:1: interrupt function 'f0': no interrupt enters at 2DH: take a vector of i85.h");
    EXPECT_EQ(lines[1],
              "interrupt function 'f2' has parameters or a result: nobody passes or takes them");
    EXPECT_EQ(lines[2], "interrupt functions 'f2' and 'f3' have the same vector 34H");
}

TEST(Checks, PlacesAreText) {
    const Module module = module_with_calls({{}});
    EXPECT_EQ(place_text(module, {0, 7}), "t.c:7");
    EXPECT_EQ(place_text(module, {}), "");
}

}  // namespace
