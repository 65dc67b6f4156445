// Programs through compile(), linked and executed: calls, frames, recursion, interrupts.
#include "toolchain/codegen/compile.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <string>

#include "tests/toolchain/codegen/compiled_program.hpp"
#include "tests/toolchain/codegen/plain_generator.hpp"
#include "tests/toolchain/ir/ir_program.hpp"

namespace {

using codegen_test::CompiledProgram;
using host_sim::Interrupt;
using namespace toolchain::codegen;

CompiledProgram program_of(const std::string& text, const CompileOptions& options = {}) {
    return {codegen_test::plain_code, ir_test::to_mir(text), options};
}

TEST(Compile, ACallWithArgumentsInRegistersAndMemory) {
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

}  // namespace
