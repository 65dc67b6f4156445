// Every integer operation, width and corner value, with operands at run time and as constants;
// expected values from LLVM's APInt.
#include "toolchain/ir/select.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <set>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "tests/toolchain/ir/ir_program.hpp"

namespace {

using codegen_test::Interpreter;
using ir_test::to_mir;
using llvm::APInt;

const std::vector<unsigned> kWidths = {1, 3, 8, 9, 16, 24, 31, 32, 33, 64};

/// 0, 1, 2, the largest, the halves of the range, alternating bits, single bits.
std::vector<APInt> corners(unsigned bits) {
    std::vector<APInt> values = {APInt(bits, 0), APInt(bits, 1), APInt::getMaxValue(bits),
                                 APInt::getSignedMaxValue(bits), APInt::getSignedMinValue(bits)};
    for (const uint64_t pattern :
         {0x5555555555555555ULL, 0xAAAAAAAAAAAAAAAAULL, 0x00FF00FF00FF00FFULL,
          0x0123456789ABCDEFULL, 0x81ULL, 0x100ULL, 0x7F80ULL, 0xFFFF0000ULL}) {
        values.push_back(APInt(64, pattern).zextOrTrunc(bits));
    }
    return values;
}

bool is_defined(const std::string& operation, const APInt& left, const APInt& right) {
    const bool divides = operation.ends_with("div") || operation.ends_with("rem");
    if (divides && right.isZero()) return false;
    if ((operation == "sdiv" || operation == "srem") && left.isMinSignedValue() &&
        right.isAllOnes()) {
        return false;
    }
    const bool shifts = operation == "shl" || operation == "lshr" || operation == "ashr";
    return !shifts || right.ult(left.getBitWidth());
}

APInt expected(const std::string& operation, const APInt& left, const APInt& right) {
    if (operation == "add") return left + right;
    if (operation == "sub") return left - right;
    if (operation == "mul") return left * right;
    if (operation == "and") return left & right;
    if (operation == "or") return left | right;
    if (operation == "xor") return left ^ right;
    if (operation == "udiv") return left.udiv(right);
    if (operation == "urem") return left.urem(right);
    if (operation == "sdiv") return left.sdiv(right);
    if (operation == "srem") return left.srem(right);
    if (operation == "shl") return left.shl(right);
    if (operation == "lshr") return left.lshr(right);
    return left.ashr(right);
}

std::size_t calls_in(const toolchain::codegen::Module& mir) {
    std::size_t calls = 0;
    for (const auto& block : mir.functions.at(0).blocks) {
        for (const auto& operation : block.operations) {
            calls += operation.opcode == toolchain::codegen::Opcode::call ? 1 : 0;
        }
    }
    return calls;
}

// The routines give both.
TEST(SelectDivision, QuotientAndRemainderAreOneCall) {
    for (const char* sign : {"u", "s"}) {
        for (const bool remainder_first : {false, true}) {
            const std::string quotient = fmt::format("%q = {}div i16 %a, %b\n", sign);
            const std::string remainder = fmt::format("%r = {}rem i16 %a, %b\n", sign);
            const auto mir =
                to_mir("define i16 @f(i16 %a, i16 %b) {\n" +
                       (remainder_first ? remainder + quotient : quotient + remainder) +
                       "%x = mul i16 %q, 5\n%s = xor i16 %x, %r\nret i16 %s\n}\n");
            EXPECT_EQ(calls_in(mir), 1U) << sign << remainder_first;
            Interpreter interpreter(mir);
            EXPECT_EQ(interpreter.call("f", {1000, 7}), (1000U / 7 * 5) ^ (1000U % 7));
        }
    }
    const auto other = to_mir(
        "define i16 @f(i16 %a, i16 %b) {\n%q = udiv i16 %a, %b\n%r = urem i16 %b, %a\n"
        "%s = xor i16 %q, %r\nret i16 %s\n}\n");
    EXPECT_EQ(calls_in(other), 2U) << "other operands";
    const auto mixed = to_mir(
        "define i16 @f(i16 %a, i16 %b) {\n%q = udiv i16 %a, %b\n%r = srem i16 %a, %b\n"
        "%s = xor i16 %q, %r\nret i16 %s\n}\n");
    EXPECT_EQ(calls_in(mixed), 2U) << "one with signs, one without";
}

// LLVM writes the mask without bits that are 0 anyway.
TEST(SelectMask, ClearsNothingThatIsClear) {
    const auto ands = [](const std::string& mask) {
        const auto mir = to_mir("define i16 @f(i16 %a) {\n%s = shl i16 %a, 2\n%m = and i16 %s, " +
                                mask + "\nret i16 %m\n}\n");
        std::size_t count = 0;
        for (const auto& operation : mir.functions.at(0).blocks.at(0).operations) {
            count += operation.opcode == toolchain::codegen::Opcode::bit_and ? 1 : 0;
        }
        Interpreter interpreter(mir);
        const auto number = static_cast<uint16_t>(std::stoi(mask));
        for (const uint64_t value : {0x0000U, 0xFFFFU, 0x5555U, 0x1234U}) {
            EXPECT_EQ(interpreter.call("f", {value}), value << 2 & number) << mask;
        }
        return count;
    };
    EXPECT_EQ(ands("4092"), 1U);    // 0FFCH: of the upper byte
    EXPECT_EQ(ands("-4"), 0U);      // FFFCH
    EXPECT_EQ(ands("-8"), 1U);      // FFF8H: of the lower byte
    EXPECT_EQ(ands("-16388"), 1U);  // BFFCH
}

/// Operation, and whether the module goes through lower_calls().
class SelectBinary : public testing::TestWithParam<std::tuple<std::string, bool>> {};

TEST_P(SelectBinary, AgreesForEveryWidthAndCorner) {
    const auto& [operation, lower] = GetParam();
    std::set<std::string> functions;  // equal corners of narrow widths make equal functions
    for (const unsigned bits : kWidths) {
        functions.insert(
            fmt::format("define i{0} @v{0}(i{0} %a, i{0} %b) {{\n %r = {1} i{0} %a, %b\n "
                        "ret i{0} %r\n}}\n",
                        bits, operation));
        for (const APInt& right : corners(bits)) {
            if (!is_defined(operation, APInt(bits, 0), right)) continue;
            functions.insert(
                fmt::format("define i{0} @c{0}_{1}(i{0} %a) {{\n %r = {2} i{0} %a, {3}\n "
                            "ret i{0} %r\n}}\n",
                            bits, right.getZExtValue(), operation, right.getSExtValue()));
        }
    }
    auto mir = to_mir(fmt::format("{}", fmt::join(functions, "")));
    if (lower) mir = ir_test::lowered(std::move(mir));
    Interpreter interpreter(mir);
    for (const unsigned bits : kWidths) {
        for (const APInt& left : corners(bits)) {
            for (const APInt& right : corners(bits)) {
                if (!is_defined(operation, left, right)) continue;
                const uint64_t wanted = expected(operation, left, right).getZExtValue();
                const uint64_t a = left.getZExtValue();
                const uint64_t b = right.getZExtValue();
                ASSERT_EQ(interpreter.call(fmt::format("v{}", bits), {a, b}), wanted)
                    << operation << " i" << bits << " " << a << ", " << b;
                ASSERT_EQ(interpreter.call(fmt::format("c{}_{}", bits, b), {a}), wanted)
                    << operation << " i" << bits << " " << a << ", constant " << b;
            }
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Operations, SelectBinary,
                         testing::Combine(testing::Values("add", "sub", "mul", "and", "or", "xor",
                                                          "udiv", "urem", "sdiv", "srem", "shl",
                                                          "lshr", "ashr"),
                                          testing::Bool()),
                         [](const auto& test) {
                             return std::get<0>(test.param) +
                                    (std::get<1>(test.param) ? "_lowered" : "");
                         });

TEST(Select, ComparisonsAgree) {
    const std::vector<std::pair<std::string, bool (*)(const APInt&, const APInt&)>> predicates = {
        {"eq", [](const APInt& a, const APInt& b) { return a == b; }},
        {"ne", [](const APInt& a, const APInt& b) { return a != b; }},
        {"ult", [](const APInt& a, const APInt& b) { return a.ult(b); }},
        {"ule", [](const APInt& a, const APInt& b) { return a.ule(b); }},
        {"ugt", [](const APInt& a, const APInt& b) { return a.ugt(b); }},
        {"uge", [](const APInt& a, const APInt& b) { return a.uge(b); }},
        {"slt", [](const APInt& a, const APInt& b) { return a.slt(b); }},
        {"sle", [](const APInt& a, const APInt& b) { return a.sle(b); }},
        {"sgt", [](const APInt& a, const APInt& b) { return a.sgt(b); }},
        {"sge", [](const APInt& a, const APInt& b) { return a.sge(b); }}};
    std::string text;
    for (const auto& [name, holds] : predicates) {
        for (const unsigned bits : kWidths) {
            text += fmt::format(
                "define i1 @{1}{0}(i{0} %a, i{0} %b) {{\n %r = icmp {1} i{0} %a, %b\n ret i1 "
                "%r\n}}\n"
                "define i8 @b{1}{0}(i{0} %a, i{0} %b) {{\n %r = icmp {1} i{0} %a, %b\n"
                " br i1 %r, label %y, label %n\ny:\n ret i8 7\nn:\n ret i8 9\n}}\n",
                bits, name);
        }
    }
    const auto mir = to_mir(text);
    Interpreter interpreter(mir);
    for (const auto& [name, holds] : predicates) {
        for (const unsigned bits : kWidths) {
            for (const APInt& left : corners(bits)) {
                for (const APInt& right : corners(bits)) {
                    const std::vector<uint64_t> operands = {left.getZExtValue(),
                                                            right.getZExtValue()};
                    const bool wanted = holds(left, right);
                    const std::string function = fmt::format("{}{}", name, bits);
                    ASSERT_EQ(interpreter.call(function, operands), wanted ? 1U : 0U) << function;
                    ASSERT_EQ(interpreter.call("b" + function, operands), wanted ? 7U : 9U);
                }
            }
        }
    }
}

TEST(Select, CastsAgree) {
    std::string text;
    for (const unsigned from : kWidths) {
        for (const unsigned to : kWidths) {
            if (from == to) continue;
            for (const char* cast : {"trunc", "zext", "sext"}) {
                if ((to < from) != (std::string(cast) == "trunc")) continue;
                text += fmt::format(
                    "define i{1} @{2}{0}_{1}(i{0} %a) {{\n %r = {2} i{0} %a to i{1}\n"
                    " ret i{1} %r\n}}\n",
                    from, to, cast);
            }
        }
    }
    const auto mir = to_mir(text);
    Interpreter interpreter(mir);
    for (const unsigned from : kWidths) {
        for (const unsigned to : kWidths) {
            for (const APInt& value : corners(from)) {
                const std::vector<uint64_t> operand = {value.getZExtValue()};
                if (to < from) {
                    ASSERT_EQ(interpreter.call(fmt::format("trunc{}_{}", from, to), operand),
                              value.trunc(to).getZExtValue());
                } else if (to > from) {
                    ASSERT_EQ(interpreter.call(fmt::format("zext{}_{}", from, to), operand),
                              value.zext(to).getZExtValue());
                    ASSERT_EQ(interpreter.call(fmt::format("sext{}_{}", from, to), operand),
                              value.sext(to).getZExtValue());
                }
            }
        }
    }
}

TEST(Select, AddressesScaleIndicesOfEverySize) {
    const auto mir = to_mir(R"(
%pair = type <{ i8, i16, [5 x i8] }>
@table = global [4 x %pair] zeroinitializer
define void @fill(i8 %i, i16 %j) {
  %p = getelementptr [4 x %pair], ptr @table, i16 0, i8 %i, i32 2, i16 %j
  store i8 77, ptr %p
  ret void
}
define i8 @fetch() {
  %p = getelementptr %pair, ptr @table, i16 3, i32 2, i16 4
  %r = load i8, ptr %p
  ret i8 %r
})");
    Interpreter interpreter(mir);
    interpreter.call("fill", {3, 4});
    EXPECT_EQ(interpreter.call("fetch"), 77U);
    interpreter.call("fill", {0, 0xFFFD});  // -3: the pair's first byte
    EXPECT_EQ(interpreter.variable("table", 1), 77U);
}

TEST(Select, InitialDataHoldsNumbersAddressesAndPadding) {
    const auto mir = to_mir(R"(
@text = constant [3 x i8] c"ab\00"
@data = global { i8, i16, ptr, [2 x i8] } { i8 1, i16 515,
  ptr getelementptr (i8, ptr @text, i16 1), [2 x i8] c"xy" }
define i8 @second() {
  %p = getelementptr { i8, i16, ptr, [2 x i8] }, ptr @data, i16 0, i32 2
  %q = load ptr, ptr %p
  %r = load i8, ptr %q
  ret i8 %r
})");
    Interpreter interpreter(mir);
    EXPECT_EQ(interpreter.call("second"), 'b');
    EXPECT_EQ(interpreter.variable("data", 4), 0x02030001U);  // i16 on an even offset
}

TEST(Select, CallsDirectAndThroughPointers) {
    const auto mir = to_mir(R"(
define i32 @add(i32 %a, i16 %b) {
  %w = zext i16 %b to i32
  %r = add i32 %a, %w
  ret i32 %r
}
define i32 @through(ptr %f, i32 %a, i16 %b) {
  %r = call i32 %f(i32 %a, i16 %b)
  ret i32 %r
}
define i32 @main(i32 %a, i16 %b) {
  %r = call i32 @through(ptr @add, i32 %a, i16 %b)
  ret i32 %r
})");
    Interpreter interpreter(mir);
    EXPECT_EQ(interpreter.call("main", {0x1FFFF, 2}), 0x20001U);
}

TEST(Select, ProcessorInstructionsAreOperations) {
    const auto mir = to_mir(R"(
declare i8 @__i85_in(i8)
declare void @__i85_out(i8, i8)
declare void @__i85_ei()
define void @f() {
  %x = call i8 @__i85_in(i8 9)
  call void @__i85_out(i8 8, i8 %x)
  call void @__i85_ei()
  ret void
})");
    EXPECT_EQ(print(mir, mir.functions[0]),
              "function f\n  0[]:\n    [b0] = port_in #9\n    port_out [b0] #8\n    ei\n"
              "    return []\n");
}

TEST(Select, ConstantExpressionsAreComputedWhereTheLinkerCannot) {
    const auto mir = to_mir(R"(
@a = global [300 x i8] zeroinitializer
@b = global i8 0
define i16 @distance() {
  ret i16 sub (i16 ptrtoint (ptr @b to i16), i16 ptrtoint (ptr @a to i16))
}
define i8 @low() {
  ret i8 trunc (i16 ptrtoint (ptr getelementptr (i8, ptr @a, i16 5) to i16) to i8)
}
define i32 @wide() {
  ret i32 ptrtoint (ptr @b to i32)
})");
    Interpreter interpreter(mir);  // variables lie one behind the other from 8000H on
    EXPECT_EQ(interpreter.call("distance"), 300U);
    EXPECT_EQ(interpreter.call("low"), 5U);
    EXPECT_EQ(interpreter.call("wide"), 0x8000U + 300U);
}

TEST(Select, ProductsWithConstants) {
    const std::vector<uint64_t> factors = {0,   1,    3,    7,    10,    11,     0x55,  0x7F,
                                           100, 0xFF, 1000, 4095, 12345, 0x7FFF, 0xFFFF};
    for (const unsigned bits : {8U, 16U, 32U}) {
        for (const uint64_t factor : factors) {
            const APInt constant = APInt(64, factor).zextOrTrunc(bits);
            const auto mir =
                to_mir(fmt::format("define i{0} @f(i{0} %a) {{\n"
                                   " %r = mul i{0} %a, {1}\n ret i{0} %r\n}}",
                                   bits, constant.getSExtValue()));
            Interpreter interpreter(mir);
            for (const APInt& value : corners(bits)) {
                ASSERT_EQ(interpreter.call("f", {value.getZExtValue()}),
                          (value * constant).getZExtValue())
                    << bits << " bits, " << factor;
            }
        }
    }
}

TEST(Select, FrozenValuesAreTheSameAtEveryUse) {
    const auto mir = to_mir(R"(
define i16 @f(i1 %c, i16 %x) {
entry:
  br i1 %c, label %set, label %join
set:
  br label %join
join:
  %v = phi i16 [ undef, %entry ], [ %x, %set ]
  %w = freeze i16 %v
  %d = sub i16 %w, %w
  ret i16 %d
})");
    for (const auto& block : mir.functions.front().blocks) {
        for (const auto& edge : block.terminator.edges) {
            for (const auto byte : edge.arguments) {
                EXPECT_NE(mir.functions.front().bytes[byte].kind,
                          toolchain::codegen::ByteInfo::Kind::undefined);
            }
        }
    }
}

TEST(Select, UndefinedBitsAboveAnOddWidthAreZero) {
    const auto mir = to_mir(
        "define i16 @f() {\n %r = zext i1 undef to i16\n ret i16 %r\n}\n"
        "define i1 @g() {\n ret i1 poison\n}");
    Interpreter interpreter(mir);
    EXPECT_LE(interpreter.call("g"), 1U);
}

TEST(Select, BlocksCarryTheSizesOfTheirParameters) {
    const auto mir = to_mir(R"(
define i32 @f(i8 %n, i32 %s) {
entry:
  br label %loop
loop:
  %i = phi i8 [ %n, %entry ], [ %next, %loop ]
  %t = phi i32 [ %s, %entry ], [ %u, %loop ]
  %u = add i32 %t, %s
  %next = add i8 %i, -1
  %more = icmp ne i8 %next, 0
  br i1 %more, label %loop, label %end
end:
  ret i32 %u
})");
    const auto& blocks = mir.functions.front().blocks;
    EXPECT_EQ(blocks[0].parameter_sizes, (std::vector<uint32_t>{1, 4}));
    EXPECT_EQ(blocks[1].parameter_sizes, (std::vector<uint32_t>{1, 4}));
    EXPECT_EQ(blocks[1].loop_depth, 1U);
    EXPECT_TRUE(blocks[2].parameter_sizes.empty());
}

TEST(Select, TakenAddressesAreMarked) {
    const auto mir = to_mir(R"(
@p = global ptr @taken
@llvm.used = appending global [1 x ptr] [ptr @kept], section "llvm.metadata"
@llvm.global_ctors = appending global [2 x { i32, ptr, ptr }] [
  { i32, ptr, ptr } { i32 65535, ptr @late, ptr null },
  { i32, ptr, ptr } { i32 101, ptr @early, ptr null }]
@other_name = alias void (), ptr @called
define void @taken() {
  ret void
}
define void @kept() {
  ret void
}
define void @late() {
  ret void
}
define void @early() {
  call void @other_name()
  ret void
}
define void @called() {
  ret void
}
define ptr @through_alias() {
  ret ptr @alias_of_aliased
}
@alias_of_aliased = alias void (), ptr @aliased
define void @aliased() {
  ret void
})");
    std::set<std::string> taken;
    for (const auto& function : mir.functions) {
        if (function.address_taken) taken.insert(mir.symbols[function.symbol]);
    }
    EXPECT_EQ(taken, (std::set<std::string>{"taken", "aliased"}));
    EXPECT_NE(print(mir).find("call called"), std::string::npos);
}

}  // namespace
