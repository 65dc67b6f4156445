// Operations on choices; expected values from the operations themselves.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "tests/toolchain/ir/ir_program.hpp"
#include "toolchain/ir/passes.hpp"

namespace {

using codegen_test::Interpreter;
using ir_test::Passed;
using toolchain::ir::choose_results;

struct Operation {
    const char* name;
    int neutral;
    std::function<uint16_t(uint16_t, uint16_t)> compute;
    bool commutes;
};

const std::vector<Operation> kOperations = {
    {"add", 0, [](auto x, auto y) { return static_cast<uint16_t>(x + y); }, true},
    {"sub", 0, [](auto x, auto y) { return static_cast<uint16_t>(x - y); }, false},
    {"or", 0, [](auto x, auto y) { return static_cast<uint16_t>(x | y); }, true},
    {"xor", 0, [](auto x, auto y) { return static_cast<uint16_t>(x ^ y); }, true},
    {"and", -1, [](auto x, auto y) { return static_cast<uint16_t>(x & y); }, true},
    {"and", 0, [](auto x, auto y) { return static_cast<uint16_t>(x & y); }, true},
    {"mul", 1, [](auto x, auto y) { return static_cast<uint16_t>(x * y); }, true},
    {"mul", 0, [](auto x, auto y) { return static_cast<uint16_t>(x * y); }, true},
};

TEST(ChooseResults, EveryOperationOnBothSidesAndBothWays) {
    for (const Operation& operation : kOperations) {
        for (const bool neutral_first : {false, true}) {
            for (const bool left : {false, true}) {
                if (left && !operation.commutes) continue;
                const Passed passed(
                    fmt::format("define i16 @f(i16 %x, i16 %y, i1 %c) {{\n"
                                "  %z = select i1 %c, i16 {}, i16 {}\n"
                                "  %r = {} i16 {}\n  ret i16 %r\n}}",
                                neutral_first ? std::to_string(operation.neutral) : "%y",
                                neutral_first ? "%y" : std::to_string(operation.neutral),
                                operation.name, left ? "%z, %x" : "%x, %z"),
                    choose_results);
                EXPECT_EQ(passed.count("%z"), 0U) << passed.text;
                Interpreter interpreter(passed.mir);
                for (const unsigned c : {0U, 1U}) {
                    const uint16_t y = (c != 0) == neutral_first
                                           ? static_cast<uint16_t>(operation.neutral)
                                           : uint16_t{1234};
                    ASSERT_EQ(interpreter.call("f", {777, 1234, c}), operation.compute(777, y))
                        << passed.text;
                }
            }
        }
    }
}

TEST(ChooseResults, ConditionsAsNumbers) {
    for (const char* extension : {"zext", "sext"}) {
        const Passed passed(fmt::format("define i16 @f(i16 %x, i1 %c) {{\n"
                                        "  %n = {} i1 %c to i16\n"
                                        "  %r = sub i16 %x, %n\n  ret i16 %r\n}}",
                                        extension),
                            choose_results);
        EXPECT_EQ(passed.count("select"), 1U) << passed.text;
        Interpreter interpreter(passed.mir);
        EXPECT_EQ(interpreter.call("f", {100, 0}), 100U);
        EXPECT_EQ(interpreter.call("f", {100, 1}), extension[0] == 'z' ? 99U : 101U);
    }
}

TEST(ChooseResults, ChoicesWithOtherUsesStay) {
    const Passed passed(R"(
define i16 @f(i16 %x, i16 %y, i1 %c) {
  %z = select i1 %c, i16 %y, i16 0
  %r = add i16 %x, %z
  %s = xor i16 %r, %z
  ret i16 %s
})",
                        choose_results);
    EXPECT_EQ(passed.count("add i16 %x, %z"), 1U) << passed.text;
}

}  // namespace
