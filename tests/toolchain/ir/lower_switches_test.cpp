// Switches go where they went before, and dense ones become tables; expected values from the
// cases written down here.
#include "toolchain/ir/passes.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <map>
#include <string>

#include "tests/toolchain/ir/ir_program.hpp"

namespace {

using toolchain::codegen::Terminator;

/// Case value to result; anything else gives 99.
using Cases = std::map<int64_t, uint64_t>;

std::string program(unsigned bits, const Cases& cases, const char* other) {
    std::string switches;
    std::string incoming;
    for (const auto& [value, result] : cases) {
        switches += fmt::format(" i{} {}, label %to{}", bits, value, result);
        if (incoming.find(fmt::format("%to{} ", result)) == std::string::npos)
            incoming += fmt::format(", [ {0}, %to{0} ]", result);
    }
    std::string text = fmt::format("define i16 @f(i{} %a) {{\n switch i{} %a, label %{} [{}]\n",
                                   bits, bits, other, switches);
    std::map<uint64_t, bool> done;
    for (const auto& [value, result] : cases) {
        if (!done.try_emplace(result, true).second) continue;
        text += fmt::format("to{}:\n br label %join\n", result);
    }
    return text +
           "other:\n br label %join\nnever:\n unreachable\njoin:\n %r = phi i16 [ 99, %other ]" +
           incoming + "\n ret i16 %r\n}\n";
}

unsigned tables(const toolchain::codegen::Module& mir) {
    unsigned count = 0;
    for (const auto& block : mir.functions.front().blocks) {
        if (block.terminator.kind == Terminator::Kind::table) ++count;
    }
    return count;
}

void check(unsigned bits, const Cases& cases, unsigned wanted_tables) {
    const auto mir = ir_test::to_mir(program(bits, cases, "other"));
    EXPECT_EQ(tables(mir), wanted_tables);
    codegen_test::Interpreter interpreter(mir);
    const uint64_t mask = bits == 64 ? UINT64_MAX : (uint64_t{1} << bits) - 1;
    const auto at = [&](int64_t value) {
        const auto known = cases.find(value);
        const uint64_t wanted = known == cases.end() ? 99 : known->second;
        ASSERT_EQ(interpreter.call("f", {static_cast<uint64_t>(value) & mask}), wanted)
            << bits << " bits, " << value;
    };
    for (int64_t value = -140; value < 400; ++value) {
        if (bits == 8 && (value < -128 || value > 127)) continue;
        at(value);
    }
    for (const auto& [value, result] : cases) {
        for (const int64_t near : {value - 1, value, value + 1}) {
            if (bits > 16 || (near >= -32768 && near <= 32767)) at(near);
        }
    }
}

TEST(LowerSwitches, DenseOnesBecomeTables) {
    for (const unsigned bits : {8U, 16U, 32U}) {
        check(bits, {{0, 1}, {1, 2}, {2, 3}, {3, 4}, {4, 5}}, 1);
        check(bits, {{10, 1}, {11, 2}, {14, 3}, {16, 4}, {17, 5}, {18, 6}}, 1);
        check(bits, {{-2, 1}, {-1, 2}, {0, 3}, {1, 4}, {2, 5}}, 1);
    }
}

TEST(LowerSwitches, FewOrScatteredCasesBecomeTrees) {
    for (const unsigned bits : {8U, 16U, 64U}) {
        check(bits, {{0, 1}, {1, 2}, {2, 3}, {3, 4}}, 0);
        check(bits, {{0, 1}, {10, 2}, {20, 3}, {33, 4}, {47, 5}, {100, 6}, {-100, 7}}, 0);
    }
    check(16, {}, 0);
    check(16, {{-32768, 1}, {32767, 2}}, 0);
}

TEST(LowerSwitches, RunsOfOneTargetAreOneComparison) {
    Cases cases;
    for (int64_t value = 20; value < 60; ++value) cases[value] = 7;
    check(16, cases, 0);
    const auto mir = ir_test::to_mir(program(16, cases, "other"));
    std::size_t branches = 0;
    for (const auto& block : mir.functions.front().blocks) {
        if (block.terminator.kind == Terminator::Kind::branch) ++branches;
    }
    EXPECT_EQ(branches, 1U);
}

TEST(LowerSwitches, DensePartsOfScatteredCasesBecomeTables) {
    Cases cases = {{-30000, 40}, {1000, 41}, {2000, 42}, {2001, 43}};
    for (int64_t value = 0; value < 10; ++value) cases[value] = static_cast<uint64_t>(value);
    for (int64_t value = 300; value < 320; value += 2) cases[value] = static_cast<uint64_t>(value);
    check(16, cases, 2);
}

TEST(LowerSwitches, TablesAreCutAt128Entries) {
    Cases cases;
    for (int64_t value = 0; value < 200; ++value) cases[value] = static_cast<uint64_t>(value % 50);
    check(16, cases, 2);
}

TEST(LowerSwitches, UnreachableDefaultNeedsNoRangeCheck) {
    const Cases cases = {{3, 1}, {4, 2}, {5, 3}, {6, 4}, {7, 5}};
    const auto mir = ir_test::to_mir(program(16, cases, "never"));
    EXPECT_EQ(tables(mir), 1U);
    codegen_test::Interpreter interpreter(mir);
    for (const auto& [value, result] : cases) {
        EXPECT_EQ(interpreter.call("f", {static_cast<uint64_t>(value)}), result);
    }
    for (const auto& block : mir.functions.front().blocks) {
        EXPECT_NE(block.terminator.kind, Terminator::Kind::branch);
    }
}

}  // namespace
