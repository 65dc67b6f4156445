// Which addresses get a page, and that they are right: all subscripts, in the interpreter.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "tests/toolchain/ir/ir_program.hpp"
#include "toolchain/ir/passes.hpp"

namespace {

using codegen_test::Interpreter;
using ir_test::Passed;
using toolchain::ir::find_pages;

/// Constants 7, 8, 9 ... of `type`.
std::string numbers(const std::string& type, unsigned count) {
    std::string text;
    for (unsigned i = 0; i < count; ++i) {
        text += fmt::format("{}{} {}", i == 0 ? "" : ", ", type, 7 + i);
    }
    return text;
}

bool has_note(const Passed& passed) {
    return passed.count("!i85.page") != 0;
}

TEST(FindPages, AConstantTableLiesInOnePage) {
    const Passed passed("@odd = internal constant i8 1\n@t = internal constant [25 x i16] [" +
                            numbers("i16", 25) + R"(]
define i16 @f(i8 %i) {
  %w = zext i8 %i to i16
  %a = getelementptr inbounds [25 x i16], ptr @t, i16 0, i16 %w
  %x = load i16, ptr %a
  ret i16 %x
})",
                        find_pages);
    EXPECT_TRUE(has_note(passed)) << passed.text;
    EXPECT_TRUE(passed.count("align 64") != 0) << "50 bytes: " << passed.text;
    for (unsigned i = 0; i < 25; ++i) {
        Interpreter interpreter(passed.mir);
        EXPECT_EQ(interpreter.call("f", {i}), 7 + i);
        EXPECT_EQ(interpreter.address("t") % 64, 0U);
    }
}

// a[i - 2]: the fixed part lies before the table, in another page.
TEST(FindPages, TheFixedPartMayLieBeforeTheTable) {
    const Passed passed("@t = internal constant [64 x i8] [" + numbers("i8", 64) + R"(], align 256
define i8 @f(i8 %i) {
  %w = zext i8 %i to i16
  %a = getelementptr i8, ptr @t, i16 -2
  %b = getelementptr i8, ptr %a, i16 %w
  %x = load i8, ptr %b
  ret i8 %x
})",
                        find_pages);
    EXPECT_TRUE(has_note(passed)) << passed.text;
    Interpreter interpreter(passed.mir);
    for (unsigned i = 2; i < 66; ++i) EXPECT_EQ(interpreter.call("f", {i}), 7 + i - 2);
}

TEST(FindPages, FieldsOfAnElement) {
    const Passed passed(R"(
@t = internal global [5 x <{ i8, i16, i8 }>] zeroinitializer
define i8 @f(i8 %i, i16 %v) {
  %w = zext i8 %i to i16
  %a = getelementptr inbounds [5 x <{ i8, i16, i8 }>], ptr @t, i16 0, i16 %w, i32 1
  store i16 %v, ptr %a
  %b = getelementptr inbounds i8, ptr %a, i16 1
  %x = load i8, ptr %b
  ret i8 %x
})",
                        find_pages);
    EXPECT_TRUE(has_note(passed)) << passed.text;
    for (unsigned i = 0; i < 5; ++i) {
        Interpreter interpreter(passed.mir);
        EXPECT_EQ(interpreter.call("f", {i, 0x1234}), 0x12U);
        const unsigned at = interpreter.address("t") + i * 4U + 1U;
        EXPECT_EQ(interpreter.memory[at], 0x34U) << i;
    }
}

// The place behind the last element is an address that may be compared; its page is the next one.
TEST(FindPages, AddressesThatAreMoreThanAccessedStay) {
    const Passed passed(R"(
@t = internal global [256 x i8] zeroinitializer, align 256
define ptr @f(i16 %i) {
  %a = getelementptr inbounds i8, ptr @t, i16 %i
  %x = load i8, ptr %a
  ret ptr %a
})",
                        find_pages);
    EXPECT_FALSE(has_note(passed)) << passed.text;
    Interpreter interpreter(passed.mir);
    EXPECT_EQ(interpreter.call("f", {256}), interpreter.address("t") + 256U);
}

TEST(FindPages, AStoreOfTheAddressIsNoAccess) {
    const Passed passed(R"(
@t = internal global [4 x i8] zeroinitializer
@p = internal global ptr null
define void @f(i16 %i) {
  %a = getelementptr inbounds i8, ptr @t, i16 %i
  store ptr %a, ptr @p
  ret void
})",
                        find_pages);
    EXPECT_FALSE(has_note(passed)) << passed.text;
}

TEST(FindPages, LargerVariablesByTheRangeOfTheSubscript) {
    const std::string body = R"(
@t = internal global [600 x i8] zeroinitializer, align 256
define i16 @f(i16 %i) {
  %m = and i16 %i, MASK
  %a = getelementptr inbounds i8, ptr @t, i16 FIXED
  %b = getelementptr inbounds i16, ptr %a, i16 %m
  store i16 -2, ptr %b
  %z = ptrtoint ptr %b to i16
  ret i16 %z
})";
    const auto with = [&](const std::string& mask, const std::string& fixed) {
        std::string text = body;
        text.replace(text.find("MASK"), 4, mask);
        text.replace(text.find("FIXED"), 5, fixed);
        return text;
    };
    struct Case {
        unsigned mask, fixed;
        bool noted;
    };
    // The last element's address: 300 + 2 * 31 = 362 < 512; 450 + 62 = 512.
    for (const auto& [mask, fixed, noted] :
         {Case{31, 300, true}, {31, 449, true}, {31, 450, false}, {255, 0, false}}) {
        const Passed passed(with(std::to_string(mask), std::to_string(fixed)), find_pages);
        EXPECT_EQ(has_note(passed), noted) << passed.text;
        Interpreter interpreter(passed.mir);
        for (const unsigned i : {0U, 1U, 30U, mask}) {
            EXPECT_EQ(interpreter.call("f", {i}), interpreter.address("t") + fixed + 2 * i);
        }
    }
}

// Gaps in RAM cost: alignment grows for small variables only.
TEST(FindPages, LargeVariablesInRamAreLeftAlone) {
    const std::string body = R"( x i8] zeroinitializer
define i8 @f(i16 %i) {
  %a = getelementptr inbounds i8, ptr @t, i16 %i
  %x = load i8, ptr %a
  ret i8 %x
})";
    EXPECT_TRUE(has_note(Passed("@t = internal global [64" + body, find_pages)));
    EXPECT_FALSE(has_note(Passed("@t = internal global [65" + body, find_pages)));
    EXPECT_TRUE(has_note(Passed("@t = internal constant [65" + body, find_pages)));
    EXPECT_TRUE(has_note(Passed("@t = internal constant [256" + body, find_pages)));
    EXPECT_FALSE(has_note(Passed("@t = internal constant [257" + body, find_pages)));
}

TEST(FindPages, VariablesOfOthersAreNotAligned) {
    const Passed passed(R"(
@t = external global [4 x i8]
define i8 @f(i16 %i) {
  %a = getelementptr inbounds i8, ptr @t, i16 %i
  %x = load i8, ptr %a
  ret i8 %x
})",
                        find_pages);
    EXPECT_FALSE(has_note(passed)) << passed.text;
}

}  // namespace
