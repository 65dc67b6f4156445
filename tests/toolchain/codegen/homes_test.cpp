// Register homes: a countdown loop needs no memory, and the search never makes anything worse.
#include "toolchain/codegen/homes.hpp"

#include <gtest/gtest.h>

#include "tests/toolchain/codegen/coder_fixture.hpp"

namespace {

using namespace toolchain::codegen;
using namespace codegen_test;
using enum Register;

class Homes : public CoderFixture {
protected:
    /// do sum += sum; while (--count != 0); return sum
    void make_loop() {
        const Bytes count = in({a});
        const Bytes sum = in({l, h});
        const Bytes counter = builder.parameter(1);
        const Bytes now = builder.parameter(2);
        function.blocks.resize(3);
        function.blocks[1].parameters = {counter[0], now[0], now[1]};
        function.blocks[1].parameter_sizes = {1, 2};
        function.blocks[1].frequency = 10;
        function.blocks[1].loop_depth = 1;
        Terminator enter;
        enter.kind = Terminator::Kind::jump;
        enter.edges = {{1, {count[0], sum[0], sum[1]}}};
        builder.terminate(enter);
        builder.set_block(1);
        const Bytes next = builder.add(now, now);
        const Bytes less = builder.add(counter, builder.constant(0xFF, 1));
        Terminator again;
        again.kind = Terminator::Kind::branch;
        again.predicate = Predicate::not_equal;
        again.left = less;
        again.right = builder.constant(0, 1);
        again.edges = {{1, {less[0], next[0], next[1]}}, {2, {}}};
        builder.terminate(again);
        builder.set_block(2);
        function.result_registers = {l, h};
        give_back(next);
    }

    FunctionBlocks make(bool search) {
        HomesOptions options;
        options.search = search;
        options.recipes = context();
        return make_blocks(facts, options);
    }
};

TEST_F(Homes, ACountdownLoopLivesInRegisters) {
    make_loop();
    const FunctionBlocks blocks = make(true);
    EXPECT_EQ(blocks.order, (std::vector<BlockId>{0, 1, 2}));
    const std::string loop = text_of(blocks.blocks[1].items);
    EXPECT_EQ(loop.find("a16"), loop.find("JNZ a16") + 4) << loop;  // no LDA, STA, LHLD, SHLD
    EXPECT_NE(loop.find("DAD H"), std::string::npos) << loop;
    EXPECT_NE(loop.find("DCR"), std::string::npos) << loop;
}

TEST_F(Homes, SearchPays) {
    make_loop();
    EXPECT_LT(make(true).cost, make(false).cost);
}

TEST_F(Homes, TheResultDependsOnNothingElse) {
    make_loop();
    const FunctionBlocks first = make(true);
    const FunctionBlocks second = make(true);
    for (std::size_t i = 0; i < first.blocks.size(); ++i) {
        EXPECT_EQ(text_of(first.blocks[i].items), text_of(second.blocks[i].items));
    }
}

// if (x == 0) *place = 1; return x
TEST_F(Homes, ADetourStandsBetweenWhatItLeavesAndJoins) {
    function.blocks.resize(3);
    const Bytes x = in({a});
    Terminator end;
    end.kind = Terminator::Kind::branch;
    end.predicate = Predicate::equal;
    end.left = x;
    end.right = builder.constant(0, 1);
    end.edges = {{1, {}}, {2, {}}};
    builder.terminate(end);
    function.blocks[1].frequency = 0.1;
    builder.set_block(1);
    builder.store(builder.constant(0x9000, 2), builder.constant(1, 1), false);
    Terminator back;
    back.kind = Terminator::Kind::jump;
    back.edges = {{2, {}}};
    builder.terminate(back);
    builder.set_block(2);
    function.result_registers = {a};
    give_back(x);
    EXPECT_EQ(make(false).order, (std::vector<BlockId>{0, 1, 2}));
}

}  // namespace
