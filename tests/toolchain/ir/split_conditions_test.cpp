// Branches on combined conditions; all combinations.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "tests/toolchain/ir/ir_program.hpp"
#include "toolchain/ir/passes.hpp"

namespace {

using codegen_test::Interpreter;
using ir_test::Passed;
using toolchain::ir::split_conditions;

TEST(SplitConditions, AllFormsAndCombinations) {
    const std::pair<const char*, bool> forms[] = {{"and i1 %p, %q", true},
                                                  {"or i1 %p, %q", false},
                                                  {"select i1 %p, i1 %q, i1 false", true},
                                                  {"select i1 %p, i1 true, i1 %q", false}};
    for (const auto& [form, both] : forms) {
        const Passed passed(fmt::format(R"(
define i16 @f(i16 %a, i16 %b) {{
entry:
  %p = icmp ugt i16 %a, 5
  %s = add i16 %b, %a
  %q = icmp ult i16 %s, 9
  %c = {}
  br i1 %c, label %yes, label %no
yes:
  %x = phi i16 [ %a, %entry ]
  ret i16 %x
no:
  %y = phi i16 [ 99, %entry ]
  ret i16 %y
}})",
                                        form),
                            split_conditions);
        EXPECT_EQ(passed.count("br i1"), 2U) << passed.text;
        EXPECT_EQ(passed.count("%c ="), 0U) << passed.text;
        Interpreter interpreter(passed.mir);
        for (unsigned a = 3; a < 9; ++a) {
            for (unsigned b = 0; b < 9; ++b) {
                const bool p = a > 5;
                const bool q = a + b < 9;
                ASSERT_EQ(interpreter.call("f", {a, b}), (both ? p && q : p || q) ? a : 99U)
                    << form << " " << a << " " << b;
            }
        }
    }
}

TEST(SplitConditions, SecondTestIsComputedBehindTheFirst) {
    const Passed passed(R"(
define i16 @f(i16 %a, ptr %b) {
entry:
  %v = load i16, ptr %b
  %p = icmp ugt i16 %a, 5
  %q = icmp ult i16 %v, 9
  %c = and i1 %p, %q
  br i1 %c, label %yes, label %no
yes:
  ret i16 1
no:
  ret i16 2
})",
                        split_conditions);
    EXPECT_GT(passed.text.find("load i16"), passed.text.find("br i1 %p")) << passed.text;
}

TEST(SplitConditions, NothingMovesOverAStore) {
    const Passed passed(R"(
define i16 @f(i16 %a, ptr %b) {
entry:
  %v = load i16, ptr %b
  store i16 0, ptr %b
  %p = icmp ugt i16 %a, 5
  %q = icmp ult i16 %v, 9
  %c = and i1 %p, %q
  br i1 %c, label %yes, label %no
yes:
  ret i16 1
no:
  ret i16 2
})",
                        split_conditions);
    EXPECT_LT(passed.text.find("load i16"), passed.text.find("store i16")) << passed.text;
}

TEST(SplitConditions, LongChainsAndLoops) {
    // Counts up while all three hold; the loop's own phis get the values of both ways out.
    const Passed passed(R"(
define i16 @f(i16 %n, i16 %m) {
entry:
  br label %loop
loop:
  %i = phi i16 [ 0, %entry ], [ %next, %loop ]
  %next = add i16 %i, 1
  %p = icmp ne i16 %next, %n
  %q = icmp ne i16 %next, %m
  %r = icmp ult i16 %next, 50
  %pq = and i1 %p, %q
  %c = and i1 %pq, %r
  br i1 %c, label %loop, label %out
out:
  %x = phi i16 [ %next, %loop ]
  ret i16 %x
})",
                        split_conditions);
    EXPECT_EQ(passed.count("br i1"), 3U) << passed.text;
    Interpreter interpreter(passed.mir);
    EXPECT_EQ(interpreter.call("f", {10, 20}), 10U);
    EXPECT_EQ(interpreter.call("f", {30, 20}), 20U);
    EXPECT_EQ(interpreter.call("f", {0, 0}), 50U);
}

}  // namespace
