// Intrinsics still mean the same when they are instructions; expected values from LLVM's APInt.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <functional>
#include <stdexcept>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "tests/toolchain/ir/ir_program.hpp"
#include "toolchain/ir/passes.hpp"

namespace {

using codegen_test::Interpreter;
using ir_test::to_mir;
using llvm::APInt;

const std::vector<uint64_t> kValues = {0,     1,      2,      0x7F,   0x80,   0xFF,
                                       0x100, 0x5555, 0x7FFF, 0x8000, 0x8001, 0xFFFF};

using Two = std::function<APInt(const APInt&, const APInt&)>;

void compare_two(const std::string& intrinsic, const Two& wanted) {
    std::string text;
    for (const unsigned bits : {8U, 16U, 32U}) {
        text += fmt::format(
            "declare i{0} @llvm.{1}.i{0}(i{0}, i{0})\n"
            "define i{0} @f{0}(i{0} %a, i{0} %b) {{\n"
            " %r = call i{0} @llvm.{1}.i{0}(i{0} %a, i{0} %b)\n ret i{0} %r\n}}\n",
            bits, intrinsic);
    }
    const auto mir = to_mir(text);
    Interpreter interpreter(mir);
    for (const unsigned bits : {8U, 16U, 32U}) {
        for (const uint64_t left : kValues) {
            for (const uint64_t right : kValues) {
                const APInt a = APInt(16, left).sextOrTrunc(bits);
                const APInt b = APInt(16, right).sextOrTrunc(bits);
                ASSERT_EQ(interpreter.call(fmt::format("f{}", bits),
                                           {a.getZExtValue(), b.getZExtValue()}),
                          wanted(a, b).getZExtValue())
                    << intrinsic << " i" << bits << " " << left << ", " << right;
            }
        }
    }
}

TEST(ExpandIntrinsics, MinimumAndMaximum) {
    compare_two("umin", [](const APInt& a, const APInt& b) { return a.ult(b) ? a : b; });
    compare_two("umax", [](const APInt& a, const APInt& b) { return a.ugt(b) ? a : b; });
    compare_two("smin", [](const APInt& a, const APInt& b) { return a.slt(b) ? a : b; });
    compare_two("smax", [](const APInt& a, const APInt& b) { return a.sgt(b) ? a : b; });
}

TEST(ExpandIntrinsics, SaturatingArithmetic) {
    compare_two("uadd.sat", [](const APInt& a, const APInt& b) { return a.uadd_sat(b); });
    compare_two("usub.sat", [](const APInt& a, const APInt& b) { return a.usub_sat(b); });
    compare_two("sadd.sat", [](const APInt& a, const APInt& b) { return a.sadd_sat(b); });
    compare_two("ssub.sat", [](const APInt& a, const APInt& b) { return a.ssub_sat(b); });
}

TEST(ExpandIntrinsics, CheckedArithmetic) {
    using Checked = APInt (APInt::*)(const APInt&, bool&) const;
    const std::vector<std::pair<std::string, Checked>> operations = {
        {"uadd", &APInt::uadd_ov}, {"usub", &APInt::usub_ov}, {"umul", &APInt::umul_ov},
        {"sadd", &APInt::sadd_ov}, {"ssub", &APInt::ssub_ov}, {"smul", &APInt::smul_ov}};
    for (const auto& [name, checked] : operations) {
        const auto mir = to_mir(fmt::format(R"(
declare {{i16, i1}} @llvm.{0}.with.overflow.i16(i16, i16)
define i32 @f(i16 %a, i16 %b) {{
  %both = call {{i16, i1}} @llvm.{0}.with.overflow.i16(i16 %a, i16 %b)
  %value = extractvalue {{i16, i1}} %both, 0
  %over = extractvalue {{i16, i1}} %both, 1
  %v = zext i16 %value to i32
  %o = zext i1 %over to i32
  %s = shl i32 %o, 16
  %r = or i32 %s, %v
  ret i32 %r
}})",
                                            name));
        Interpreter interpreter(mir);
        for (const uint64_t left : kValues) {
            for (const uint64_t right : kValues) {
                bool over = false;
                const APInt value = (APInt(16, left).*checked)(APInt(16, right), over);
                ASSERT_EQ(interpreter.call("f", {left, right}),
                          value.getZExtValue() | (over ? 0x10000U : 0U))
                    << name << " " << left << ", " << right;
            }
        }
    }
}

/// Widths that clang and LLVM's own passes make, odd ones included.
const std::vector<unsigned> kWidths = {1, 7, 8, 16, 24, 32, 33, 48, 64};

std::vector<APInt> corners(unsigned bits) {
    std::vector<APInt> values;
    for (const uint64_t value :
         {uint64_t{0}, uint64_t{1}, uint64_t{0x80}, uint64_t{0x8000}, uint64_t{0x12345678},
          uint64_t{0xFEDCBA9876543210}, UINT64_MAX, uint64_t{1} << 63, uint64_t{1} << 40}) {
        values.push_back(APInt(64, value).zextOrTrunc(bits));
    }
    return values;
}

TEST(ExpandIntrinsics, BitCounting) {
    const std::vector<std::tuple<std::string, bool, std::function<uint64_t(const APInt&)>>>
        operations = {
            {"ctpop", false, [](const APInt& a) { return a.popcount(); }},
            {"ctlz", true, [](const APInt& a) { return a.countl_zero(); }},
            {"cttz", true, [](const APInt& a) { return a.countr_zero(); }},
            {"bitreverse", false, [](const APInt& a) { return a.reverseBits().getZExtValue(); }},
            {"abs", true, [](const APInt& a) { return a.abs().getZExtValue(); }},
            {"bswap", false, [](const APInt& a) { return a.byteSwap().getZExtValue(); }}};
    for (const auto& [name, flag, wanted] : operations) {
        for (const unsigned bits : kWidths) {
            if (name == "bswap" && bits % 16 != 0) continue;
            const auto mir = to_mir(fmt::format(
                "declare i{0} @llvm.{1}.i{0}(i{0}{2})\n"
                "define i{0} @f(i{0} %a) {{\n %r = call i{0} @llvm.{1}.i{0}(i{0} %a{3})\n"
                " ret i{0} %r\n}}\n",
                bits, name, flag ? ", i1" : "", flag ? ", i1 false" : ""));
            Interpreter interpreter(mir);
            for (const APInt& value : corners(bits)) {
                ASSERT_EQ(interpreter.call("f", {value.getZExtValue()}), wanted(value))
                    << name << " i" << bits << " " << value.getZExtValue();
            }
        }
    }
}

TEST(ExpandIntrinsics, ThreeWayComparison) {
    for (const bool is_signed : {false, true}) {
        const auto mir = to_mir(
            fmt::format("declare i8 @llvm.{0}.i8.i32(i32, i32)\ndefine i8 @f(i32 %a, i32 %b) {{\n"
                        " %r = call i8 @llvm.{0}.i8.i32(i32 %a, i32 %b)\n ret i8 %r\n}}",
                        is_signed ? "scmp" : "ucmp"));
        Interpreter interpreter(mir);
        for (const APInt& a : corners(32)) {
            for (const APInt& b : corners(32)) {
                const bool below = is_signed ? a.slt(b) : a.ult(b);
                const uint64_t wanted = a == b ? 0 : below ? 0xFF : 1;
                ASSERT_EQ(interpreter.call("f", {a.getZExtValue(), b.getZExtValue()}), wanted);
            }
        }
    }
}

TEST(ExpandIntrinsics, CheckedProductsOf64Bits) {
    using Checked = APInt (APInt::*)(const APInt&, bool&) const;
    for (const auto& [name, checked] :
         {std::pair<const char*, Checked>{"umul", &APInt::umul_ov}, {"smul", &APInt::smul_ov}}) {
        const auto mir = to_mir(fmt::format(R"(
declare {{i64, i1}} @llvm.{0}.with.overflow.i64(i64, i64)
define i64 @value(i64 %a, i64 %b) {{
  %both = call {{i64, i1}} @llvm.{0}.with.overflow.i64(i64 %a, i64 %b)
  %r = extractvalue {{i64, i1}} %both, 0
  ret i64 %r
}}
define i1 @over(i64 %a, i64 %b) {{
  %both = call {{i64, i1}} @llvm.{0}.with.overflow.i64(i64 %a, i64 %b)
  %r = extractvalue {{i64, i1}} %both, 1
  ret i1 %r
}})",
                                            name));
        Interpreter interpreter(mir);
        for (const APInt& a : corners(64)) {
            for (const APInt& b : corners(64)) {
                bool over = false;
                const APInt product = (a.*checked)(b, over);
                const std::vector<uint64_t> operands = {a.getZExtValue(), b.getZExtValue()};
                ASSERT_EQ(interpreter.call("value", operands), product.getZExtValue());
                ASSERT_EQ(interpreter.call("over", operands), over ? 1U : 0U)
                    << name << " " << operands[0] << " " << operands[1];
            }
        }
    }
}

TEST(ExpandIntrinsics, TrapsHaltForEver) {
    const auto mir = to_mir(R"(
declare void @llvm.trap()
declare void @llvm.ubsantrap(i8)
define i16 @f(i1 %c) {
  br i1 %c, label %bad, label %good
bad:
  call void @llvm.trap()
  call void @llvm.ubsantrap(i8 1)
  unreachable
good:
  ret i16 3
})");
    Interpreter interpreter(mir);
    EXPECT_EQ(interpreter.call("f", {0}), 3U);
    interpreter.step_limit = interpreter.steps + 1000;
    EXPECT_THROW(interpreter.call("f", {1}), std::runtime_error);
    const std::string text = print(mir);
    EXPECT_NE(text.find("di\n"), std::string::npos) << text;
    EXPECT_NE(text.find("hlt\n"), std::string::npos) << text;
    EXPECT_EQ(text.find("unreachable"), std::string::npos) << text;
}

TEST(ExpandIntrinsics, HintsVanish) {
    const auto mir = to_mir(R"(
declare void @llvm.assume(i1)
declare void @llvm.donothing()
declare void @llvm.sideeffect()
declare void @llvm.prefetch.p0(ptr, i32, i32, i32)
declare ptr @llvm.invariant.start.p0(i64, ptr)
declare void @llvm.invariant.end.p0(ptr, i64, ptr)
declare i16 @llvm.expect.i16(i16, i16)
declare i1 @llvm.is.constant.i16(i16)
declare i16 @llvm.objectsize.i16.p0(ptr, i1, i1, i1)
define i16 @f(i16 %a, ptr %p) {
  %c = icmp ne i16 %a, 0
  call void @llvm.assume(i1 %c)
  call void @llvm.donothing()
  call void @llvm.sideeffect()
  call void @llvm.prefetch.p0(ptr %p, i32 0, i32 0, i32 0)
  %i = call ptr @llvm.invariant.start.p0(i64 1, ptr %p)
  call void @llvm.invariant.end.p0(ptr %i, i64 1, ptr %p)
  %e = call i16 @llvm.expect.i16(i16 %a, i16 1)
  %k = call i1 @llvm.is.constant.i16(i16 %a)
  %x = zext i1 %k to i16
  %s = call i16 @llvm.objectsize.i16.p0(ptr %p, i1 true, i1 false, i1 false)
  %r = add i16 %e, %x
  %t = add i16 %r, %s
  ret i16 %t
})");
    Interpreter interpreter(mir);
    EXPECT_EQ(interpreter.call("f", {5, 0}), 5U);
}

TEST(ExpandIntrinsics, FunnelShiftsTakeEveryCount) {
    for (const bool left : {true, false}) {
        const auto mir = to_mir(fmt::format(R"(
declare i16 @llvm.{0}.i16(i16, i16, i16)
define i16 @f(i16 %a, i16 %b, i16 %n) {{
  %r = call i16 @llvm.{0}.i16(i16 %a, i16 %b, i16 %n)
  ret i16 %r
}})",
                                            left ? "fshl" : "fshr"));
        Interpreter interpreter(mir);
        for (uint64_t count = 0; count < 40; ++count) {
            const uint32_t both = 0x8123'4567;
            const auto shift = static_cast<unsigned>(count % 16);
            const uint32_t wanted =
                left ? static_cast<uint32_t>(uint64_t{both} << shift >> 16) : both >> shift;
            ASSERT_EQ(interpreter.call("f", {both >> 16, both & 0xFFFF, count}), wanted & 0xFFFF)
                << count;
        }
    }
}

TEST(ExpandIntrinsics, MemoryIntrinsicsCallTheRuntime) {
    const auto mir = to_mir(R"(
@a = global [4 x i8] c"abcd"
@b = global [4 x i8] zeroinitializer
declare void @llvm.memcpy.p0.p0.i16(ptr, ptr, i16, i1)
declare void @llvm.memset.p0.i16(ptr, i8, i16, i1)
define void @f() {
  call void @llvm.memcpy.p0.p0.i16(ptr @b, ptr @a, i16 4, i1 false)
  call void @llvm.memset.p0.i16(ptr @a, i8 90, i16 2, i1 false)
  ret void
})");
    Interpreter interpreter(mir);
    interpreter.call("f");
    EXPECT_EQ(interpreter.variable("b", 4), 0x64636261U);
    EXPECT_EQ(interpreter.variable("a", 4), 0x64635A5AU);
}

}  // namespace
