// Selects as branches: shared where the condition is shared, with work on the ways that need it.
#include <gtest/gtest.h>

#include "tests/toolchain/ir/ir_program.hpp"
#include "toolchain/ir/passes.hpp"
#include "toolchain/ir/sinking.hpp"

namespace {

using codegen_test::Interpreter;
using ir_test::Passed;
using toolchain::ir::expand_selects;

TEST(ExpandSelects, OneConditionOneBranch) {
    const Passed passed(R"(
define i16 @f(i16 %a, i16 %b) {
  %c = icmp ult i16 %a, %b
  %x = select i1 %c, i16 %a, i16 %b
  %s = add i16 %a, %b
  %y = select i1 %c, i16 %b, i16 %a
  %z = select i1 %c, i16 1, i16 2
  %d = sub i16 %y, %x
  %r = add i16 %d, %z
  ret i16 %r
})",
                        expand_selects);
    EXPECT_EQ(passed.count("br i1"), 1U) << passed.text;
    EXPECT_EQ(passed.count("select"), 0U) << passed.text;
    Interpreter interpreter(passed.mir);
    EXPECT_EQ(interpreter.call("f", {3, 10}), 8U);
    EXPECT_EQ(interpreter.call("f", {10, 3}), 9U);
}

TEST(ExpandSelects, SelectsThatDependOnEachOtherBranchTwice) {
    const Passed passed(R"(
define i16 @f(i16 %a, i16 %b) {
  %c = icmp ult i16 %a, %b
  %x = select i1 %c, i16 %a, i16 7
  %s = add i16 %x, 1
  %y = select i1 %c, i16 %s, i16 %x
  ret i16 %y
})",
                        expand_selects);
    EXPECT_EQ(passed.count("br i1"), 2U) << passed.text;
    Interpreter interpreter(passed.mir);
    EXPECT_EQ(interpreter.call("f", {3, 10}), 4U);
    EXPECT_EQ(interpreter.call("f", {10, 3}), 7U);
}

TEST(ExpandSelects, WorkBetweenTwoSelectsMovesWithTheSecond) {
    const Passed passed(R"(
define i16 @f(i16 %a, i16 %b) {
  %c = icmp ult i16 %a, %b
  %x = select i1 %c, i16 %a, i16 7
  %d = sub i16 %a, %b
  %e = xor i16 %d, 1
  %y = select i1 %c, i16 %e, i16 %b
  %r = add i16 %x, %y
  ret i16 %r
})",
                        expand_selects);
    EXPECT_EQ(passed.count("br i1"), 1U) << passed.text;
    Interpreter interpreter(passed.mir);
    EXPECT_EQ(interpreter.call("f", {4, 7}), (4U + 0xFFFCU) & 0xFFFFU);
    EXPECT_EQ(interpreter.call("f", {7, 4}), 11U);
}

TEST(ExpandSelects, WorkForOneValueIsDoneOnItsWay) {
    const Passed passed(R"(
define i16 @f(i16 %a, ptr %p) {
  %l = load i16, ptr %p
  %m = mul i16 %l, %a
  %n = sub i16 0, %a
  %c = icmp slt i16 %a, 0
  %x = select i1 %c, i16 %n, i16 %m
  ret i16 %x
})",
                        expand_selects);
    EXPECT_GT(passed.text.find("load i16"), passed.text.find("br i1")) << passed.text;
    EXPECT_GT(passed.text.find("sub i16 0"), passed.text.find("br i1")) << passed.text;
    Interpreter interpreter(passed.mir);
    interpreter.memory[0x9000] = 3;
    EXPECT_EQ(interpreter.call("f", {5, 0x9000}), 15U);
    EXPECT_EQ(interpreter.call("f", {0xFFFB, 0x9000}), 5U);
}

TEST(ExpandSelects, VolatileAndSharedWorkStays) {
    const Passed passed(R"(
define i16 @f(i16 %a, ptr %p) {
  %v = load volatile i16, ptr %p
  %l = load i16, ptr %p
  %t = add i16 %a, 1
  store i16 %t, ptr %p
  %c = icmp slt i16 %a, 0
  %x = select i1 %c, i16 %v, i16 %l
  %r = add i16 %x, %t
  ret i16 %r
})",
                        expand_selects);
    EXPECT_LT(passed.text.find("%l = load"), passed.text.find("store")) << passed.text;
    EXPECT_LT(passed.text.find("load volatile"), passed.text.find("br i1")) << passed.text;
}

TEST(Sinking, WhatMayMoveDown) {
    llvm::LLVMContext context;
    const auto module = ir_test::parse(R"(
declare void @g()
define void @f(ptr %p, i16 %a) {
  %plain = add i16 %a, 1
  %volatile = load volatile i16, ptr %p
  %free = load i16, ptr %p
  %held = load i16, ptr %p
  %first = xor i16 %a, 1
  call void @g()
  %late = load i16, ptr %p
  ret void
})",
                                       context);
    const llvm::BasicBlock& block = module->getFunction("f")->getEntryBlock();
    const auto named = [&](const std::string& name) -> const llvm::Instruction& {
        for (const llvm::Instruction& instruction : block) {
            if (instruction.getName() == name) return instruction;
        }
        throw std::runtime_error(name);
    };
    const auto may_move = [&](const char* which, const llvm::Instruction& before) {
        return toolchain::ir::may_move_down(named(which), before);
    };
    const llvm::Instruction& end = *block.getTerminator();
    EXPECT_TRUE(may_move("plain", end));
    EXPECT_TRUE(may_move("first", end));
    EXPECT_TRUE(may_move("late", end));
    EXPECT_TRUE(may_move("free", named("first")));
    EXPECT_FALSE(may_move("held", end));  // the call may write
    EXPECT_FALSE(may_move("volatile", named("first")));
}

}  // namespace
