// Liveness, places in memory, interference: small functions by hand.
#include "toolchain/codegen/facts.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "toolchain/codegen/builder.hpp"

namespace {

using namespace toolchain::codegen;
using testing::Test;

bool contains(const std::vector<uint32_t>& all, uint32_t one) {
    return std::find(all.begin(), all.end(), one) != all.end();
}

TEST(Bits, SmallAndLargeNumbers) {
    Bits bits(1000);
    for (const std::size_t at : {0U, 63U, 64U, 255U, 256U, 999U}) {
        EXPECT_FALSE(bits.test(at));
        bits.set(at);
        EXPECT_TRUE(bits.test(at));
    }
    const Bits before = bits;
    bits.reset(256);
    EXPECT_FALSE(bits.test(256));
    EXPECT_TRUE(bits.test(255));
    EXPECT_NE(bits, before);
}

TEST(LocalNumbers, AreGivenInOrderAndFoundAgain) {
    LocalNumbers numbers;
    for (uint32_t i = 0; i < 100; ++i) EXPECT_EQ(numbers.add(7 * i + 3), i);
    for (uint32_t i = 0; i < 100; ++i) EXPECT_EQ(numbers.find(7 * i + 3), i);
    EXPECT_EQ(numbers.add(3), 0U);
    EXPECT_EQ(numbers.find(4), kNone);
}

/// for (i = n; i != 0; --i) sum += step; return sum
class FactsLoop : public Test {
protected:
    Function function;
    Builder builder{function};
    Bytes n = builder.parameter(1), step = builder.parameter(2);
    Bytes counter = builder.parameter(1), sum = builder.parameter(2);
    Bytes next_counter, next_sum;

    void SetUp() override {
        function.blocks.resize(3);
        function.parameters = {n, step};
        function.blocks[0].parameters = {n[0], step[0], step[1]};
        function.blocks[0].parameter_sizes = {1, 2};
        function.parameter_registers = {Register::a, Register::l, Register::h};
        function.blocks[1].parameters = {counter[0], sum[0], sum[1]};
        function.blocks[1].parameter_sizes = {1, 2};
        function.result_size = 2;
        const Bytes zero = builder.constant(0, 2);
        Terminator enter;
        enter.kind = Terminator::Kind::jump;
        enter.edges = {{1, {n[0], zero[0], zero[1]}}};
        builder.terminate(enter);
        builder.set_block(1);
        next_sum = builder.add(sum, step);
        next_counter = builder.add(counter, builder.constant(0xFF, 1));
        Terminator again;
        again.kind = Terminator::Kind::branch;
        again.predicate = Predicate::not_equal;
        again.left = next_counter;
        again.right = {zero[0]};
        again.edges = {{1, {next_counter[0], next_sum[0], next_sum[1]}}, {2, {}}};
        builder.terminate(again);
        function.blocks[1].frequency = 8;
        builder.set_block(2);
        Terminator out;
        out.kind = Terminator::Kind::give_back;
        out.left = next_sum;
        builder.terminate(out);
        ASSERT_EQ(verify(function), "");
    }
};

TEST_F(FactsLoop, Liveness) {
    const FunctionFacts facts = find_facts(function);
    const auto sorted = [](Bytes bytes) {
        std::sort(bytes.begin(), bytes.end());
        return bytes;
    };
    EXPECT_EQ(facts.blocks[0].live_in, sorted({n[0], step[0], step[1]}));
    EXPECT_EQ(facts.blocks[1].live_in, sorted({step[0], step[1], counter[0], sum[0], sum[1]}));
    EXPECT_EQ(facts.blocks[2].live_in, sorted(next_sum));
}

TEST_F(FactsLoop, WhatGoesRoundSharesItsPlace) {
    const FunctionFacts facts = find_facts(function);
    EXPECT_TRUE(facts.same_place(sum[0], next_sum[0]));
    EXPECT_TRUE(facts.same_place(sum[1], next_sum[1]));
    EXPECT_TRUE(facts.same_place(counter[0], next_counter[0]));
    EXPECT_TRUE(facts.same_place(counter[0], n[0]));
    EXPECT_TRUE(facts.adjacent(sum[0], sum[1]));
    EXPECT_FALSE(facts.adjacent(sum[1], sum[0]));
}

TEST_F(FactsLoop, WhatLivesAtTheSameTimeInterferes) {
    const FunctionFacts facts = find_facts(function);
    const uint32_t sums = facts.variable[sum[0]];
    const uint32_t counters = facts.variable[counter[0]];
    const uint32_t steps = facts.variable[step[0]];
    EXPECT_TRUE(contains(facts.interferes[sums], counters));
    EXPECT_TRUE(contains(facts.interferes[counters], sums));
    EXPECT_TRUE(contains(facts.interferes[steps], sums));
    EXPECT_FALSE(contains(facts.interferes[sums], sums));
}

TEST_F(FactsLoop, AValueThatLivesOnDoesNotShare) {
    // The sum before the addition is returned: it lives while the next one does.
    function.blocks[2].terminator.left = sum;
    const FunctionFacts facts = find_facts(function);
    EXPECT_FALSE(facts.same_place(sum[0], next_sum[0]));
    EXPECT_TRUE(contains(facts.interferes[facts.variable[sum[0]]], facts.variable[next_sum[0]]));
}

TEST_F(FactsLoop, UsesAndProbabilities) {
    const FunctionFacts facts = find_facts(function);
    const BlockFacts& loop = facts.blocks[1];
    EXPECT_EQ(loop.end, 3U);  // two operations, the terminator, what successors need
    const auto& uses = loop.uses[loop.local.find(next_counter[0])];
    EXPECT_EQ(uses, (std::vector<uint32_t>{2, 3}));
    EXPECT_EQ(loop.predecessors, (std::vector<uint32_t>{0, 1}));
    EXPECT_DOUBLE_EQ(loop.edge_probability[0] + loop.edge_probability[1], 1);
    EXPECT_DOUBLE_EQ(loop.edge_probability[1], 1.0 / 8);
}

TEST(Facts, ASumKnowsItsBase) {
    Function function;
    function.blocks.emplace_back();
    Builder builder(function);
    const Bytes x = builder.parameter(2);
    function.parameters = {x};
    function.blocks[0].parameters = x;
    function.blocks[0].parameter_sizes = {2};
    function.parameter_registers = {Register::l, Register::h};
    function.result_size = 2;
    const Bytes once = builder.add(x, builder.constant(5, 2));
    const Bytes twice = builder.add(once, builder.constant(0xFFFD, 2));
    Terminator end;
    end.kind = Terminator::Kind::give_back;
    end.left = twice;
    builder.terminate(end);
    const FunctionFacts facts = find_facts(function);
    EXPECT_EQ(facts.base_of(twice[0], twice[1]), (Base{x[0], x[1], 2}));
    EXPECT_EQ(facts.base_of(x[0], x[1]), (Base{x[0], x[1], 0}));
    EXPECT_FALSE(facts.base_of(x[1], x[0]).same_base(facts.base_of(x[0], x[1])));
}

TEST(Facts, AnEdgeTranslatesParametersOnly) {
    Function function;
    function.blocks.resize(2);
    function.blocks[1].parameters = {7, 8};
    const Edge edge{1, {3, 4}};
    EXPECT_EQ(passed_for(function, edge, 8), 4U);
    EXPECT_EQ(passed_for(function, edge, 9), 9U);
}

}  // namespace
