// Loop bounds from annotations and from LLVM, and block frequencies; expected values by counting.
#include "toolchain/ir/loop_bounds.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "tests/toolchain/ir/ir_program.hpp"

namespace {

using toolchain::codegen::Block;
using toolchain::codegen::Function;

/// The function's code after the whole pipeline.
Function function_of(const std::string& source, const std::string& level) {
    llvm::LLVMContext context;
    return ir_test::to_mir(*ir_test::compile(source, level, context)).functions.front();
}

uint32_t greatest_bound(const Function& function) {
    uint32_t bound = 0;
    for (const Block& block : function.blocks) bound = std::max(bound, block.loop_bound);
    return bound;
}

double greatest_frequency(const Function& function) {
    double frequency = 0;
    for (const Block& block : function.blocks) frequency = std::max(frequency, block.frequency);
    return frequency;
}

constexpr const char* kSearch = R"(
extern "C" void __i85_loop_bound(unsigned);
extern "C" unsigned f(const unsigned char* p) {
    unsigned n = 0;
    while (p[n] != 0) { __i85_loop_bound(40); ++n; }
    return n;
})";

// A body that runs 40 times leaves the test at the top 41 times; a loop that tests at its bottom
// behind a guard runs it 40 times.
TEST(LoopBounds, AnnotationReachesTheHeader) {
    EXPECT_EQ(greatest_bound(function_of(kSearch, "0")), 41U);
    const uint32_t optimised = greatest_bound(function_of(kSearch, "2"));
    EXPECT_TRUE(optimised == 40 || optimised == 41) << optimised;
}

TEST(LoopBounds, AnnotationHoldsForTheInnermostLoop) {
    const Function function = function_of(R"(
extern "C" void __i85_loop_bound(unsigned);
extern "C" void g();
extern "C" void f(volatile unsigned char* p) {
    do {
        *p = 0;
        do { __i85_loop_bound(5); g(); } while (*p != 1);
        __i85_loop_bound(9);
    } while (*p != 2);
})",
                                          "1");
    uint32_t inner = 0;
    uint32_t outer = 0;
    for (const Block& block : function.blocks) {
        if (block.loop_bound == 0) continue;
        (block.loop_depth == 2 ? inner : outer) = block.loop_bound;
    }
    EXPECT_EQ(inner, 5U);
    EXPECT_EQ(outer, 9U);
}

// Without code of their own in front the loops share a header, executed 5 * 9 times.
TEST(LoopBounds, LoopsThatShareAHeaderMultiply) {
    const Function function = function_of(R"(
extern "C" void __i85_loop_bound(unsigned);
extern "C" void g();
extern "C" void f(volatile unsigned char* p) {
    do {
        do { __i85_loop_bound(5); g(); } while (*p != 1);
        __i85_loop_bound(9);
    } while (*p != 2);
})",
                                          "1");
    EXPECT_EQ(greatest_bound(function), 45U);
}

TEST(LoopBounds, TripCountIsKnownWithoutAnnotation) {
    const Function function = function_of(R"(
extern "C" void g(unsigned char);
extern "C" void f() { for (unsigned char i = 0; i < 37; ++i) g(i); })",
                                          "2");
    EXPECT_EQ(greatest_bound(function), 37U);
    EXPECT_DOUBLE_EQ(greatest_frequency(function), 37.0);
}

TEST(LoopBounds, UnknownLoopsAreTakenToRepeatTenTimes) {
    const std::string source = kSearch;
    const std::string without = source.substr(0, source.find("__i85_loop_bound(40)")) +
                                source.substr(source.find("++n; }"));
    EXPECT_NEAR(greatest_frequency(function_of(without, "0")), 10, 0.1);
    EXPECT_EQ(greatest_bound(function_of(without, "0")), 0U);
}

TEST(LoopBounds, FrequenciesMultiply) {
    const Function function = function_of(R"(
extern "C" void g(unsigned char, unsigned char);
extern "C" void f() {
    for (unsigned char i = 0; i < 6; ++i)
        for (unsigned char k = 0; k < 7; ++k) g(i, k);
})",
                                          "2");
    EXPECT_NEAR(greatest_frequency(function), 42, 0.1);
    EXPECT_DOUBLE_EQ(function.blocks[0].frequency, 1);
}

std::string refusal_of(const std::string& body) {
    llvm::LLVMContext context;
    try {
        static_cast<void>(
            ir_test::compile("extern \"C\" void __i85_loop_bound(unsigned);\n"
                             "extern \"C\" void f(unsigned n) {\n" +
                                 body + "\n}",
                             "2", context));
    } catch (const toolchain::ir::Refused& refused) {
        const std::string message = refused.what();
        return message.substr(message.find(".cpp:") + 5);
    }
    return "accepted";
}

TEST(LoopBounds, AnnotationsOutOfPlaceAreRefused) {
    EXPECT_EQ(refusal_of("__i85_loop_bound(3);"),
              "3: in f: __i85_loop_bound is not in a loop: call it in the body that repeats");
    EXPECT_EQ(refusal_of("while (n-- != 0) __i85_loop_bound(n);"),
              "3: in f: __i85_loop_bound needs a constant from 1 on");
    EXPECT_EQ(refusal_of("while (n-- != 0) __i85_loop_bound(0);"),
              "3: in f: __i85_loop_bound needs a constant from 1 on");
}

}  // namespace
