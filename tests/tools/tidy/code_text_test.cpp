#include "tools/tidy/code_text.hpp"

#include <gtest/gtest.h>

namespace {

using tidy::blank_comments_and_literals;
using tidy::CodeStructure;
using tidy::scan_structure;
using tidy::split_lines;

TEST(SplitLines, LastLineCountsWithAndWithoutItsEnd) {
    EXPECT_EQ(split_lines("a\nb\n"), (std::vector<std::string>{"a", "b"}));
    EXPECT_EQ(split_lines("a\n\nb"), (std::vector<std::string>{"a", "", "b"}));
    EXPECT_TRUE(split_lines("").empty());
}

TEST(BlankComments, CommentsBecomeBlanksOfTheSameLength) {
    EXPECT_EQ(blank_comments_and_literals("a; // b\nc"), "a;     \nc");
    EXPECT_EQ(blank_comments_and_literals("a /* b\nc */ d"), "a     \n     d");
    EXPECT_EQ(blank_comments_and_literals("a /* open"), "a        ");
}

TEST(BlankComments, StringContentsBecomeBlanksAndQuotesStay) {
    EXPECT_EQ(blank_comments_and_literals(R"(f("// no", 'x');)"), R"(f("     ", ' ');)");
    EXPECT_EQ(blank_comments_and_literals(R"("a\"b" c)"), R"("    " c)");
    EXPECT_EQ(blank_comments_and_literals(R"('\'' c)"), R"('  ' c)");
}

TEST(BlankComments, RawStringsEndAtTheirOwnDelimiter) {
    EXPECT_EQ(blank_comments_and_literals("R\"x(a)\" { )x\" b"), "R             b");
}

TEST(BlankComments, DigitSeparatorsAreNotCharacterLiterals) {
    EXPECT_EQ(blank_comments_and_literals("0xFF'FFu + 1'000 + 'a'"), "0xFF'FFu + 1'000 + ' '");
}

TEST(BlankComments, IncludePathsStay) {
    EXPECT_EQ(blank_comments_and_literals("#include \"hal/io.hpp\"  // why"),
              "#include \"hal/io.hpp\"        ");
}

TEST(ScanStructure, FunctionSpansFromItsHeadToItsClosingBrace) {
    const CodeStructure code = scan_structure(
        "namespace a {\n"   // 1
        "int f(int x,\n"    // 2
        "      int y) {\n"  // 3
        "    if (x) {\n"    // 4
        "        g();\n"    // 5
        "    }\n"           // 6
        "}\n"               // 7
        "struct S {\n"      // 8
        "    int h() const { return 1; }\n"
        "};\n"
        "}\n");
    ASSERT_EQ(code.functions.size(), 2u);
    EXPECT_EQ(code.functions[0].first_line, 2);
    EXPECT_EQ(code.functions[0].last_line, 7);
    EXPECT_EQ(code.functions[0].line_count(), 6);
    EXPECT_EQ(code.functions[1].first_line, 9);
}

TEST(ScanStructure, RecognisesTheFormsOfFunctionHeads) {
    for (const char* text : {
             "void f() {\n}",
             "auto f() -> int {\n}",
             "int f() const noexcept {\n}",
             "template <class T>\nvoid f(T t) requires Word<T> {\n}",
             "S::S(int a) : a_(a) {\n}",
             "S::S(int a) : a_{a} {\n}",
             "TEST(A, B) {\n}",
             "bool operator==(S a, S b) {\n}",
         }) {
        EXPECT_EQ(scan_structure(text).functions.size(), 1u) << text;
    }
}

TEST(ScanStructure, DataAndTypesAreNoFunctions) {
    for (const char* text : {
             "int a[] = {1, 2};",
             "struct S {\n    int a = 0;\n};",
             "enum class E : int { a, b };",
             "namespace a::b {\n}",
             "template <class T>\nstruct S : Base<T> {\n};",
             "#define F(x) \\\n    { x }\nint a;",
         }) {
        EXPECT_TRUE(scan_structure(text).functions.empty()) << text;
    }
}

TEST(ScanStructure, DeclarationsOfFunctionsAreSeen) {
    for (const char* text : {"void f(int x);", "struct S {\n    int g() const noexcept;\n};",
                             "auto f(int x,\n       int y) -> int;"}) {
        EXPECT_TRUE(scan_structure(text).declares_functions) << text;
    }
    for (const char* text : {"int a = f(1);", "static_assert(sizeof(int) == 4);",
                             "struct S {\n    S() = delete;\n    int a{f(1)};\n};",
                             "using F = void (int);", "void f() { g(1); }"}) {
        EXPECT_FALSE(scan_structure(text).declares_functions) << text;
    }
}

TEST(ScanStructure, ConstantLinesAreThoseTheCompilerEvaluates) {
    const CodeStructure code = scan_structure(
        "constexpr double kA = 1.5;\n"      // 1 constant
        "constexpr double kTable[] = {\n"   // 2 constant
        "    1.0 * 2,\n"                    // 3 constant
        "};\n"                              // 4
        "consteval double f() {\n"          // 5 constant
        "    return 1.0;\n"                 // 6 constant
        "}\n"                               // 7
        "static_assert(1.0 > 0.5,\n"        // 8 constant
        "              \" \");\n"           // 9 constant
        "enum E { a = 1 << 3 };\n"          // 10 constant
        "constexpr double g(double x) {\n"  // 11 a constexpr function may run
        "    if constexpr (a == b) {\n"     // 12
        "        return x;\n"               // 13
        "    }\n"
        "}\n");
    for (const int line : {1, 2, 3, 5, 6, 8, 9, 10}) {
        EXPECT_TRUE(code.constant_line[static_cast<std::size_t>(line - 1)]) << "line " << line;
    }
    for (const int line : {11, 12, 13}) {
        EXPECT_FALSE(code.constant_line[static_cast<std::size_t>(line - 1)]) << "line " << line;
    }
}

TEST(ScanStructure, UnbalancedBracesAreNoError) {
    EXPECT_NO_THROW(scan_structure("}}}} void f() {"));
    EXPECT_NO_THROW(scan_structure("((((;"));
}

}  // namespace
