// Products of more than 64 bits; expected values from LLVM's APInt.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <vector>

#include "tests/toolchain/ir/ir_program.hpp"
#include "toolchain/ir/passes.hpp"

namespace {

using llvm::APInt;

TEST(ExpandWideProducts, AgreeForCorners) {
    const std::vector<uint64_t> values = {0,          1,          0xFFFFFFFF,         0x100000000,
                                          0x89ABCDEF, UINT64_MAX, 0x8000000000000000, 12345678901};
    for (const unsigned bits : {65U, 96U, 128U}) {
        // The operands are the squares' neighbours, so that all bits take part.
        const auto mir = ir_test::to_mir(fmt::format(R"(
define i64 @f(i64 %a, i64 %b, i64 %shift) {{
  %x = zext i64 %a to i{0}
  %y = sext i64 %b to i{0}
  %p = mul i{0} %x, %y
  %high = lshr i{0} %p, {1}
  %low = trunc i{0} %p to i64
  %top = trunc i{0} %high to i64
  %first = icmp eq i64 %shift, 0
  %r = select i1 %first, i64 %low, i64 %top
  ret i64 %r
}})",
                                                     bits, bits - 64));
        codegen_test::Interpreter interpreter(mir);
        for (const uint64_t left : values) {
            for (const uint64_t right : values) {
                const APInt product = APInt(64, left).zext(bits) * APInt(64, right).sext(bits);
                ASSERT_EQ(interpreter.call("f", {left, right, 0}),
                          product.trunc(64).getZExtValue());
                ASSERT_EQ(interpreter.call("f", {left, right, 1}),
                          product.lshr(bits - 64).trunc(64).getZExtValue())
                    << bits << " " << left << " " << right;
            }
        }
    }
}

}  // namespace
