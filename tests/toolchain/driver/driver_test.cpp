// The pipeline as a function: what one module and several are, the library, inner stages.
#include "toolchain/driver/driver.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include "tests/toolchain/codegen/interpreter.hpp"
#include "tests/toolchain/driver/compile.hpp"

namespace {

using namespace toolchain::driver;
using driver_test::failure_of;
using driver_test::request_for;
using testing::HasSubstr;
using testing::Not;
using toolchain::ir::Optimisation;

constexpr std::array kLevels = {Optimisation::none, Optimisation::less, Optimisation::more,
                                Optimisation::size};

std::set<std::string> functions_of(const toolchain::codegen::Module& module) {
    std::set<std::string> names;
    for (const auto& function : module.functions) names.insert(module.symbols[function.symbol]);
    return names;
}

/// The value of the variable `result`, two bytes, behind main.
uint64_t result_of(const Request& request) {
    const auto module = compile_to_mir(request);
    codegen_test::Interpreter interpreter(module);
    for (const auto constructor : module.constructors) {
        interpreter.call(module.symbols[constructor]);
    }
    interpreter.call("main");
    return interpreter.variable("result", 2);
}

TEST(Driver, OneModuleIsInlinedAndRid) {
    Request request = request_for(
        "int twice(int a);\nint result;\n"
        "int main() { result = twice(21); return 0; }");
    request.sources.push_back(
        {"other.cpp", "int twice(int a) { return a + a; }\nint unused() { return 1; }"});
    request.keep = {"result"};
    EXPECT_EQ(functions_of(compile_to_mir(request)), std::set<std::string>{"main"});
    EXPECT_EQ(result_of(request), 42U);
}

TEST(Driver, SeparateModulesDoNotSeeEachOther) {
    Request request = request_for(
        "extern \"C\" int twice(int a);\nint result;\n"
        "int main() { result = twice(21); return 0; }");
    request.sources.push_back({"other.c", "int twice(int a) { return a + a; }", true});
    request.keep = {"result"};
    EXPECT_EQ(functions_of(compile_to_mir(request)), (std::set<std::string>{"main", "twice"}));
    EXPECT_EQ(result_of(request), 42U);
}

TEST(Driver, SeparateModulesMayUseTheInnerOne) {
    Request request = request_for(
        "int table[2] = {20, 22};\nint sum(void);\nint result;\n"
        "int main(void) { result = sum(); return 0; }",
        "main.c");
    request.sources.push_back(
        {"sum.c", "extern int table[2];\nint sum(void) { return table[0] + table[1]; }", true});
    request.keep = {"result"};
    EXPECT_EQ(result_of(request), 42U);
}

// The numbers are wide enough to tell the functions apart: every byte counts.
TEST(Driver, TheLibraryIsThereWhereItIsNeeded) {
    const std::string text = R"(
        #include <string.h>
        char from[7] = {1, 2, 3, 4, 5, 6, 7}, to[7];
        int result;
        int main(void) {
            void *(*set)(void *, int, size_t) = memset;
            memcpy(to, from, 7);
            memmove(to + 1, to, 3);
            set(to + 5, 9, 2);
            result = memcmp(to, from, 7) < 0 && memcmp(to, to, 7) == 0;
            for (unsigned i = 0; i < 7; i++) result = result * 3 + to[i];
            result += 1000 * (int)strlen("four");
            return 0;
        })";
    // to = 1 1 2 3 5 9 9, and memcmp gives -1: ((((((1*3+1)*3+1)*3+2)*3+3)*3+5)*3+9)*3+9
    uint64_t expected = 1;
    for (const unsigned byte : {1U, 1U, 2U, 3U, 5U, 9U, 9U}) expected = expected * 3 + byte;
    expected += 4000;
    for (const Optimisation level : kLevels) {
        Request request = request_for(text, "use.c", level);
        request.keep = {"result"};
        EXPECT_EQ(result_of(request), expected & 0xFFFF) << static_cast<int>(level);
        request.sources[0].separate = true;
        EXPECT_EQ(result_of(request), expected & 0xFFFF) << static_cast<int>(level);
    }
}

TEST(Driver, AProgramsOwnFunctionComesBeforeTheLibrarys) {
    Request request = request_for(
        "int result;\n"
        "void *memset(void *p, int v, unsigned n) "
        "{ result = 5; return p; }\n"
        "int main(void) { memset(&result, 1, 1); return 0; }",
        "own.c");
    request.keep = {"result"};
    EXPECT_EQ(result_of(request), 5U);
}

TEST(Driver, MainMayEndWithoutReturnAndMayHaveParameters) {
    for (const Optimisation level : kLevels) {
        for (const char* name : {"m.c", "m.cpp"}) {
            Request request = request_for(
                "int result;\n"
                "int main(int n, char **v) { result = n + 3 + !v; }",
                name, level);
            request.keep = {"result"};
            EXPECT_EQ(result_of(request), 4U) << name;
        }
    }
}

TEST(Driver, ConstructorsRunBeforeMain) {
    const std::string text =
        "struct A { int n; A(int a) : n(a) {} ~A() { n = 0; } };\n"
        "int seven() { volatile int x = 7; return x; }\n"
        "A a(seven());\nA b(a.n * 2);\nint result;\n"
        "int main() { result = b.n + a.n; return 0; }";
    for (const Optimisation level : kLevels) {
        Request request = request_for(text, "ctor.cpp", level);
        request.keep = {"result"};
        EXPECT_FALSE(compile_to_mir(request).constructors.empty());
        EXPECT_EQ(result_of(request), 21U);
        request.allow_constructors = false;
        const std::string failure = failure_of([&] { (void)compile_to_mir(request); });
        EXPECT_THAT(failure, HasSubstr("ctor.cpp:3: 'a' is constructed at run time"));
    }
}

TEST(Driver, ConstructorsOfAllSourcesRunByPriority) {
    const std::string part =
        "extern int result;\n"
        "inline int step(int k) { volatile int x = k; return x; }\n"
        "struct Part { explicit Part(int k) { result = result * 10 + step(k); } };\n";
    for (const Optimisation level : kLevels) {
        Request request = request_for(
            part + "Part one(1);\nPart two(2);\nint result = 0;\nint main() {}", "a.cpp", level);
        request.sources.push_back(
            {"b.cpp", part + "Part three(3);\nPart four __attribute__((init_priority(200)))(4);"});
        request.keep = {"result"};
        EXPECT_EQ(result_of(request), 4123U);
    }
}

TEST(Driver, ConstantInitialisationIsNoConstructor) {
    Request request = request_for(
        "struct A { int n; constexpr A(int a) : n(a) {} };\n"
        "A a(7);\nint result;\n"
        "int main() { result = ++a.n; return 0; }");
    request.keep = {"result"};
    request.allow_constructors = false;
    EXPECT_EQ(result_of(request), 8U);
}

TEST(Driver, VirtualFunctionsNeedNoRunTimeTypes) {
    const std::string text = R"(
        struct Shape { virtual int area() const = 0; virtual ~Shape() {} };
        struct Square : Shape {
            int a;
            Square(int n) : a(n) {}
            int area() const override { return a * a; }
        };
        struct Line : Shape { int area() const override { return 0; } };
        Square square(5);
        Line line;
        Shape* volatile shape = &square;
        int result;
        int main() {
            result = shape->area();
            shape = &line;
            result += shape->area() + 1;
            return 0;
        })";
    for (const Optimisation level : kLevels) {
        Request request = request_for(text, "shape.cpp", level);
        request.keep = {"result"};
        EXPECT_EQ(result_of(request), 26U) << static_cast<int>(level);
    }
}

TEST(Driver, AliasesAndWeakNamesAreResolved) {
    const std::string text = R"(
        extern int absent(void) __attribute__((weak));
        int one(void) { return 1; }
        int uno(void) __attribute__((alias("one")));
        __attribute__((weak)) int two(void) { return 3; }
        int result;
        int main(void) { result = uno() + two() + (absent ? absent() : 10); return 0; })";
    for (const Optimisation level : kLevels) {
        Request request = request_for(text, "weak.c", level);
        request.sources.push_back({"strong.c", "int two(void) { return 2; }"});
        request.keep = {"result"};
        EXPECT_EQ(result_of(request), 13U) << static_cast<int>(level);
    }
}

TEST(Driver, StagesAreText) {
    const Request request = request_for("int main() { return 5; }");
    EXPECT_THAT(compile_to_text(request, Text::llvm), HasSubstr("ret i16 5"));
    EXPECT_THAT(compile_to_text(request, Text::mir), HasSubstr("return [05 00]"));
}

TEST(Driver, NothingButMainAndWhatIsKeptStays) {
    Request request = request_for(
        "int counter;\nint step() { return ++counter; }\n"
        "int main() { return 0; }");
    EXPECT_EQ(functions_of(compile_to_mir(request)), std::set<std::string>{"main"});
    request.keep = {"step"};
    EXPECT_EQ(functions_of(compile_to_mir(request)), (std::set<std::string>{"main", "_Z4stepv"}));
}

TEST(Driver, WarningsGoOn) {
    Request request = request_for("int main() { int unused; return 0; }");
    request.front_end = {"-Wall"};
    std::string messages;
    request.messages = [&](std::string_view text) { messages += text; };
    EXPECT_EQ(functions_of(compile_to_mir(request)), std::set<std::string>{"main"});
    EXPECT_THAT(messages, HasSubstr("unused"));
}

TEST(Driver, SourcesMayBeLlvms) {
    const std::string layout =
        "target datalayout = \"e-m:e-p:16:16-i32:16-i64:16-f32:16-f64:16-"
        "a:8-n8:16-S16\"\n";
    const Request request = request_for(layout + "define i16 @main() { ret i16 77 }", "m.ll");
    EXPECT_THAT(compile_to_text(request, Text::mir), HasSubstr("return [4D 00]"));
}

TEST(Driver, LlvmsSourcesOfAnotherTargetAreRefused) {
    const Request request = request_for(
        "target triple = \"x86_64-pc-linux-gnu\"\ndefine i32 @main() { ret i32 7 }", "m.ll");
    EXPECT_EQ(failure_of([&] { (void)compile_to_mir(request); }),
              "m.ll: made for another target ('x86_64-pc-linux-gnu'): compile it with "
              "--target=msp430-none-elf");
    const Request broken = request_for("define i16 @main() {\n  ret i16\n}\n", "m.ll");
    EXPECT_THAT(failure_of([&] { (void)compile_to_mir(broken); }),
                testing::StartsWith("m.ll:3: not readable for LLVM 19: "));
}

TEST(Driver, NamesForPeopleAreCpps) {
    Request request = request_for(R"(
        template <class T> concept Small = sizeof(T) <= 2;
        template <Small T> __attribute__((noinline)) T step(T a) { return a * 3; }
        volatile int v;
        int main() { return step(v); })");
    const Result result = compile_program(request);
    std::string titles;
    for (const auto& placed : result.program.sections) titles += placed.section.title + "\n";
    EXPECT_THAT(titles, HasSubstr("step"));
    EXPECT_THAT(titles, Not(HasSubstr("_Z")));
}

TEST(Driver, NoSourceIsAMistake) {
    EXPECT_EQ(failure_of([] { (void)compile_to_mir({}); }),
              "no source is given: name a .c or .cpp file");
}

}  // namespace
