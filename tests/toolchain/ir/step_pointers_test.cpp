// Addresses in loops are stepped where that frees the counter; sums by hand.
#include <gtest/gtest.h>

#include "tests/toolchain/ir/ir_program.hpp"
#include "toolchain/ir/passes.hpp"

namespace {

using codegen_test::Interpreter;
using ir_test::Passed;
using toolchain::ir::step_pointers;

// Sum of a[i] + a[i + 1] for i below 4, with the elements 1, 2, 4, 8, 16: 45.
constexpr const char* kNeighbours = R"(
@a = global [5 x i16] [i16 1, i16 2, i16 4, i16 8, i16 16]
define i16 @f() {
entry:
  br label %loop
loop:
  %i = phi i16 [ 0, %entry ], [ %next, %loop ]
  %s = phi i16 [ 0, %entry ], [ %t, %loop ]
  %p = getelementptr [5 x i16], ptr @a, i16 0, i16 %i
  %x = load i16, ptr %p
  %j = add i16 %i, 1
  %q = getelementptr [5 x i16], ptr @a, i16 0, i16 %j
  %y = load i16, ptr %q
  %u = add i16 %s, %x
  %t = add i16 %u, %y
  %next = add nuw nsw i16 %i, 1
  %end = icmp eq i16 %next, 4
  br i1 %end, label %out, label %loop
out:
  ret i16 %t
})";

TEST(StepPointers, NeighboursShareOne) {
    const Passed passed(kNeighbours, step_pointers);
    EXPECT_EQ(passed.count("phi ptr"), 1U) << passed.text;
    EXPECT_EQ(passed.count("getelementptr [5"), 0U) << passed.text;
    Interpreter interpreter(passed.mir);
    EXPECT_EQ(interpreter.call("f"), 45U);
}

TEST(StepPointers, TwoTablesStayIndexed) {
    // Two addresses take more registers than one counter.
    const Passed passed(R"(
@a = global [4 x i8] c"\01\02\03\04"
@b = global [4 x i8] c"\05\06\07\08"
define i8 @f() {
entry:
  br label %loop
loop:
  %i = phi i16 [ 0, %entry ], [ %next, %loop ]
  %s = phi i8 [ 0, %entry ], [ %t, %loop ]
  %p = getelementptr i8, ptr @a, i16 %i
  %x = load i8, ptr %p
  %q = getelementptr i8, ptr @b, i16 %i
  %y = load i8, ptr %q
  %u = add i8 %s, %x
  %t = xor i8 %u, %y
  %next = add i16 %i, 1
  %end = icmp eq i16 %next, 4
  br i1 %end, label %out, label %loop
out:
  ret i8 %t
})",
                        step_pointers);
    EXPECT_EQ(passed.count("phi ptr"), 0U) << passed.text;
    Interpreter interpreter(passed.mir);
    // ((((1 ^ 5) + 2 ^ 6) + 3 ^ 7) + 4 ^ 8
    EXPECT_EQ(interpreter.call("f"),
              static_cast<unsigned>((((((1 ^ 5) + 2) ^ 6) + 3) ^ 7) + 4) ^ 8U);
}

TEST(StepPointers, CounterWithOtherUsesKeepsItsIndex) {
    const Passed passed(R"(
declare void @g(i16)
@a = global [4 x i16] zeroinitializer
define void @f() {
entry:
  br label %loop
loop:
  %i = phi i16 [ 0, %entry ], [ %next, %loop ]
  %p = getelementptr [4 x i16], ptr @a, i16 0, i16 %i
  store i16 %i, ptr %p
  %next = add i16 %i, 1
  %end = icmp eq i16 %next, 4
  br i1 %end, label %out, label %loop
out:
  ret void
})",
                        step_pointers);
    EXPECT_EQ(passed.count("phi ptr"), 0U) << passed.text;
    Interpreter interpreter(passed.mir);
    interpreter.call("f");
    EXPECT_EQ(interpreter.variable("a", 8), 0x0003000200010000U);
}

TEST(StepPointers, ComparisonsThatCannotCountKeepTheIndex) {
    // The number of rounds would take a division: the counter stays, so it can be the index too.
    const Passed passed(R"(
@a = global [64 x i8] zeroinitializer
define void @f(i16 %step) {
entry:
  br label %loop
loop:
  %i = phi i16 [ 0, %entry ], [ %next, %loop ]
  %p = getelementptr i8, ptr @a, i16 %i
  store i8 1, ptr %p
  %next = add nuw nsw i16 %i, %step
  %more = icmp ult i16 %next, 64
  br i1 %more, label %loop, label %out
out:
  ret void
})",
                        step_pointers);
    EXPECT_EQ(passed.count("phi ptr"), 0U) << passed.text;
    Interpreter interpreter(passed.mir);
    interpreter.call("f", {7});
    for (unsigned i = 0; i < 64; ++i) {
        ASSERT_EQ(interpreter.memory[0x8000 + i], i % 7 == 0 ? 1 : 0) << i;
    }
}

TEST(StepPointers, ColumnsOfAMatrixStepByRows) {
    // Sum of m[k][2] of a 3 x 4 matrix of bytes 0, 1, 2 ...: 2 + 6 + 10.
    const Passed passed(R"(
@m = global [12 x i8] c"\00\01\02\03\04\05\06\07\08\09\0A\0B"
define i8 @f(ptr %m, i16 %width, i16 %column) {
entry:
  br label %loop
loop:
  %k = phi i16 [ 0, %entry ], [ %next, %loop ]
  %s = phi i8 [ 0, %entry ], [ %t, %loop ]
  %row = mul i16 %k, %width
  %at = add i16 %row, %column
  %p = getelementptr i8, ptr %m, i16 %at
  %x = load i8, ptr %p
  %t = add i8 %s, %x
  %next = add i16 %k, 1
  %end = icmp eq i16 %next, 3
  br i1 %end, label %out, label %loop
out:
  ret i8 %t
})",
                        step_pointers);
    EXPECT_EQ(passed.count("mul "), 0U) << passed.text;
    Interpreter interpreter(passed.mir);
    EXPECT_EQ(interpreter.call("f", {0x8000, 4, 2}), 18U);
}

}  // namespace
