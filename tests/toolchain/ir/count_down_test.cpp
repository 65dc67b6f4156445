// Counters that only count run down, and loops run as often as before.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstdint>

#include "tests/toolchain/ir/ir_program.hpp"
#include "toolchain/ir/passes.hpp"

namespace {

using codegen_test::Interpreter;
using ir_test::Passed;
using toolchain::ir::count_down;

/// Adds 3 as often as the body runs. @param test  the end of the loop's body
Passed counting(const std::string& type, const std::string& first, const std::string& step,
                const std::string& test, void (*pass)(llvm::Function&) = count_down) {
    return Passed(fmt::format(R"(
define i16 @f({0} %n) {{
entry:
  br label %loop
loop:
  %i = phi {0} [ {1}, %entry ], [ %next, %loop ]
  %s = phi i16 [ 0, %entry ], [ %t, %loop ]
  %t = add i16 %s, 3
  %next = add {0} %i, {2}
  %more = {3}
  br i1 %more, label %loop, label %out
out:
  ret i16 %t
}})",
                              type, first, step, test),
                  pass);
}

TEST(CountDown, ConstantsOfUpTo256FitInAByte) {
    for (const unsigned count : {1U, 2U, 255U, 256U}) {
        const Passed passed =
            counting("i16", "0", "1", fmt::format("icmp ne i16 %next, {}", count));
        EXPECT_EQ(passed.count("phi i8"), 1U) << passed.text;
        Interpreter interpreter(passed.mir);
        EXPECT_EQ(interpreter.call("f", {0}), 3 * count);
    }
}

TEST(CountDown, MoreTakesAWord) {
    for (const unsigned count : {257U, 1000U, 65535U}) {
        const Passed passed =
            counting("i32", "0", "1", fmt::format("icmp ne i32 %next, {}", count));
        EXPECT_EQ(passed.count("phi i32"), 0U) << passed.text;
        Interpreter interpreter(passed.mir);
        EXPECT_EQ(interpreter.call("f", {0}), 3 * count & 0xFFFF);
    }
}

// For INX and JNK: from minus the count to 0. What fits in a byte goes down all the same.
TEST(CountDown, WordsGoUpIfAskedTo) {
    const auto up = toolchain::ir::count_words_up;
    for (const unsigned count : {257U, 1000U, 65535U}) {
        const Passed passed =
            counting("i32", "0", "1", fmt::format("icmp ne i32 %next, {}", count), up);
        EXPECT_EQ(passed.count(fmt::format("i16 [ {}, %entry", static_cast<int16_t>(-count))), 1U)
            << passed.text;
        Interpreter interpreter(passed.mir);
        EXPECT_EQ(interpreter.call("f", {0}), 3 * count & 0xFFFF);
    }
    const Passed byte = counting("i16", "0", "1", "icmp ne i16 %next, 200", up);
    EXPECT_EQ(byte.count("add i8 %left, -1"), 1U) << byte.text;
}

TEST(CountDown, ArgumentsAsCounts) {
    const Passed passed = counting("i8", "0", "1", "icmp ne i8 %next, %n");
    EXPECT_EQ(passed.count("icmp ne i8 %next, %n"), 0U) << passed.text;
    Interpreter interpreter(passed.mir);
    for (unsigned n = 0; n < 256; ++n) {
        ASSERT_EQ(interpreter.call("f", {n}), 3 * (n == 0 ? 256 : n)) << n;
    }
}

TEST(CountDown, OtherStepsAndTests) {
    const Passed passed = counting("i16", "100", "-7", "icmp sgt i16 %next, -30");
    Interpreter interpreter(passed.mir);
    // 93, 86 ... -26, -33: the 19th ends it
    EXPECT_EQ(interpreter.call("f", {0}), 3 * 19U);
}

TEST(CountDown, TestAtTheTop) {
    const Passed passed(R"(
define i16 @f(i8 %n) {
entry:
  br label %head
head:
  %i = phi i8 [ 0, %entry ], [ %next, %body ]
  %s = phi i16 [ 0, %entry ], [ %t, %body ]
  %end = icmp eq i8 %i, %n
  br i1 %end, label %out, label %body
body:
  %t = add i16 %s, 3
  %next = add nuw i8 %i, 1
  br label %head
out:
  ret i16 %s
})",
                        count_down);
    EXPECT_EQ(passed.count("icmp eq i8 %i, %n"), 0U) << passed.text;
    Interpreter interpreter(passed.mir);
    for (unsigned n = 0; n < 256; ++n) ASSERT_EQ(interpreter.call("f", {n}), 3 * n) << n;
}

TEST(CountDown, PointersWithAKnownEndNeedNoCounter) {
    const Passed passed(R"(
@a = global [1200 x i8] zeroinitializer
define void @f() {
entry:
  br label %loop
loop:
  %i = phi i16 [ 0, %entry ], [ %next, %loop ]
  %p = phi ptr [ @a, %entry ], [ %q, %loop ]
  store i8 7, ptr %p
  %q = getelementptr i8, ptr %p, i16 4
  %next = add i16 %i, 1
  %more = icmp ult i16 %next, 300
  br i1 %more, label %loop, label %out
out:
  ret void
})",
                        count_down);
    EXPECT_EQ(passed.count("phi i"), 0U) << passed.text;
    Interpreter interpreter(passed.mir);
    interpreter.call("f");
    for (unsigned i = 0; i < 1210; ++i) {
        ASSERT_EQ(interpreter.memory[0x8000 + i], i % 4 == 0 && i < 1200 ? 7 : 0) << i;
    }
}

TEST(CountDown, UsedCountersStay) {
    const Passed passed(R"(
define i16 @f(i16 %n) {
entry:
  br label %loop
loop:
  %i = phi i16 [ 0, %entry ], [ %next, %loop ]
  %s = phi i16 [ 0, %entry ], [ %t, %loop ]
  %t = add i16 %s, %i
  %next = add i16 %i, 1
  %more = icmp ne i16 %next, 10
  br i1 %more, label %loop, label %out
out:
  ret i16 %t
})",
                        count_down);
    EXPECT_EQ(passed.count("icmp ne i16 %next, 10"), 1U) << passed.text;
    Interpreter interpreter(passed.mir);
    EXPECT_EQ(interpreter.call("f", {0}), 45U);
}

}  // namespace
