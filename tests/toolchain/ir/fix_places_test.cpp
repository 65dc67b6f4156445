// Pointer parameters with one place, and those that must stay.
#include <gtest/gtest.h>

#include "tests/toolchain/ir/ir_program.hpp"

namespace {

using codegen_test::Interpreter;

/// The text behind the pass, and the whole pipeline's result.
struct Fixed {
    explicit Fixed(const std::string& source) {
        llvm::LLVMContext context;
        const auto module = ir_test::parse(source, context);
        toolchain::ir::fix_places(*module);
        llvm::raw_string_ostream stream(text);
        if (llvm::verifyModule(*module, &stream)) throw std::runtime_error(text);
        module->print(stream, nullptr);
        mir = ir_test::to_mir(*module);
    }
    [[nodiscard]] bool has(const std::string& words) const {
        return text.find(words) != std::string::npos;
    }
    [[nodiscard]] const toolchain::codegen::Function& function(const std::string& name) const {
        for (const auto& function : mir.functions) {
            if (mir.symbols[function.symbol] == name) return function;
        }
        throw std::runtime_error(name + " is not there");
    }

    std::string text;
    toolchain::codegen::Module mir;
};

TEST(FixPlaces, ACalleeKnowsItsOnlyCallersVariable) {
    const Fixed fixed(R"(
define internal void @fill(ptr %out, i16 %a) noinline {
  %high = getelementptr i8, ptr %out, i16 2
  store i16 %a, ptr %out
  store i16 7, ptr %high
  ret void
}
define i16 @f(i16 %a) {
  %pair = alloca [2 x i16], align 4
  call void @llvm.lifetime.start.p0(i64 4, ptr %pair)
  call void @fill(ptr %pair, i16 %a)
  %high = getelementptr i8, ptr %pair, i16 2
  %x = load i16, ptr %pair
  %y = load i16, ptr %high
  %sum = add i16 %x, %y
  call void @llvm.lifetime.end.p0(i64 4, ptr %pair)
  ret i16 %sum
})");
    EXPECT_TRUE(fixed.has("define internal void @fill(i16 %a)")) << fixed.text;
    EXPECT_FALSE(fixed.has("alloca")) << fixed.text;
    EXPECT_TRUE(fixed.mir.variables.empty()) << "the variable stays in the frame";
    ASSERT_EQ(fixed.function("f").frame.size(), 1U);
    EXPECT_EQ(fixed.function("f").frame[0].size, 4U);
    EXPECT_EQ(fixed.function("f").frame[0].alignment, 4U);
    Interpreter interpreter(fixed.mir);
    EXPECT_EQ(interpreter.call("f", {35}), 42U);
}

TEST(FixPlaces, ThroughTwoCallsAndWithAnOffset) {
    const Fixed fixed(R"(
@table = internal global [4 x i8] c"\01\02\03\04"
define internal void @inner(ptr %out, ptr %from) noinline {
  %x = load i8, ptr %from
  store i8 %x, ptr %out
  ret void
}
define internal void @outer(ptr %out, ptr %from) noinline {
  %second = getelementptr i8, ptr %out, i16 1
  %last = getelementptr i8, ptr %from, i16 2
  call void @inner(ptr %second, ptr %last)
  ret void
}
define i8 @f() {
  %pair = alloca [2 x i8]
  %from = getelementptr i8, ptr @table, i16 1
  call void @outer(ptr %pair, ptr %from)
  %second = getelementptr i8, ptr %pair, i16 1
  %x = load i8, ptr %second
  ret i8 %x
})");
    EXPECT_TRUE(fixed.has("void @inner()")) << fixed.text;
    EXPECT_TRUE(fixed.has("void @outer()")) << fixed.text;
    Interpreter interpreter(fixed.mir);
    EXPECT_EQ(interpreter.call("f"), 4U);
}

// "argmem: write" would let the load before the call stand for the one behind it.
TEST(FixPlaces, PromisesAboutMemoryAreMadeAnew) {
    const Fixed fixed(R"(
define internal void @fill(ptr %out) noinline nounwind willreturn memory(argmem: write) {
  store i8 9, ptr %out
  ret void
}
define i8 @f() memory(none) {
  %x = alloca i8
  store i8 3, ptr %x
  %before = load i8, ptr %x
  call void @fill(ptr %x) memory(argmem: write)
  %behind = load i8, ptr %x
  %sum = add i8 %before, %behind
  ret i8 %sum
})");
    EXPECT_TRUE(fixed.has("void @fill()")) << fixed.text;
    Interpreter interpreter(fixed.mir);
    EXPECT_EQ(interpreter.call("f"), 12U);
}

TEST(FixPlaces, TwoPlacesStayAParameter) {
    const Fixed fixed(R"(
define internal void @fill(ptr %out) noinline {
  store i8 9, ptr %out
  ret void
}
define i8 @f() {
  %x = alloca [2 x i8]
  %second = getelementptr i8, ptr %x, i16 1
  call void @fill(ptr %x)
  call void @fill(ptr %second)
  %a = load i8, ptr %x
  %b = load i8, ptr %second
  %sum = add i8 %a, %b
  ret i8 %sum
})");
    EXPECT_TRUE(fixed.has("void @fill(ptr")) << fixed.text;
    Interpreter interpreter(fixed.mir);
    EXPECT_EQ(interpreter.call("f"), 18U);
}

// Each call of @f has an %x of its own, and @deep writes into that of the outer one.
constexpr const char* kRecursive = R"(
define internal void @deep(ptr %out, i8 %n) noinline {
  %more = icmp ne i8 %n, 0
  br i1 %more, label %again, label %out_of
again:
  %less = sub i8 %n, 1
  %r = call i8 @f(i8 %less)
  br label %out_of
out_of:
  store i8 %n, ptr %out
  ret void
}
define i8 @f(i8 %n) {
  %x = alloca i8
  call void @deep(ptr %x, i8 %n)
  %v = load i8, ptr %x
  ret i8 %v
})";

TEST(FixPlaces, VariablesOfRecursiveFunctionsStay) {
    const Fixed fixed(kRecursive);
    EXPECT_TRUE(fixed.has("void @deep(ptr")) << fixed.text;
    EXPECT_TRUE(fixed.has("alloca i8")) << fixed.text;
}

TEST(FixPlaces, AFunctionThatMayBeCalledThroughAPointerIsRecursiveWithItsCaller) {
    const Fixed fixed(R"(
@hook = global ptr null
define internal void @fill(ptr %out) noinline {
  store i8 1, ptr %out
  %to = load ptr, ptr @hook
  call void %to()
  ret void
}
define void @g() {
  %x = alloca i8
  call void @fill(ptr %x)
  store volatile ptr @g, ptr @hook
  ret void
})");
    EXPECT_TRUE(fixed.has("void @fill(ptr")) << fixed.text;
}

TEST(FixPlaces, WhatOthersMayCallStays) {
    for (const std::string linkage : {"", "internal"}) {
        const Fixed fixed("@hook = global ptr @fill\ndefine " + linkage +
                          R"( void @fill(ptr %out) noinline {
  store i8 1, ptr %out
  ret void
}
define i8 @f() {
  %x = alloca i8
  call void @fill(ptr %x)
  %v = load i8, ptr %x
  ret i8 %v
})");
        EXPECT_TRUE(fixed.has("void @fill(ptr")) << fixed.text;
    }
}

// The callee may change its copy: the caller's variable is another one.
TEST(FixPlaces, ArgumentsByValueStay) {
    const Fixed fixed(R"(
define internal i8 @change(ptr byval(i8) %in) noinline {
  store i8 9, ptr %in
  %v = load i8, ptr %in
  ret i8 %v
}
define i8 @f() {
  %x = alloca i8
  store i8 3, ptr %x
  %nine = call i8 @change(ptr byval(i8) %x)
  %three = load i8, ptr %x
  %sum = add i8 %nine, %three
  ret i8 %sum
})");
    Interpreter interpreter(fixed.mir);
    EXPECT_EQ(interpreter.call("f"), 12U) << fixed.text;
}

}  // namespace
