// What moves to its use, and what must not.
#include <gtest/gtest.h>

#include "tests/toolchain/ir/ir_program.hpp"
#include "toolchain/ir/passes.hpp"

namespace {

using codegen_test::Interpreter;
using ir_test::Passed;
using toolchain::ir::place_near_use;

TEST(PlaceNearUse, LoadsStandAtTheirUse) {
    const Passed passed(R"(
define i16 @f(ptr %p, ptr %q, i16 %a) {
  %x = load i16, ptr %p
  %y = load i16, ptr %q
  %b = add i16 %a, 1
  %c = xor i16 %b, %y
  %d = add i16 %c, %x
  ret i16 %d
})",
                        place_near_use);
    EXPECT_GT(passed.text.find("%y = load"), passed.text.find("%b = add")) << passed.text;
    EXPECT_GT(passed.text.find("%x = load"), passed.text.find("%c = xor")) << passed.text;
    Interpreter interpreter(passed.mir);
    interpreter.memory[0x9000] = 3;
    interpreter.memory[0x9002] = 5;
    EXPECT_EQ(interpreter.call("f", {0x9000, 0x9002, 8}), (9U ^ 5U) + 3U);
}

TEST(PlaceNearUse, NoLoadPassesAStoreOrIsRepeated) {
    const Passed passed(R"(
define i16 @f(ptr %p, i16 %a) {
  %x = load i16, ptr %p
  %v = load volatile i16, ptr %p
  store i16 %a, ptr %p
  %b = add i16 %a, 1
  %d = add i16 %b, %x
  %e = add i16 %d, %v
  ret i16 %e
})",
                        place_near_use);
    EXPECT_LT(passed.text.find("%x = load"), passed.text.find("store")) << passed.text;
    EXPECT_LT(passed.text.find("%v = load"), passed.text.find("store")) << passed.text;
}

TEST(PlaceNearUse, StepsComeLast) {
    const Passed passed(R"(
define i8 @f(ptr %p, i8 %n) {
entry:
  br label %loop
loop:
  %at = phi ptr [ %p, %entry ], [ %next, %loop ]
  %s = phi i8 [ 0, %entry ], [ %t, %loop ]
  %next = getelementptr i8, ptr %at, i16 1
  %x = load i8, ptr %at
  %t = add i8 %s, %x
  %more = icmp ult i8 %t, %n
  br i1 %more, label %loop, label %out
out:
  ret i8 %t
})",
                        place_near_use);
    EXPECT_GT(passed.text.find("%next = get"), passed.text.find("%x = load")) << passed.text;
    Interpreter interpreter(passed.mir);
    for (unsigned i = 0; i < 8; ++i) interpreter.memory[0x9000 + i] = static_cast<uint8_t>(i);
    EXPECT_EQ(interpreter.call("f", {0x9000, 10}), 10U);  // 0 + 1 + 2 + 3 + 4
}

}  // namespace
