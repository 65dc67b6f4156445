// Every width of operands, extended both ways, times every operation and width of the result:
// the narrow routines give what the host computes.
#include "toolchain/codegen/narrow_calls.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "tests/toolchain/codegen/interpreter.hpp"
#include "toolchain/codegen/builder.hpp"
#include "toolchain/codegen/lower_calls.hpp"

namespace {

using namespace toolchain::codegen;

struct Source {
    unsigned size;   ///< bytes of the parameter
    bool is_signed;  ///< how it is extended
};

struct Case {
    std::string routine;  ///< without the bits: "__mul"
    unsigned size;        ///< bytes of the operation
    Source left;
    Source right;
    unsigned kept;   ///< bytes of the result that are used
    bool remainder;  ///< of a division
};

uint64_t mask(unsigned size) {
    return size >= 8 ? UINT64_MAX : (uint64_t{1} << 8 * size) - 1;
}

int64_t as_signed(uint64_t value, unsigned size) {
    const unsigned unused = 64 - 8 * size;
    return static_cast<int64_t>(value << unused) >> unused;
}

uint64_t extended(uint64_t value, const Source& source, unsigned size) {
    value &= mask(source.size);
    return (source.is_signed ? static_cast<uint64_t>(as_signed(value, source.size)) : value) &
           mask(size);
}

/// What C computes, or nothing where C does not say.
std::optional<uint64_t> expected(const Case& test, uint64_t left, uint64_t right) {
    const uint64_t a = extended(left, test.left, test.size);
    const bool shift =
        test.routine == "__shl" || test.routine == "__lshr" || test.routine == "__ashr";
    const uint64_t b = shift ? right & 0xFF : extended(right, test.right, test.size);
    const uint64_t kept = mask(test.kept);
    if (test.routine == "__mul") return a * b & kept;
    if (shift) {
        if (b >= 8 * test.size) return std::nullopt;
        if (test.routine == "__shl") return a << b & kept;
        if (test.routine == "__lshr") return a >> b & kept;
        return static_cast<uint64_t>(as_signed(a, test.size) >> b) & kept;
    }
    if (b == 0) return std::nullopt;
    if (test.routine == "__udiv") return (test.remainder ? a % b : a / b) & kept;
    const int64_t x = as_signed(a, test.size);
    const int64_t y = as_signed(b, test.size);
    const bool least = a == (mask(test.size) >> 1) + 1;
    if (y == -1 && least) return std::nullopt;
    if (y == -1) return (test.remainder ? 0 : 0 - a) & kept;
    return static_cast<uint64_t>(test.remainder ? x % y : x / y) & kept;
}

Module module_of(const Case& test) {
    Module module;
    Function function;
    function.symbol = module.intern("f");
    function.blocks.emplace_back();
    Builder builder(function);
    const auto operand = [&](const Source& source) {
        const Bytes parameter = builder.parameter(source.size);
        function.parameters.push_back(parameter);
        Bytes& all = function.blocks[0].parameters;
        all.insert(all.end(), parameter.begin(), parameter.end());
        return source.is_signed ? builder.sign_extended(parameter, test.size)
                                : builder.zero_extended(parameter, test.size);
    };
    const Bytes left = operand(test.left);
    Bytes right = operand(test.right);
    const bool divides = test.routine.ends_with("div");
    const bool multiplies = test.routine == "__mul";
    if (!divides && !multiplies) right.resize(1);
    const unsigned size = divides ? 2 * test.size : multiplies && test.size == 1 ? 2 : test.size;
    const SymbolId routine = module.intern(fmt::format("{}{}", test.routine, 8 * test.size));
    Bytes result = builder.call(routine, {left, right}, size);
    if (test.remainder) result.erase(result.begin(), result.begin() + test.size);
    result.resize(test.kept);
    function.result_size = test.kept;
    Terminator end;
    end.kind = Terminator::Kind::give_back;
    end.left = result;
    builder.terminate(end);
    module.functions.push_back(function);
    return module;
}

std::vector<uint64_t> corners(unsigned size) {
    const uint64_t top = (mask(size) >> 1) + 1;
    std::vector<uint64_t> values = {0, 1, 2, 7, 0x55, top - 1, top, mask(size), mask(size) - 9};
    if (size > 1) values.insert(values.end(), {0xFF, 0x180, 0x1234 & mask(size)});
    if (size > 2) values.insert(values.end(), {0xFFFF, 0x8000, 0x12345678 & mask(size)});
    return values;
}

std::vector<Source> sources(unsigned size) {
    std::vector<Source> result;
    for (unsigned narrow = 1; narrow <= size; narrow *= 2) {
        result.push_back({narrow, false});
        if (narrow < size) result.push_back({narrow, true});
    }
    return result;
}

void check(const Case& test) {
    Module module = module_of(test);
    narrow_calls(module, module.functions[0]);
    ASSERT_EQ(verify(module.functions[0]), "") << print(module);
    Module lowered = module_of(test);
    lower_calls(lowered);
    ASSERT_EQ(verify(lowered.functions[0]), "") << print(lowered);
    codegen_test::Interpreter narrow(module);
    codegen_test::Interpreter flat(lowered);
    for (const uint64_t left : corners(test.left.size)) {
        for (const uint64_t right : corners(test.right.size)) {
            const auto wanted = expected(test, left, right);
            if (!wanted) continue;
            ASSERT_EQ(narrow.call("f", {left, right}), *wanted) << left << ", " << right << "\n"
                                                                << print(module);
            ASSERT_EQ(flat.call("f", {left, right}), *wanted) << left << ", " << right << "\n"
                                                              << print(lowered);
        }
    }
}

class Narrow : public testing::TestWithParam<std::string> {};

TEST_P(Narrow, GivesTheSameBytes) {
    const std::string& routine = GetParam();
    const bool divides = routine.ends_with("div");
    for (unsigned size = 1; size <= 8; size *= 2) {
        for (const Source& left : sources(size)) {
            for (const Source& right : sources(size)) {
                for (unsigned kept = 1; kept <= size; ++kept) {
                    if (kept > 4 && kept < size) continue;
                    check({routine, size, left, right, kept, false});
                    if (divides) check({routine, size, left, right, kept, true});
                    if (testing::Test::HasFatalFailure()) return;
                }
            }
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Operations, Narrow,
                         testing::Values("__mul", "__udiv", "__sdiv", "__shl", "__lshr", "__ashr"),
                         [](const auto& test) { return test.param.substr(2); });

/// Names of the routines called, in their order.
std::string routines(const Case& test) {
    Module module = module_of(test);
    narrow_calls(module, module.functions[0]);
    std::string names;
    for (const Operation& operation : module.functions[0].blocks[0].operations) {
        if (operation.opcode != Opcode::call) continue;
        if (!names.empty()) names += ' ';
        names += module.symbols[operation.symbol];
    }
    return names;
}

constexpr Source kByte = {1, false};
constexpr Source kSignedByte = {1, true};
constexpr Source kWord = {2, false};
constexpr Source kSignedWord = {2, true};
constexpr Source kLong = {4, false};

TEST(NarrowChoice, OfMultiplication) {
    EXPECT_EQ(routines({"__mul", 2, kByte, kByte, 2, false}), "__mul8");
    EXPECT_EQ(routines({"__mul", 2, kSignedByte, kSignedByte, 2, false}), "__mul8s");
    EXPECT_EQ(routines({"__mul", 2, kWord, kByte, 2, false}), "__mul8_16");
    EXPECT_EQ(routines({"__mul", 2, kWord, kWord, 1, false}), "__mul8");
    EXPECT_EQ(routines({"__mul", 4, kSignedWord, kSignedWord, 4, false}), "__smul16w");
    EXPECT_EQ(routines({"__mul", 4, kSignedWord, kByte, 4, false}), "__mul8_s16w");
    EXPECT_EQ(routines({"__mul", 4, kSignedWord, kByte, 2, false}), "__mul8_16");
    EXPECT_EQ(routines({"__mul", 4, kWord, kWord, 4, false}), "__umul16w");
    EXPECT_EQ(routines({"__mul", 4, kWord, kByte, 4, false}), "__mul8_16w");
    EXPECT_EQ(routines({"__mul", 4, kWord, kSignedWord, 4, false}), "__umul16w");
    EXPECT_EQ(routines({"__mul", 4, kLong, kLong, 2, false}), "__mul16");
    EXPECT_EQ(routines({"__mul", 4, kLong, kLong, 4, false}), "__mul32");
    EXPECT_EQ(routines({"__mul", 4, kLong, kByte, 4, false}), "__mul8_16w __mul8_16");
    EXPECT_EQ(routines({"__mul", 4, kLong, kWord, 4, false}), "__umul16w __mul16");
    EXPECT_EQ(routines({"__mul", 8, kSignedWord, kSignedWord, 8, false}), "__smul16w");
    EXPECT_EQ(routines({"__mul", 8, kWord, kWord, 8, false}), "__umul16w");
    EXPECT_EQ(routines({"__mul", 8, kLong, kLong, 4, false}), "__mul32");
}

TEST(NarrowChoice, OfDivision) {
    EXPECT_EQ(routines({"__udiv", 2, kByte, kByte, 2, false}), "__udiv8");
    EXPECT_EQ(routines({"__udiv", 4, kLong, kWord, 4, false}), "__udiv32_16");
    EXPECT_EQ(routines({"__udiv", 4, kWord, kByte, 4, false}), "__udiv16");
    EXPECT_EQ(routines({"__udiv", 8, kLong, kLong, 8, true}), "__udiv32");
    EXPECT_EQ(routines({"__sdiv", 4, kWord, kByte, 4, false}), "__udiv16");
    // -32768 / -1 needs 17 bits.
    EXPECT_EQ(routines({"__sdiv", 4, kSignedWord, kSignedWord, 4, false}), "__sdiv32");
    EXPECT_EQ(routines({"__sdiv", 4, kSignedWord, kSignedWord, 2, false}), "__sdiv16");
    EXPECT_EQ(routines({"__sdiv", 4, kSignedWord, kByte, 4, false}), "__sdiv16");
}

TEST(NarrowChoice, OfShifts) {
    EXPECT_EQ(routines({"__shl", 4, kLong, kByte, 2, false}), "__shl16");
    EXPECT_EQ(routines({"__lshr", 4, kWord, kByte, 4, false}), "__lshr16");
    EXPECT_EQ(routines({"__ashr", 4, kSignedByte, kByte, 4, false}), "__ashr8");
    EXPECT_EQ(routines({"__ashr", 4, kWord, kByte, 4, false}), "__lshr16");
}

}  // namespace
