// What nobody needs disappears, and equal constants become one.
#include <gtest/gtest.h>

#include "toolchain/codegen/builder.hpp"
#include "toolchain/codegen/facts.hpp"

namespace {

using namespace toolchain::codegen;

class Simplify : public testing::Test {
protected:
    Module module;
    Function function;
    Builder builder{function};
    Bytes x = builder.parameter(4);

    void SetUp() override {
        function.blocks.emplace_back();
        function.parameters = {x};
        function.blocks[0].parameters = x;
        function.blocks[0].parameter_sizes = {4};
    }

    const std::vector<Operation>& give_back(const Bytes& value) {
        Terminator end;
        end.kind = Terminator::Kind::give_back;
        end.left = value;
        function.result_size = static_cast<uint32_t>(value.size());
        builder.terminate(end);
        simplify(function);
        return function.blocks[0].operations;
    }
};

TEST_F(Simplify, UnusedResultsDisappear) {
    (void)builder.add(x, x);
    (void)builder.load(builder.address(module.intern("v"), 0), 1, false);
    EXPECT_TRUE(give_back(x).empty());
}

// x == 0 goes through an empty block: both edges lead to the same block, with what they bring.
TEST_F(Simplify, EmptyBlocksDisappearAndLeaveTheirProbability) {
    function.blocks.resize(3);
    const Bytes parameter = builder.parameter(1);
    function.blocks[2].parameters = parameter;
    function.blocks[2].parameter_sizes = {1};
    function.blocks[1].frequency = 0.25;
    Terminator branch;
    branch.kind = Terminator::Kind::branch;
    branch.predicate = Predicate::equal;
    branch.left = {x[0]};
    branch.right = builder.constant(0, 1);
    branch.edges = {{1, {}}, {2, {x[1]}}};
    builder.terminate(branch);
    builder.set_block(1);
    Terminator jump;
    jump.kind = Terminator::Kind::jump;
    jump.edges = {{2, {x[2]}}};
    builder.terminate(jump);
    builder.set_block(2);
    Terminator end;
    end.kind = Terminator::Kind::give_back;
    end.left = parameter;
    function.result_size = 1;
    builder.terminate(end);
    simplify(function);
    ASSERT_EQ(function.blocks.size(), 2U);
    const std::vector<Edge>& edges = function.blocks[0].terminator.edges;
    EXPECT_EQ(edges[0].target, 1U);
    EXPECT_EQ(edges[1].target, 1U);
    EXPECT_EQ(edges[0].arguments, Bytes{x[2]});
    EXPECT_EQ(edges[1].arguments, Bytes{x[1]});
    EXPECT_DOUBLE_EQ(edges[0].probability, 0.25);
    EXPECT_DOUBLE_EQ(edges[1].probability, 0.75);
}

TEST_F(Simplify, EffectsStay) {
    const Bytes place = builder.address(module.intern("v"), 0);
    (void)builder.load(place, 1, true);
    builder.store(place, {x[0]}, false);
    (void)builder.call(module.intern("g"), {}, 1);
    (void)builder.processor(Opcode::port_in, 1, {}, 1);
    EXPECT_EQ(give_back({}).size(), 4U);
}

TEST_F(Simplify, SumsEndAtTheirHighestNeededByte) {
    const Bytes sum = builder.add(x, x);
    const std::vector<Operation>& operations = give_back({sum[1]});
    ASSERT_EQ(operations.size(), 1U);
    EXPECT_EQ(operations[0].results.size(), 2U);  // the carry of the lowest is needed
    EXPECT_EQ(operations[0].left.size(), 2U);
}

TEST_F(Simplify, ShiftsToTheRightKeepTheirTop) {
    const Bytes shifted = builder.shift_right(x, 1);
    EXPECT_EQ(give_back({shifted[0]})[0].results.size(), 4U);
}

TEST_F(Simplify, VolatileLoadsKeepTheirSize) {
    const Bytes value = builder.load(builder.address(module.intern("v"), 0), 4, true);
    EXPECT_EQ(give_back({value[0]})[0].results.size(), 4U);
}

TEST_F(Simplify, EqualConstantsBecomeOne) {
    const Bytes first = builder.bitwise(Opcode::bit_xor, {x[0]}, builder.constant(5, 1));
    function.bytes.push_back({ByteInfo::Kind::constant, 5});
    const auto other = static_cast<ByteId>(function.bytes.size() - 1);
    const Bytes second = builder.bitwise(Opcode::bit_and, {x[1]}, {other});
    const std::vector<Operation>& operations = give_back({first[0], second[0]});
    EXPECT_EQ(operations[0].right, operations[1].right);
}

TEST_F(Simplify, ParametersNobodyReadsAreNotHandedOver) {
    function.blocks.emplace_back();
    const Bytes kept = builder.parameter(1);
    const Bytes dropped = builder.parameter(2);
    function.blocks[1].parameters = {dropped[0], dropped[1], kept[0]};
    function.blocks[1].parameter_sizes = {2, 1};
    const Bytes sum = builder.add({x[0], x[1]}, {x[2], x[3]});
    Terminator jump;
    jump.kind = Terminator::Kind::jump;
    jump.edges = {{1, {sum[0], sum[1], x[2]}}};
    builder.terminate(jump);
    builder.set_block(1);
    (void)give_back(kept);
    EXPECT_EQ(function.blocks[1].parameters, kept);
    EXPECT_EQ(function.blocks[1].parameter_sizes, std::vector<uint32_t>{1});
    EXPECT_EQ(function.blocks[0].terminator.edges[0].arguments, Bytes{x[2]});
    EXPECT_TRUE(function.blocks[0].operations.empty());  // the sum went with its parameter
}

}  // namespace
