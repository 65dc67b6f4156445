// Programs through compile(), linked and executed: calls, frames, recursion, data.
#include "toolchain/codegen/compile.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <string>

#include "tests/toolchain/codegen/compiled_program.hpp"
#include "tests/toolchain/ir/ir_program.hpp"

namespace {

using codegen_test::CompiledProgram;
using testing::HasSubstr;
using namespace toolchain::codegen;

/// All programs by the real generator and by the plain one.
class Compile : public testing::TestWithParam<codegen_test::NamedGenerator> {
protected:
    static CompiledProgram program_of(const std::string& text, const CompileOptions& options = {}) {
        return {GetParam().generator, ir_test::to_mir(text), options};
    }

    static std::string refusal_of(const std::string& text, const CompileOptions& options = {}) {
        try {
            (void)program_of(text, options);
        } catch (const Refused& refused) {
            return refused.what();
        }
        return "accepted";
    }
};

INSTANTIATE_TEST_SUITE_P(Generators, Compile, testing::ValuesIn(codegen_test::generators()),
                         codegen_test::generator_name);

const FunctionReport& report_of(const Compiled& compiled, const std::string& name) {
    const auto found = std::ranges::find(compiled.functions, name, &FunctionReport::name);
    if (found == compiled.functions.end()) throw std::runtime_error("no report of " + name);
    return *found;
}

TEST_P(Compile, ArgumentsInRegistersAndMemory) {
    auto program = program_of(R"(
@result = global i64 0
define i64 @mix(i16 %a, i32 %b, i8 %c, i64 %d, i16 %e) noinline {
  %a64 = zext i16 %a to i64
  %b64 = zext i32 %b to i64
  %c64 = zext i8 %c to i64
  %e64 = zext i16 %e to i64
  %1 = mul i64 %a64, 1000003
  %2 = add i64 %1, %b64
  %3 = xor i64 %2, %d
  %4 = mul i64 %3, %c64
  %5 = sub i64 %4, %e64
  ret i64 %5
}
define void @main() {
  %v = call i64 @mix(i16 4660, i32 305419896, i8 77, i64 81985529216486895, i16 9)
  store i64 %v, ptr @result
  ret void
}
)");
    program.run();
    const uint64_t wanted = ((4660ULL * 1000003 + 305419896) ^ 81985529216486895ULL) * 77 - 9;
    EXPECT_EQ(program.variable("result", 8), wanted);
}

constexpr const char* kPointers = R"(
@results = global [4 x i64] zeroinitializer
@table = constant [2 x ptr] [ptr @sum, ptr @difference]
define i64 @sum(i16 %a, i64 %b, i8 %c) {
  %a64 = sext i16 %a to i64
  %c64 = zext i8 %c to i64
  %1 = add i64 %a64, %b
  %2 = add i64 %1, %c64
  ret i64 %2
}
define i64 @difference(i16 %a, i64 %b, i8 %c) {
  %a64 = sext i16 %a to i64
  %c64 = zext i8 %c to i64
  %1 = sub i64 %a64, %b
  %2 = sub i64 %1, %c64
  ret i64 %2
}
define void @one(i16 %i) {
  %at = getelementptr [2 x ptr], ptr @table, i16 0, i16 %i
  %f = load ptr, ptr %at
  %v = call i64 %f(i16 -5, i64 1234567890123, i8 200)
  %to = getelementptr [4 x i64], ptr @results, i16 0, i16 %i
  store i64 %v, ptr %to
  ret void
}
define void @main() {
  call void @one(i16 0)
  call void @one(i16 1)
  %d = call i64 @difference(i16 7, i64 8, i8 9)
  store i64 %d, ptr getelementptr ([4 x i64], ptr @results, i16 0, i16 2)
  ret void
}
)";

TEST_P(Compile, CallsThroughPointers) {
    auto program = program_of(kPointers);
    program.run();
    EXPECT_EQ(program.variable("results", 8), 1234567890123ULL - 5 + 200);
    const auto* results = program.program().find("results");
    ASSERT_NE(results, nullptr);
    EXPECT_EQ(static_cast<int64_t>(program.word_at(results->value + 8U, 8)),
              -5 - 1234567890123 - 200);
    EXPECT_EQ(static_cast<int64_t>(program.word_at(results->value + 16U, 8)), 7 - 8 - 9);
}

TEST_P(Compile, ConstantsAreInRomAndPointersToThemRight) {
    auto program = program_of(kPointers);
    const auto* table = program.program().find("table");
    const auto* sum = program.program().find("sum");
    ASSERT_TRUE(table != nullptr && sum != nullptr);
    EXPECT_LT(table->value, 0x8000);
    program.run();
    EXPECT_EQ(program.word_at(table->value, 2), sum->value);
}

// -- Recursion
// -------------------------------------------------------------------------------------

constexpr const char* kRecursion = R"(
@result = global i32 0
define i32 @deep(ptr %above, i64 %n) {
  %local = alloca [3 x i16]
  %done = icmp eq i64 %n, 0
  br i1 %done, label %leaf, label %again
leaf:
  %v = load i16, ptr %above
  %v32 = zext i16 %v to i32
  ret i32 %v32
again:
  %narrow = trunc i64 %n to i16
  %mid = getelementptr [3 x i16], ptr %local, i16 0, i16 1
  %old = load i16, ptr %above
  %new = add i16 %old, %narrow
  store i16 %new, ptr %mid
  %less = sub i64 %n, 1
  %below = call i32 @deep(ptr %mid, i64 %less)
  %kept = load i16, ptr %mid
  %kept32 = zext i16 %kept to i32
  %scaled = mul i32 %below, 3
  %sum = add i32 %scaled, %kept32
  ret i32 %sum
}
define void @main() {
  %seed = alloca i16
  store i16 100, ptr %seed
  %v = call i32 @deep(ptr %seed, i64 9)
  store i32 %v, ptr @result
  ret void
}
)";

uint32_t deep(uint16_t above, uint64_t n) {
    if (n == 0) return above;
    const auto mid = static_cast<uint16_t>(above + n);
    return deep(mid, n - 1) * 3 + mid;
}

TEST_P(Compile, RecursionKeepsVariablesOfEveryCall) {
    CompileOptions options;
    options.allow_recursion = true;
    auto program = program_of(kRecursion, options);
    program.run();
    EXPECT_EQ(program.variable("result", 4), deep(100, 9));
    EXPECT_FALSE(program.compiled().stack_known);
    EXPECT_TRUE(report_of(program.compiled(), "deep").recursive);
    EXPECT_FALSE(report_of(program.compiled(), "main").recursive);
}

TEST_P(Compile, MutualRecursionThroughAPointer) {
    CompileOptions options;
    options.allow_recursion = true;
    auto program = program_of(R"(
@result = global i16 0
@step = global ptr @odd
define i16 @even(i16 %n) {
  %z = icmp eq i16 %n, 0
  br i1 %z, label %yes, label %no
yes:
  ret i16 1
no:
  %f = load ptr, ptr @step
  %m = sub i16 %n, 1
  %r = call i16 %f(i16 %m)
  %s = add i16 %r, %n
  ret i16 %s
}
define i16 @odd(i16 %n) {
  %z = icmp eq i16 %n, 0
  br i1 %z, label %yes, label %no
yes:
  ret i16 1000
no:
  %m = sub i16 %n, 1
  %r = call i16 @even(i16 %m)
  %s = mul i16 %r, %n
  ret i16 %s
}
define void @main() {
  %v = call i16 @even(i16 5)
  store i16 %v, ptr @result
  ret void
}
)",
                              options);
    program.run();
    // even(5) = 5 + odd(4), odd(4) = 4 * even(3) ...
    const uint16_t even1 = 1 + 1000;
    const uint16_t even3 = 3 + 2 * even1;
    EXPECT_EQ(program.variable("result", 2), 5 + 4 * even3);
}

TEST_P(Compile, RecursionIsRefusedWithItsCycle) {
    EXPECT_EQ(refusal_of(kRecursion),
              "recursion: deep -> deep: static frames hold one call at a time: make it a loop, or "
              "use --allow-recursion");
}

// -- Frames and stack
// ------------------------------------------------------------------------------

constexpr const char* kTree = R"(
@result = global i16 0
define i16 @leaf1(i16 %a) noinline {
  %1 = mul i16 %a, %a
  ret i16 %1
}
define i16 @leaf2(i16 %a) noinline {
  %1 = add i16 %a, 1
  %2 = xor i16 %1, %a
  ret i16 %2
}
define i16 @middle(i16 %a) noinline {
  %1 = call i16 @leaf1(i16 %a)
  %2 = call i16 @leaf2(i16 %1)
  %3 = add i16 %2, %a
  ret i16 %3
}
define void @main() {
  %1 = call i16 @middle(i16 7)
  %2 = call i16 @leaf2(i16 %1)
  store i16 %2, ptr @result
  ret void
}
)";

TEST_P(Compile, FramesOfFunctionsThatAreNeverActiveTogetherOverlap) {
    auto program = program_of(kTree);
    program.run();
    const uint16_t middle = ((49 + 1) ^ 49) + 7;
    EXPECT_EQ(program.variable("result", 2), (middle + 1) ^ middle);
    const auto& compiled = program.compiled();
    const auto& main = report_of(compiled, "main");
    const auto& mid = report_of(compiled, "middle");
    const auto& leaf1 = report_of(compiled, "leaf1");
    const auto& leaf2 = report_of(compiled, "leaf2");
    EXPECT_EQ(main.frame_offset, 0U);
    EXPECT_EQ(mid.frame_offset, main.frame_bytes);
    EXPECT_EQ(leaf1.frame_offset, mid.frame_offset + mid.frame_bytes);
    EXPECT_EQ(leaf2.frame_offset, leaf1.frame_offset);
    EXPECT_EQ(program.program().frames.size,
              leaf1.frame_offset + std::max(leaf1.frame_bytes, leaf2.frame_bytes));
}

TEST_P(Compile, TheStackIsAsDeepAsStated) {
    auto program = program_of(kTree);
    program.run();
    // main, middle, leaf1: three return addresses, and what __mul16 pushes, which leaf1 ends in.
    EXPECT_TRUE(program.compiled().stack_known);
    EXPECT_EQ(program.deepest_stack(), program.compiled().stack_bytes);
    EXPECT_GE(program.compiled().stack_bytes, 6U);
    EXPECT_EQ(report_of(program.compiled(), "leaf2").stack_bytes, 0U);
}

TEST_P(Compile, WhatNobodyReachesIsNotThere) {
    auto program = program_of("define void @unused() {\n ret void\n}\n" + std::string(kTree));
    EXPECT_EQ(program.program().find("unused"), nullptr);
    CompileOptions options;
    options.roots = {"unused"};
    auto kept = program_of("define void @unused() {\n ret void\n}\n" + std::string(kTree), options);
    EXPECT_NE(kept.program().find("unused"), nullptr);
}

// -- Names and data
// --------------------------------------------------------------------------------

TEST_P(Compile, NamesThatTheAssemblerWouldTakeForLocalAreSafe) {
    auto program = program_of(R"(
@.str = private constant [2 x i8] c"a\00"
@.str.1 = private constant [2 x i8] c"b\00"
@_.str = global i8 67
@"odd name" = global i8 3
@result = global i8 0
define void @main() {
  %1 = load i8, ptr @.str
  %2 = load i8, ptr @.str.1
  %3 = load i8, ptr @_.str
  %4 = load volatile i8, ptr @"odd name"
  %5 = add i8 %1, %2
  %6 = add i8 %5, %3
  %7 = add i8 %6, %4
  store i8 %7, ptr @result
  ret void
}
)");
    program.run();
    EXPECT_EQ(program.variable("result", 1), static_cast<uint8_t>('a' + 'b' + 67 + 3));
}

TEST_P(Compile, AStaticLocalIsNotTheFrame) {
    // clang names a static local `x` of f `f.x`.
    auto program = program_of(R"(
@f.frame = global i16 1
@f.args = global i16 2
@f.result = global i16 3
@"f.frame.0" = global i16 4
@result = global i16 0
define i64 @f(i64 %a, i64 %b) noinline {
  %v = alloca i16
  store volatile i16 9, ptr %v
  %1 = load i16, ptr @f.frame
  %2 = load i16, ptr @f.args
  %3 = load i16, ptr @f.result
  %4 = load i16, ptr @f.frame.0
  %5 = add i16 %1, %2
  %6 = add i16 %5, %3
  %7 = add i16 %6, %4
  %8 = zext i16 %7 to i64
  %9 = add i64 %8, %a
  %10 = add i64 %9, %b
  ret i64 %10
}
define void @main() {
  %1 = call i64 @f(i64 100, i64 1000)
  %2 = trunc i64 %1 to i16
  store i16 %2, ptr @result
  ret void
}
)");
    program.run();
    EXPECT_EQ(program.variable("result", 2), 1110U);
}

TEST_P(Compile, MainMustBeThere) {
    EXPECT_EQ(refusal_of("define void @start() {\n ret void\n}\n"),
              "no function 'main' is defined");
}

}  // namespace
