// The tables of --report and --time.
#include "toolchain/driver/report.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/toolchain/driver/compile.hpp"
#include "toolchain/asm/link.hpp"
#include "toolchain/asm/parse.hpp"

namespace {

using namespace toolchain;
using testing::ContainsRegex;
using testing::HasSubstr;

// Sizes and T-states by hand: LDA 13, INR A 4, STA 13, RET 10; 3 + 1 + 3 + 1 bytes.
TEST(Report, HasALineForEachFunctionAndTheTotals) {
    driver::Result result;
    const auto module = assembly::parse(R"(
        SECTION f,code
f:      LDA  v
        INR  A
        STA  v
        RET
        SECTION v,zero
v:      DS   1
        SECTION f@frame,frame,FUNCTION f
        DS   4
)",
                                        {.file = "p.s"});
    assembly::LinkOptions options;
    options.roots = {"f"};
    options.stack_size = 6;
    result.program = assembly::link({module}, options);
    codegen::FunctionReport report;
    report.name = "f";
    report.frame_bytes = 4;
    report.stack_bytes = 2;
    report.callees = {"g", "__mul16"};
    result.compiled.functions.push_back(report);
    const std::string text = driver::report_text(result);
    EXPECT_THAT(text, HasSubstr("\nf calls g; __mul16\n"));
    EXPECT_THAT(text, ContainsRegex("0000H +8 +[04] +4 +2 +40  f\n"));
    EXPECT_THAT(text, HasSubstr("ROM 8 of 32768 bytes (0000H-7FFFH)\n"));
    EXPECT_THAT(text, HasSubstr("stack 6"));
    EXPECT_THAT(text, testing::Not(HasSubstr("recursion")));
    result.compiled.stack_known = false;
    EXPECT_THAT(driver::report_text(result), HasSubstr("recursion: no bound is known"));
}

TEST(Report, RomAndRamAreThoseOfTheMap) {
    driver::Request request = driver_test::request_for(
        "#include <i85.h>\nint a = 5, b[20];\nI85_INTERRUPT(I85_TRAP) void f() { b[3]++; }\n"
        "int main() { return a * b[__i85_in(3)]; }");
    const driver::Result result = driver::compile_program(request);
    uint32_t rom = 0;
    for (std::size_t address = 0; address < assembly::kMemorySize; ++address) {
        rom += result.program.image.present[address] ? 1U : 0U;
    }
    EXPECT_THAT(driver::report_text(result), HasSubstr("ROM " + std::to_string(rom) + " of 32768"));
}

TEST(Report, TimesAddUp) {
    driver::Result result;
    result.times = {{"clang", 0.25}, {"link", 0.5}};
    EXPECT_EQ(driver::times_text(result),
              "clang           0.250 s\nlink            0.500 s\nall             0.750 s\n");
}

}  // namespace
