// What cannot be compiled is refused with its place and a reason; nothing else is.
#include "toolchain/ir/refuse.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <string>

#include "tests/toolchain/ir/ir_program.hpp"

namespace {

using ir_test::refusal;
using testing::Test;

/// Debug information for a function `f` from line 7 of a.c, and a place in its line 9.
constexpr const char* kPlaces = R"(
!llvm.dbg.cu = !{!0}
!llvm.module.flags = !{!9}
!0 = distinct !DICompileUnit(language: DW_LANG_C, file: !1, emissionKind: FullDebug, globals: !{!6})
!1 = !DIFile(filename: "a.c", directory: "/")
!2 = distinct !DISubprogram(name: "f", file: !1, line: 7, type: !3, unit: !0,
                            spFlags: DISPFlagDefinition)
!3 = !DISubroutineType(types: !{})
!4 = !DILocation(line: 9, scope: !2)
!5 = !DILocation(line: 0, scope: !2)
!6 = !DIGlobalVariableExpression(var: !7, expr: !DIExpression())
!7 = distinct !DIGlobalVariable(name: "g", scope: !0, file: !1, line: 3, type: !8)
!8 = !DIBasicType(name: "t", size: 32)
!9 = !{i32 2, !"Debug Info Version", i32 3}
)";

std::string with_place(const std::string& text) {
    return refusal(text + kPlaces);
}

TEST(Refuse, NamesTheLineOfTheInstruction) {
    EXPECT_EQ(with_place("define void @f(ptr %p, i16 %a) !dbg !2 {\n"
                         "  %x = sitofp i16 %a to float, !dbg !4\n"
                         "  store float %x, ptr %p, !dbg !4\n  ret void\n}"),
              "a.c:9: in f: floating point: the 8085 has none; use a Q format");
}

TEST(Refuse, NamesTheLineOfTheFunctionOtherwise) {
    for (const char* place : {"", ", !dbg !5"}) {
        EXPECT_EQ(with_place(fmt::format("define void @f(i16 %n) !dbg !2 {{\n"
                                         "  %x = alloca i8, i16 %n{}\n  ret void\n}}",
                                         place)),
                  "a.c:7: in f: a variable whose size is known only at run time: frames are "
                  "static");
    }
    EXPECT_EQ(with_place("define void @f(...) !dbg !2 {\n  ret void\n}"),
              "a.c:7: in f: a variable argument list: frames are static; pass a pointer and a "
              "count");
}

TEST(Refuse, NamesTheLineOfAVariable) {
    EXPECT_EQ(with_place("@g = global [2 x {i8, float}] zeroinitializer, !dbg !6"),
              "a.c:3: in g: floating point: the 8085 has none; use a Q format");
    EXPECT_EQ(with_place("@g = thread_local global i16 0, !dbg !6"),
              "a.c:3: in g: thread_local: there is one thread");
    EXPECT_EQ(with_place("@h = global i8 0\n@i = global i8 0\n@g = global i8 ptrtoint (ptr "
                         "getelementptr (i8, ptr @h, i16 ptrtoint (ptr @i to i16)) to i8), "
                         "!dbg !6")
                  .find("a.c:3: in g: constant expression not supported"),
              0U);
}

TEST(Refuse, AllInOneGo) {
    EXPECT_EQ(with_place("@g = global float 0.0, !dbg !6\n"
                         "define float @f(ptr %p) !dbg !2 {\n"
                         "  %x = load float, ptr %p, !dbg !4\n  ret float %x, !dbg !4\n}"),
              "a.c:3: in g: floating point: the 8085 has none; use a Q format\n"
              "a.c:9: in f: floating point: the 8085 has none; use a Q format");
}

struct Example {
    const char* text;
    const char* why;
};

class RefuseInstruction : public testing::TestWithParam<Example> {};

TEST_P(RefuseInstruction, SaysWhy) {
    const std::string message = refusal(GetParam().text);
    EXPECT_NE(message.find(GetParam().why), std::string::npos) << message;
}

INSTANTIATE_TEST_SUITE_P(
    All, RefuseInstruction,
    testing::Values(
        Example{"define double @f(double %a) {\n ret double %a\n}", "floating point"},
        Example{"declare void @g(half)\ndefine void @f() {\n call void @g(half 1.0)\n ret void\n}",
                "floating point"},
        Example{"define void @f(<2 x i8> %a) {\n ret void\n}", "a vector"},
        Example{"define void @f(i200 %a) {\n ret void\n}", "more than 128 bits"},
        Example{"define i128 @f(i128 %a) {\n %r = udiv i128 %a, 3\n ret i128 %r\n}",
                "division of more than 64 bits"},
        Example{"define i128 @f(i128 %a, i128 %b) {\n %r = shl i128 %a, %b\n ret i128 %r\n}",
                "shift of more than 64 bits"},
        Example{"define i8 @f(ptr addrspace(1) %p) {\n %r = load i8, ptr addrspace(1) %p\n ret i8 "
                "%r\n}",
                "address space"},
        Example{"declare void @g(...)\ndefine void @f() {\n call void (...) @g(i16 1)\n ret "
                "void\n}",
                "variable number of arguments"},
        Example{"declare ptr @llvm.stacksave.p0()\ndefine void @f() {\n %p = call ptr "
                "@llvm.stacksave.p0()\n ret void\n}",
                "known only at run time"},
        Example{"define void @f() {\n call void asm sideeffect \"nop\", \"\"()\n ret void\n}",
                "inline assembly"},
        Example{"define i8 @f(ptr %p) {\n %r = atomicrmw add ptr %p, i8 1 seq_cst\n ret i8 %r\n}",
                "atomic read-modify-write"},
        Example{"define i16 @f(ptr %p) {\n %r = load atomic i16, ptr %p seq_cst, align 2\n ret "
                "i16 %r\n}",
                "atomic load of more than a byte"},
        Example{"define void @f(ptr %p) {\n store atomic i16 1, ptr %p seq_cst, align 2\n ret "
                "void\n}",
                "atomic store of more than a byte"},
        Example{"define void @f(ptr %p) {\n indirectbr ptr %p, [label %a]\na:\n ret void\n}",
                "computed goto"},
        Example{"@f = ifunc void (), ptr @g\ndefine ptr @g() {\n ret ptr null\n}", "ifunc"},
        Example{"declare i64 @llvm.readcyclecounter()\ndefine i64 @f() {\n %r = call i64 "
                "@llvm.readcyclecounter()\n ret i64 %r\n}",
                "'llvm.readcyclecounter' is not supported"},
        Example{"define void @g(i16 %a) {\n ret void\n}\ndefine void @f() {\n call void @g(i8 1)\n "
                "ret void\n}",
                "'g' is called with other parameters"},
        Example{"declare i8 @__i85_in(i8)\ndefine i8 @f(i8 %p) {\n %r = call i8 @__i85_in(i8 %p)\n "
                "ret i8 %r\n}",
                "known at compile time"}),
    [](const auto& test) { return fmt::format("Example{}", test.index); });

TEST(Refuse, WhatMeansNothingHereIsAccepted) {
    EXPECT_EQ(refusal("define i8 @f(ptr %p) {\n"
                      "  call void asm sideeffect \"\", \"~{memory}\"()\n"
                      "  fence syncscope(\"singlethread\") seq_cst\n"
                      "  store atomic i8 1, ptr %p seq_cst, align 1\n"
                      "  %r = load atomic i8, ptr %p seq_cst, align 1\n  ret i8 %r\n}"),
              "accepted");
    EXPECT_EQ(refusal("declare void @g(...)\n"
                      "define void @f() {\n  call void (...) @g()\n  ret void\n}"),
              "accepted");
}

}  // namespace
