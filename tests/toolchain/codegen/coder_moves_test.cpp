// Moves: the cheapest instructions, and nothing that is needed gets lost.
#include <gtest/gtest.h>

#include "tests/toolchain/codegen/coder_fixture.hpp"

namespace {

using namespace toolchain::codegen;
using namespace codegen_test;
using enum Register;

class CoderMoves : public CoderFixture {
protected:
    Bytes x = in({l, h});
    Bytes y = in({e, d});
    Bytes near, number;

    void SetUp() override {
        near = builder.constant(0x1002, 2);
        number = builder.constant(0x1000, 2);
        const Bytes first = builder.add(x, near);
        const Bytes second = builder.bitwise(Opcode::bit_xor, first, number);
        give_back({second[0], second[1], x[0], x[1], y[0], y[1]});
    }
};

TEST_F(CoderMoves, PairsAreExchanged) {
    Coder start = coder();
    start.load(Pair::hl, y[0], y[1]);
    EXPECT_EQ(text_of(start.items), "XCHG");
    EXPECT_TRUE(start.holds(Pair::de, x[0], x[1]));
}

TEST_F(CoderMoves, ConstantsAreLoadedAtOnceOrByStepping) {
    Coder start = coder();
    start.load(Pair::bc, number[0], number[1]);
    EXPECT_EQ(text_of(start.items), "LXI B,d16");
    EXPECT_EQ(start.items[0].operand.offset, 0x1000);
    start.items.clear();
    start.load(Pair::bc, near[0], near[1]);
    EXPECT_EQ(text_of(start.items), "INX B; INX B");
    EXPECT_TRUE(start.holds(Pair::bc, near[0], near[1]));
}

TEST_F(CoderMoves, SlotsAreReadByTheShortestWay) {
    Coder start = coder();
    start.mark_stored(y[0]);
    start.mark_stored(y[1]);
    start.forget(set_of(Pair::de));
    Coder byte = start;
    byte.load(a, y[0]);
    EXPECT_EQ(text_of(byte.items), "LDA a16");
    Coder word = start;
    word.load(Pair::de, y[0], y[1]);  // HL keeps its value
    EXPECT_EQ(text_of(word.items), "XCHG; LHLD a16; XCHG");
    EXPECT_TRUE(word.holds(Pair::hl, x[0], x[1]));
    EXPECT_TRUE(word.holds(Pair::de, y[0], y[1]));
}

TEST_F(CoderMoves, VacatingKeepsTheOnlyCopy) {
    Coder start = coder();
    start.vacate(Pair::hl, true);
    ASSERT_FALSE(start.failed);
    for (const ByteId byte : {x[0], x[1]}) {
        const Register where = start.find(byte, static_cast<RegisterSet>(~set_of(Pair::hl)));
        EXPECT_TRUE(start.in_slot(byte) || where != flags) << text_of(start.items);
    }
}

TEST_F(CoderMoves, VacatingACopyIsFree) {
    Coder start = coder();
    start.mark_stored(x[0]);
    start.mark_stored(x[1]);
    start.vacate(Pair::hl, true);
    EXPECT_TRUE(start.items.empty());
}

TEST_F(CoderMoves, LockedRegistersAreNotTouched) {
    Coder start = coder();
    start.lock(h);
    start.vacate(h);
    EXPECT_TRUE(start.failed);
}

TEST_F(CoderMoves, SpillsGoThroughWhatIsFree) {
    Coder word = coder();
    word.spill(l);
    EXPECT_EQ(text_of(word.items), "SHLD a16");
    EXPECT_TRUE(word.in_slot(x[0]) && word.in_slot(x[1]));
    Coder other = coder();
    other.spill(e);
    EXPECT_EQ(text_of(other.items), "XCHG; SHLD a16; XCHG");
}

TEST_F(CoderMoves, ValuesNobodyHasCannotBeLoaded) {
    Coder start = coder();
    start.forget(set_of(Pair::de));
    start.load(a, y[0]);
    EXPECT_TRUE(start.failed);
}

// Found by random functions: HL stepped on from x was exchanged with DE = x, and stepped from there
// as if it were x.
TEST(CoderMovesProgram, AStepFromABaseThatWasExchanged) {
    Module module;
    Function function;
    function.symbol = module.intern("f");
    function.blocks.emplace_back();
    Builder builder(function);
    const Bytes x = builder.parameter(2);
    function.parameters = {x};
    function.blocks[0].parameters = x;
    function.blocks[0].parameter_sizes = {2};
    function.parameter_registers = {e, d};
    const Bytes further = builder.add(x, builder.constant(2, 2));
    Terminator end;
    end.kind = Terminator::Kind::give_back;
    end.left = {further[0], further[1], x[0], x[1]};
    function.result_size = 4;
    builder.terminate(end);
    const FunctionFacts facts = find_facts(function);
    const BlockFacts& block = facts.blocks[0];
    Wishes wishes;
    wishes.slot.assign(block.relevant.size(), 0);
    wishes.registers.assign(block.relevant.size(), 0);
    Coder coder(facts, block, wishes, 0);
    coder.state.in_slot = Bits(block.relevant.size());
    coder.position = 1;
    coder.set(Pair::de, x[0], x[1]);
    coder.set_sum(Pair::hl, {x[0], x[1], 4});
    coder.load(Pair::de, further[0], further[1]);
    EXPECT_EQ(text_of(coder.items), "XCHG; DCX D; DCX D");
    EXPECT_TRUE(coder.holds(Pair::hl, x[0], x[1]));
}

// Found by random functions: a call wanted H and L exchanged while every other register was needed.
TEST_F(CoderMoves, HalvesAreExchangedWithoutAnotherRegister) {
    Coder start = coder();
    start.set(b, y[0]);
    start.set(c, y[1]);
    start.set(Pair::de, y[0], y[1]);
    start.set(a, y[0]);
    start.load(Pair::hl, x[1], x[0]);
    EXPECT_EQ(text_of(start.items), "PUSH PSW; MOV A,L; MOV L,H; MOV H,A; POP PSW");
    EXPECT_TRUE(start.holds(Pair::hl, x[1], x[0]));
}

}  // namespace
