// Values with zeros on top are marked, and mean the same.
#include <gtest/gtest.h>

#include <algorithm>

#include "tests/toolchain/ir/ir_program.hpp"
#include "toolchain/ir/passes.hpp"

namespace {

using codegen_test::Interpreter;
using ir_test::Passed;
using toolchain::ir::narrow_values;

TEST(NarrowValues, WidenedCountersTakeAByte) {
    const Passed passed(R"(
define i16 @f(i16 %x) {
entry:
  br label %loop
loop:
  %i = phi i16 [ 0, %entry ], [ %next, %loop ]
  %s = phi i16 [ 0, %entry ], [ %t, %loop ]
  %u = mul i16 %i, %x
  %t = add i16 %s, %u
  %next = add nuw nsw i16 %i, 1
  %more = icmp ne i16 %next, 20
  br i1 %more, label %loop, label %out
out:
  ret i16 %t
})",
                        narrow_values);
    EXPECT_GE(passed.count("trunc i16 %i to i8"), 1U) << passed.text;
    Interpreter interpreter(passed.mir);
    EXPECT_EQ(interpreter.call("f", {7}), 190U * 7);
}

TEST(NarrowValues, KnownBitsCountToo) {
    const Passed passed(R"(
define i32 @f(i32 %a, i32 %b) {
  %x = and i32 %a, 255
  %y = and i32 %b, 127
  %s = add i32 %x, %y
  %p = mul i32 %s, %y
  ret i32 %p
})",
                        narrow_values);
    EXPECT_EQ(passed.count("trunc i32 %s to i16"), 1U) << passed.text;
    Interpreter interpreter(passed.mir);
    EXPECT_EQ(interpreter.call("f", {0xFFFFFFFF, 0xFFFFFFFF}), (255U + 127) * 127);
}

TEST(NarrowValues, WideValuesAreLeftAlone) {
    const Passed passed("define i16 @f(i16 %a) {\n %s = add i16 %a, 1\n ret i16 %s\n}",
                        narrow_values);
    EXPECT_EQ(passed.count("trunc"), 0U) << passed.text;
}

}  // namespace
