// Programs in C++ at every level of optimisation, executed behind the whole pipeline; expected
// values by hand from the language's rules.
#include "toolchain/ir/prepare.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <string>

#include "tests/toolchain/ir/ir_program.hpp"

namespace {

class Language : public testing::TestWithParam<std::string> {
protected:
    /// The result of `extern "C" unsigned f(unsigned)` behind the static constructors.
    uint64_t run(const std::string& source, uint64_t argument) {
        llvm::LLVMContext context;
        const auto mir = ir_test::to_mir(*ir_test::compile(source, GetParam(), context));
        codegen_test::Interpreter interpreter(mir);
        for (const auto constructor : mir.constructors) {
            interpreter.call(mir.symbols[constructor]);
        }
        return interpreter.call("f", {argument});
    }
};

TEST_P(Language, StructsByValue) {
    const std::string source = R"(
struct Small { char a; };
struct Large { int a[9]; Small s; };
[[gnu::noinline]] Large change(Large l, Small s) { l.a[4] += 100; l.s.a += s.a; return l; }
[[gnu::noinline]] int sum(Large l) {
    int s = l.s.a;
    for (int x : l.a) s += x;
    l.a[0] = 7;
    return s;
}
extern "C" unsigned f(unsigned n) {
    Large l{};
    for (int i = 0; i < 9; ++i) l.a[i] = int(n) + i;
    l.s.a = 3;
    Large m = change(l, Small{5});
    return unsigned(sum(l) * 10 + sum(m) + l.a[0] + l.a[4]);  // neither callee changes l
})";
    // sum(l) = 9n + 36 + 3, sum(m) = 9n + 36 + 100 + 8, plus n and n + 4
    EXPECT_EQ(run(source, 2), (9U * 2 + 39) * 10 + (9U * 2 + 144) + 2 + 6);
}

TEST_P(Language, BitFields) {
    const std::string source = R"(
struct B { long long x : 40; int y : 7; unsigned long z : 24; unsigned w : 3; };
B b{-2, -3, 0xABCDEF, 5};
extern "C" unsigned f(unsigned n) {
    b.x -= n; b.y += int(n); b.z += n; b.w += n;
    if (b.x != -2 - (long long)n) return 1;
    if (b.y != int(n) - 3) return 2;
    if (b.z != 0xABCDEF + n) return 3;
    if (b.w != ((5 + n) & 7)) return 4;
    return sizeof(B);  // packed: 40 + 7 + 24 + 3 bits
})";
    EXPECT_EQ(run(source, 4), 10U);
}

TEST_P(Language, VirtualFunctionsAndPointers) {
    const std::string source = R"(
struct Shape {
    virtual int area() const = 0;
    virtual int twice() const { return 2 * area(); }
    int k;
};
struct Square : Shape { int a; int area() const override { return a * a; } };
struct Line : Shape {
    int area() const override { return 0; }
    int twice() const override { return k; }
};
void operator delete(void*, unsigned) {}
extern "C" void __cxa_pure_virtual() {}
Square square; Line line;
int add(int a, int b) { return a + b; }
int sub(int a, int b) { return a - b; }
int (*const operations[])(int, int) = {add, sub};
extern "C" unsigned f(unsigned n) {
    square.a = int(n); line.k = 9;
    const Shape* shapes[] = {&square, &line};
    int sum = 0;
    for (const Shape* s : shapes) sum += s->twice();
    return unsigned(operations[n & 1](sum, 4));
})";
    EXPECT_EQ(run(source, 5), 50U + 9 - 4);
    EXPECT_EQ(run(source, 6), 72U + 9 + 4);
}

TEST_P(Language, StaticObjects) {
    const std::string source = R"(
struct Counter { int n; Counter(int start) : n(start) {} ~Counter() { n = 0; } };
volatile int seed = 11;
Counter global(seed);
int next() { static Counter local(seed + 1); return local.n++; }
extern "C" unsigned f(unsigned n) { next(); return unsigned(next() * 100 + global.n + int(n)); })";
    EXPECT_EQ(run(source, 1), 1300U + 11 + 1);
}

TEST_P(Language, SwitchesLoopsAndWideArithmetic) {
    const std::string source = R"(
static unsigned char kind(unsigned n) {
    switch (n) {
        case 0: return 10; case 1: return 20; case 2: return 35; case 3: return 40;
        case 5: return 17; case 6: return 80; case 1000: return 1; default: return 2;
    }
}
static unsigned long long series(long long n) {
    unsigned long long s = 0;
    for (long long i = 0; i < n; ++i) s += (unsigned long long)(i * i);
    return s;
}
extern "C" unsigned f(unsigned n) {
    unsigned s = 0;
    for (unsigned i = 0; i <= n; ++i) s += kind(i);
    const unsigned long long q = series((long long)n * 100000 % 90);
    return s + unsigned(q >> 3);
})";
    // 0..7: 10+20+35+40+2+17+80+2 = 206; 700000 mod 90 = 70; sum of squares below 70 = 111895
    EXPECT_EQ(run(source, 7), 206U + 111895 / 8);
}

TEST_P(Language, UnusualIntegers) {
    const std::string source = R"(
extern "C" unsigned f(unsigned n) {
    long long product;
    const bool over = __builtin_mul_overflow((long long)n << 40, 1LL << 20, &product);
    unsigned char small;
    const bool over8 = __builtin_add_overflow((unsigned char)n, (unsigned char)250, &small);
    return unsigned(over) + 2 * over8 + 4 * (__builtin_popcountll(0x1234567890ULL * n) & 15) +
           unsigned(__builtin_bswap32(0x12345678UL + n) >> 24) * 64;
})";
    // 9 << 60 overflows; 9 + 250 does; 1234567890H * 9 = A3D70A3D10H has 18 one bits; bswap: 81H
    EXPECT_EQ(run(source, 9), 1U + 2 + 4 * (18 & 15) + 0x81U * 64);
}

INSTANTIATE_TEST_SUITE_P(AllLevels, Language, testing::Values("0", "1", "2", "s"),
                         [](const auto& test) { return "O" + test.param; });

TEST(Prepare, SelectsBecomeBranches) {
    const auto mir = ir_test::to_mir(R"(
define i16 @f(i16 %a) {
  %small = icmp ult i16 %a, 10
  %x = select i1 %small, i16 100, i16 200
  %y = select i1 %small, i16 %a, i16 %x
  ret i16 %y
})");
    codegen_test::Interpreter interpreter(mir);
    EXPECT_EQ(interpreter.call("f", {3}), 3U);
    EXPECT_EQ(interpreter.call("f", {10}), 200U);
}

}  // namespace
