// A block between its contracts: the code by hand, the way out, what cannot be done.
#include "toolchain/codegen/block_code.hpp"

#include <gtest/gtest.h>

#include "tests/toolchain/codegen/coder_fixture.hpp"

namespace {

using namespace toolchain::codegen;
using namespace codegen_test;
using enum Register;

class BlockCodeTest : public CoderFixture {
protected:
    std::vector<Contract> contracts;

    BlockCode make(BlockId next = kNone, bool only_cost = false) {
        contracts.resize(facts.function.blocks.size());
        Contract& entry = contracts[0];
        const Bytes& parameters = facts.function.blocks[0].parameters;
        for (std::size_t i = 0; i < parameters.size(); ++i) {
            entry.registers[static_cast<unsigned>(function.parameter_registers[i])] = parameters[i];
            entry.not_in_slot.push_back(parameters[i]);
        }
        BlockSetting setting;
        setting.next = next;
        setting.byte_cost = 0;
        setting.recipes = context();
        setting.entry = &entry;
        setting.contracts = &contracts;
        setting.only_cost = only_cost;
        return make_block(facts, setting);
    }
};

TEST_F(BlockCodeTest, ASumOfWords) {
    const Bytes x = in({l, h});
    const Bytes y = in({e, d});
    function.result_registers = {l, h};
    give_back(builder.add(x, y));
    const BlockCode code = make();
    EXPECT_EQ(text_of(code.items), "DAD D; RET");
    EXPECT_EQ(code.cost, 10 + 10);
    EXPECT_TRUE(code.cold.empty());
}

TEST_F(BlockCodeTest, TheCostAloneIsTheSame) {
    const Bytes x = in({l, h});
    const Bytes y = in({e, d});
    function.result_registers = {l, h};
    give_back(builder.subtract(builder.shift_left(x, 2), builder.bitwise(Opcode::bit_or, x, y)));
    const BlockCode code = make();
    const BlockCode cost = make(kNone, true);
    EXPECT_EQ(cost.cost, code.cost);
    EXPECT_TRUE(cost.items.empty());
}

class BlockCodeBranch : public BlockCodeTest {
protected:
    Bytes x = in({a});
    Bytes y = in({c});

    /// if (x < y) goto 1(x); else goto 2()
    void make_branch() {
        function.blocks.resize(3);
        const Bytes parameter = builder.parameter(1);
        function.blocks[1].parameters = parameter;
        function.blocks[1].parameter_sizes = {1};
        Terminator end;
        end.kind = Terminator::Kind::branch;
        end.predicate = Predicate::below;
        end.left = x;
        end.right = y;
        end.edges = {{1, x}, {2, {}}};
        builder.terminate(end);
        builder.set_block(2);
        Terminator out;
        out.kind = Terminator::Kind::give_back;
        out.left = builder.constant(0, 1);
        builder.terminate(out);
        builder.set_block(1);
        function.result_registers = {a};
        give_back(parameter);
        contracts.resize(3);
        contracts[1].registers[static_cast<unsigned>(a)] = parameter[0];
        contracts[1].not_in_slot = parameter;
    }
};

TEST_F(BlockCodeBranch, WhatFollowsIsNotJumpedTo) {
    make_branch();
    // Labels of edges without code are only threaded by the peephole, so texts may hold some.
    const std::string first = text_of(make(1).items);
    EXPECT_TRUE(first.starts_with("CMP C; JNC a16")) << first;
    EXPECT_EQ(first.find("JMP"), std::string::npos);
    const std::string second = text_of(make(2).items);
    EXPECT_TRUE(second.starts_with("CMP C; JC a16")) << second;
    EXPECT_EQ(second.find("JMP"), std::string::npos);
}

TEST_F(BlockCodeBranch, MovesOfAnEdgeAreOutOfLineOrBehindTheBranch) {
    make_branch();
    contracts[1].registers.fill(kNone);
    contracts[1].registers[static_cast<unsigned>(e)] = facts.function.blocks[1].parameters[0];
    const BlockCode code = make(2);
    EXPECT_NE((text_of(code.items) + text_of(code.cold)).find("MOV E,A"), std::string::npos);
}

// x < y ? x : 7, both to block 1 that follows: one edge is empty, so the other is jumped over.
TEST_F(BlockCodeTest, BothWaysToOneBlockMeetThere) {
    const Bytes x = in({a});
    const Bytes y = in({c});
    function.blocks.resize(2);
    const Bytes parameter = builder.parameter(1);
    function.blocks[1].parameters = parameter;
    function.blocks[1].parameter_sizes = {1};
    Terminator end;
    end.kind = Terminator::Kind::branch;
    end.predicate = Predicate::below;
    end.left = x;
    end.right = y;
    end.edges = {{1, x, 0.5}, {1, builder.constant(7, 1), 0.5}};
    builder.terminate(end);
    builder.set_block(1);
    function.result_registers = {a};
    give_back(parameter);
    contracts.resize(2);
    contracts[1].registers[static_cast<unsigned>(a)] = parameter[0];
    contracts[1].not_in_slot = parameter;
    const BlockCode code = make(1);
    EXPECT_EQ(text_of(code.items), "CMP C; JC a16; L:; MVI A,d8");
    EXPECT_EQ(text_of(code.cold), "L:; JMP a16");  // threaded away
}

}  // namespace
