// Programs end to end: one for each feature of the language, compiled at every level, run on the
// simulated processor. Expected values: the same text compiled for the host, or worked out beside
// it.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/toolchain/driver/compile.hpp"
#include "tests/toolchain/driver/run_program.hpp"

namespace {

using namespace toolchain::driver;
using driver_test::Machine;
using driver_test::request_for;
using toolchain::ir::Optimisation;

struct Feature {
    const char* name;
    const char* file;
    std::string text;   ///< leaves its checksum in `result`
    uint32_t expected;  ///< of 16 bits
    bool allow_recursion = false;
};

void PrintTo(const Feature& feature, std::ostream* stream) {
    *stream << feature.name;
}

class Features : public testing::TestWithParam<std::tuple<Feature, int>> {};

TEST_P(Features, GiveTheirResult) {
    const auto& [feature, level] = GetParam();
    Request request = request_for(feature.text, feature.file, static_cast<Optimisation>(level));
    request.keep = {"result"};
    request.allow_recursion = feature.allow_recursion;
    if (feature.allow_recursion) request.stack_bytes = 8000;
    const Result compiled = compile_program(request);
    Machine machine(compiled);
    machine.run();
    EXPECT_EQ(machine.variable("result", 2), feature.expected);
    // Nothing has been pushed beyond what the compiler says.
    const auto& stack = compiled.program.stack;
    for (uint32_t below = stack.first; below > stack.first - 8 && stack.size != 0; --below) {
        EXPECT_EQ(machine.machine().memory.bytes[below - 1], 0x5A) << "below the stack";
    }
}

const std::vector<Feature> kFeatures = {
    {"StructsByValueAndReference", "f.cpp", R"(
        struct Point { int x, y; unsigned char tag; };
        volatile int seed = 5;
        __attribute__((noinline)) Point moved(Point p, int by) { p.x += by; p.tag++; return p; }
        __attribute__((noinline)) void scale(Point& p, int by) { p.x *= by; p.y *= by; }
        int result;
        int main() {
            Point a = {seed, 2, 3};
            Point b = moved(a, 10);
            scale(b, 3);
            result = a.x * 1000 + a.tag * 100 + b.x + b.y + b.tag;
        })",
     5 * 1000 + 3 * 100 + 45 + 6 + 4},
    {"BigStructs", "f.c", R"(
        struct Big { char c[37]; int n; };
        volatile int seed = 7;
        __attribute__((noinline)) struct Big fill(struct Big b, int n) {
            for (int i = 0; i < 37; i++) b.c[i] = i * n;
            b.n += n;
            return b;
        }
        int result;
        int main(void) {
            struct Big a = {{1}, 100};
            struct Big b = fill(a, seed);
            result = a.c[0] + a.n + b.n + (unsigned char)b.c[36];
        })",
     1 + 100 + 107 + (36 * 7 & 255)},
    {"Arrays", "f.c", R"(
        static const unsigned char table[3][4] = {{1,2,3,4},{5,6,7,8},{9,10,11,12}};
        int grid[4][3];
        volatile unsigned char limit = 4;
        int result;
        int main(void) {
            for (unsigned char i = 0; i < limit; i++)
                for (unsigned char j = 0; j < 3; j++) grid[i][j] = table[j][i] * (i + 1);
            for (unsigned char i = 0; i < limit; i++) result = result * 2 + grid[i][i % 3];
        })",
     ((1 * 2 + 6 * 2) * 2 + 11 * 3) * 2 + 4 * 4},
    {"BitFields", "f.c", R"(
        struct Bits { unsigned a : 3; int b : 5; unsigned c : 11; unsigned long d : 20; } bits;
        volatile int seed = -7;
        int result;
        int main(void) {
            bits.a = 13; bits.b = seed; bits.c = 2047 + 5; bits.d = 0xABCDE;
            bits.b -= 3; bits.c++;
            result = bits.a * 1000 + bits.b * 100 + bits.c + (bits.d >> 12);
        })",
     static_cast<uint16_t>(5 * 1000 - 10 * 100 + 5 + 0xAB)},
    {"Switches", "f.c", R"(
        __attribute__((noinline)) int dense(unsigned char n) {
            switch (n) {
                case 0: return 11; case 1: return 7; case 2: return 5; case 3: return 23;
                case 4: return 2; case 5: return 31; case 6: return 1; case 8: return 9;
                default: return 100;
            }
        }
        __attribute__((noinline)) int sparse(int n) {
            switch (n) { case -300: return 1; case 4: return 2; case 1000: return 3;
                         case 1001: return 4; case 20000: return 5; }
            return 6;
        }
        volatile unsigned char turns = 10;
        int result;
        int main(void) {
            static const int values[] = {-300, 4, 1000, 1001, 20000, 999, -301};
            for (unsigned char i = 0; i < turns; i++) result = result * 3 + dense(i);
            for (unsigned char i = 0; i < 7; i++) result = result * 3 + sparse(values[i]);
        })",
     [] {
         uint32_t result = 0;
         for (const unsigned value :
              {11U, 7U, 5U, 23U, 2U, 31U, 1U, 100U, 9U, 100U, 1U, 2U, 3U, 4U, 5U, 6U, 6U}) {
             result = (result * 3 + value) & 0xFFFF;
         }
         return result;
     }()},
    {"FunctionPointers", "f.c", R"(
        static int add(int a, int b) { return a + b; }
        static int sub(int a, int b) { return a - b; }
        static int mul(int a, int b) { return a * b; }
        static int (*const operations[])(int, int) = {add, sub, mul};
        volatile unsigned char turns = 3;
        int result;
        int main(void) {
            for (unsigned char i = 0; i < turns; i++) result = result * 10 + operations[i](9, 4);
        })",
     (13 * 10 + 5) * 10 + 36},
    {"VirtualCalls", "f.cpp", R"(
        struct Shape { virtual int area() const = 0; virtual int edges() const { return 0; }
                       virtual ~Shape() {} };
        struct Box : Shape { int a, b; Box(int x, int y) : a(x), b(y) {}
                             int area() const override { return a * b; }
                             int edges() const override { return 4; } };
        struct Disc : Shape { int r; explicit Disc(int x) : r(x) {}
                              int area() const override { return 3 * r * r; } };
        Box box(6, 7);
        Disc disc(5);
        const Shape* const shapes[] = {&box, &disc};
        volatile unsigned char turns = 2;
        int result;
        int main() {
            for (unsigned char i = 0; i < turns; i++)
                result = result * 100 + shapes[i]->area() + shapes[i]->edges();
        })",
     46 * 100 + 75},
    {"StaticLocals", "f.cpp", R"(
        volatile int seed = 4;
        __attribute__((noinline)) int next() { static int n = seed * 2; static char calls;
                                               return n += ++calls; }
        int result;
        int main() { next(); next(); result = next(); })",
     8 + 1 + 2 + 3},
    {"ConstantTablesAndData", "f.c", R"(
        const char *const words[] = {"zero", "one", "three"};
        int counts[5] = {1, 1000, -5};
        unsigned char cleared[100];
        const struct { const char *name; int *where; } entry = {"x", &counts[1]};
        volatile unsigned char index = 2;
        int result;
        int main(void) {
            const char *p = words[index];
            while (*p) result += *p++;
            for (int i = 0; i < 5; i++) result += counts[i];
            for (int i = 0; i < 100; i++) result += cleared[i];
            result += *entry.where + entry.name[0];
        })",
     't' + 'h' + 'r' + 'e' + 'e' + 996 + 1000 + 'x'},
    {"Constructors", "f.cpp", R"(
        extern int order;
        struct Part { int n; explicit Part(int k) : n(order = order * 10 + k) {} };
        int order = 0;
        Part one(1);
        Part two __attribute__((init_priority(200))) (2);
        Part three(3);
        int result;
        int main() { result = order + one.n + two.n; })",
     213 + 21 + 2},
    {"Memory", "f.c", R"(
        #include <string.h>
        char a[40], b[40];
        volatile unsigned n = 30;
        int result;
        int main(void) {
            for (int i = 0; i < 40; i++) a[i] = i;
            memcpy(b, a, n);
            memmove(b + 3, b, n);
            memmove(a, a + 5, n);
            memset(a + 10, 7, n - 25);
            for (int i = 0; i < 40; i++) result = result * 5 + a[i] * 3 + b[i];
            result += memcmp(a, b, 5);
        })",
     [] {
         int a[40] = {}, b[40] = {};
         for (int i = 0; i < 40; i++) a[i] = i;
         for (int i = 0; i < 30; i++) b[i] = a[i];
         for (int i = 29; i >= 0; i--) b[i + 3] = b[i];
         for (int i = 0; i < 30; i++) a[i] = a[i + 5];
         for (int i = 10; i < 15; i++) a[i] = 7;
         uint32_t result = 0;
         for (int i = 0; i < 40; i++) {
             result = result * 5 + static_cast<uint32_t>(a[i] * 3 + b[i]);
         }
         return (result + 1) & 0xFFFF;  // a[0] = 5 is above b[0] = 0
     }()},
    {"Recursion", "f.c", R"(
        volatile int seed = 12;
        int fib(int n) { return n < 2 ? n : fib(n - 1) + fib(n - 2); }
        int odd(unsigned n);
        int even(unsigned n) { return n == 0 ? 1 : odd(n - 1); }
        int odd(unsigned n) { return n == 0 ? 0 : even(n - 1); }
        int walk(int n, int *sum) { int own[3] = {n, n + 1, n + 2};
            if (n > 0) walk(n - 1, &own[1]);
            *sum += own[0] + own[1] * 2 + own[2]; return own[1]; }
        int result;
        int main(void) {
            int sum = 0;
            walk(4, &sum);
            result = fib(seed) + even(seed) * 1000 + sum;
        })",
     [] {
         struct Walk {
             static int run(int n, int* sum) {
                 int own[3] = {n, n + 1, n + 2};
                 if (n > 0) run(n - 1, &own[1]);
                 *sum += own[0] + own[1] * 2 + own[2];
                 return own[1];
             }
         };
         int sum = 0;
         Walk::run(4, &sum);
         return static_cast<uint32_t>(144 + 1000 + sum);
     }(),
     true},
    {"WideIntegers", "f.c", R"(
        volatile long long big = 0x123456789ABCDEFLL;
        volatile unsigned long word = 0xDEADBEEF;
        volatile signed char small = -100;
        int result;
        int main(void) {
            unsigned long long product = (unsigned long long)big * word;
            long long quotient = big / small;
            unsigned long shifted = word >> (big & 15) ^ word << 3;
            result = (int)(product >> 20) + (int)(quotient >> 7) + (int)shifted
                   + (int)(word % 1000) + (int)(big % small) + (small >> 2);
        })",
     [] {
         const int64_t big = 0x123456789ABCDEFLL;
         const uint32_t word = 0xDEADBEEF;
         const int small = -100;
         const uint64_t product = static_cast<uint64_t>(big) * word;
         const int64_t quotient = big / small;
         const uint32_t shifted = word >> (big & 15) ^ word << 3;
         return static_cast<uint32_t>((product >> 20) + static_cast<uint64_t>(quotient >> 7) +
                                      shifted + word % 1000 + static_cast<uint64_t>(big % small) +
                                      static_cast<uint64_t>(small >> 2)) &
                0xFFFF;
     }()},
    // A pointer to a member function keeps in its lowest bit whether it is a virtual one.
    {"MemberPointers", "f.cpp", R"(
        struct A {
            int n;
            explicit A(int k) : n(k) {}
            int sum(int a) { return n + a; }
            int product(int a) { return n * a; }
            int difference(int a) { return n - a; }
            virtual int twice(int a) { return 2 * a; }
        };
        struct B : A { using A::A; int twice(int a) override { return 20 * a; } };
        int (A::*const pointers[])(int) = {&A::sum, &A::product, &A::difference, &A::twice};
        B object(7);
        A* volatile target = &object;
        volatile unsigned char turns = 4;
        int result;
        int main() {
            for (unsigned char i = 0; i < turns; i++)
                result = result * 10 + (target->*pointers[i])(3);
        })",
     ((10 * 10 + 21) * 10 + 4) * 10 + 60},
    // clang takes an int to be aligned to 2, and may reckon with it.
    {"Alignment", "f.cpp", R"(
        #include <stdint.h>
        char first = 1;
        int word = 5;
        char third = 2;
        alignas(64) char table[10] = {3};
        char last;
        __attribute__((noinline)) uintptr_t address(volatile void* p) {
            volatile uintptr_t a = reinterpret_cast<uintptr_t>(p);
            return a;
        }
        __attribute__((noinline)) unsigned locals(unsigned char n) {
            volatile char odd[3] = {1, 2, 3};
            volatile int even = n;
            alignas(16) volatile char wide[5] = {};
            return (address(&even) & 1) + (address(wide) & 15) + even + odd[n];
        }
        int result;
        int main() {
            result = (address(&word) & 1) * 1000 + (address(table) & 63) * 10 + locals(2);
            result += first + third + table[0] + last;
        })",
     2 + 3 + 1 + 2 + 3},
    {"Templates", "f.cpp", R"(
        template <class T, int N> struct Ring { T items[N]; unsigned char at = 0;
            constexpr void push(T item) { items[at] = item; at = (at + 1) % N; }
            T sum() const { T s = 0; for (T i : items) s += i; return s; } };
        Ring<int, 3> ring{};
        volatile int seed = 4;
        int result;
        int main() {
            for (int i = 0; i < 5; i++) ring.push(seed * i);
            auto twice = [](auto v) { return v + v; };
            result = twice(ring.sum()) + ring.at;
        })",
     2 * (12 + 16 + 8) + 2},
};

std::string level_name(int level) {
    constexpr std::array kNames = {"O0", "O1", "O2", "Os"};
    return kNames.at(static_cast<std::size_t>(level));
}

INSTANTIATE_TEST_SUITE_P(All, Features,
                         testing::Combine(testing::ValuesIn(kFeatures), testing::Range(0, 4)),
                         [](const auto& test) {
                             return fmt::format("{}_{}", std::get<0>(test.param).name,
                                                level_name(std::get<1>(test.param)));
                         });

}  // namespace
