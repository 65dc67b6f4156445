// What prepare() replaces still means the same; expected values from LLVM's APInt.
#include "toolchain/ir/prepare.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "tests/toolchain/ir/ir_program.hpp"

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

TEST(Prepare, MinimumAndMaximum) {
    compare_two("umin", [](const APInt& a, const APInt& b) { return a.ult(b) ? a : b; });
    compare_two("umax", [](const APInt& a, const APInt& b) { return a.ugt(b) ? a : b; });
    compare_two("smin", [](const APInt& a, const APInt& b) { return a.slt(b) ? a : b; });
    compare_two("smax", [](const APInt& a, const APInt& b) { return a.sgt(b) ? a : b; });
}

TEST(Prepare, SaturatingArithmetic) {
    compare_two("uadd.sat", [](const APInt& a, const APInt& b) { return a.uadd_sat(b); });
    compare_two("usub.sat", [](const APInt& a, const APInt& b) { return a.usub_sat(b); });
    compare_two("sadd.sat", [](const APInt& a, const APInt& b) { return a.sadd_sat(b); });
    compare_two("ssub.sat", [](const APInt& a, const APInt& b) { return a.ssub_sat(b); });
}

TEST(Prepare, CheckedArithmetic) {
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

TEST(Prepare, BitCounting) {
    const std::vector<std::pair<std::string, std::function<uint64_t(const APInt&)>>> operations = {
        {"ctpop.i16(i16 %a)", [](const APInt& a) { return a.popcount(); }},
        {"ctlz.i16(i16 %a, i1 false)", [](const APInt& a) { return a.countl_zero(); }},
        {"cttz.i16(i16 %a, i1 false)", [](const APInt& a) { return a.countr_zero(); }},
        {"bswap.i16(i16 %a)", [](const APInt& a) { return a.byteSwap().getZExtValue(); }},
        {"abs.i16(i16 %a, i1 false)", [](const APInt& a) { return a.abs().getZExtValue(); }}};
    for (const auto& [call, wanted] : operations) {
        const std::string name = call.substr(0, call.find('('));
        const bool flag = call.find("i1 ") != std::string::npos;
        const auto mir = to_mir(fmt::format(
            "declare i16 @llvm.{}(i16{})\ndefine i16 @f(i16 %a) {{\n %r = call i16 @llvm.{}\n"
            " ret i16 %r\n}}\n",
            name, flag ? ", i1" : "", call));
        Interpreter interpreter(mir);
        for (const uint64_t value : kValues) {
            ASSERT_EQ(interpreter.call("f", {value}), wanted(APInt(16, value)))
                << call << " " << value;
        }
    }
}

TEST(Prepare, FunnelShiftsTakeEveryCount) {
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

TEST(Prepare, SelectsAndSwitchesBecomeBranches) {
    const auto mir = to_mir(R"(
define i16 @f(i16 %a) {
  %small = icmp ult i16 %a, 10
  %x = select i1 %small, i16 100, i16 200
  %y = select i1 %small, i16 %a, i16 %x
  switch i16 %y, label %other [ i16 3, label %three
                                i16 7, label %seven
                                i16 200, label %big ]
three:
  ret i16 33
seven:
  ret i16 77
big:
  ret i16 %y
other:
  ret i16 1
})");
    Interpreter interpreter(mir);
    EXPECT_EQ(interpreter.call("f", {3}), 33U);
    EXPECT_EQ(interpreter.call("f", {7}), 77U);
    EXPECT_EQ(interpreter.call("f", {8}), 1U);
    EXPECT_EQ(interpreter.call("f", {5000}), 200U);
}

TEST(Prepare, MemoryIntrinsicsCallTheRuntime) {
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
