// Calls and the processor's own instructions: arguments in place, what a call destroys is kept.
#include <gtest/gtest.h>

#include "tests/toolchain/codegen/coder_fixture.hpp"

namespace {

using namespace toolchain::codegen;
using namespace codegen_test;
using enum Register;

class RecipesCall : public CoderFixture {
protected:
    /// A call behind lower_calls().
    Bytes call(const Bytes& argument, const std::vector<Register>& registers,
               const std::vector<Register>& results, RegisterSet clobbers) {
        const Bytes value = builder.call(module.intern("routine"), {argument}, results.size());
        Operation& operation = function.blocks[0].operations.back();
        operation.argument_registers = registers;
        operation.result_registers = results;
        operation.clobbers = clobbers;
        return value;
    }
};

TEST_F(RecipesCall, ArgumentsThatAreInPlaceNeedNoMove) {
    const Bytes x = in({l, h});
    give_back(call(x, {l, h}, {l, h}, set_of(flags)));
    EXPECT_EQ(text_of(best_way().items), "CALL a16");
}

TEST_F(RecipesCall, ExchangedArgumentsAreOneXchg) {
    const Bytes x = in({l, h});
    const Bytes y = in({e, d});
    give_back(call({y[0], y[1], x[0], x[1]}, {l, h, e, d}, {l, h}, set_of(flags)));
    EXPECT_EQ(text_of(best_way().items), "XCHG; CALL a16");
}

TEST_F(RecipesCall, WhatLivesOnMovesOutOfTheWay) {
    const Bytes x = in({a});
    Bytes both = call(x, {a}, {a}, set_of(flags));
    both.push_back(x[0]);
    give_back(both);
    const Coder way = best_way();
    EXPECT_EQ(way.cost, 4 + 18);  // one MOV and the CALL
    EXPECT_NE(way.find(x[0]), flags);
}

TEST_F(RecipesCall, WhatIsInUntouchedRegistersStaysThere) {
    const Bytes x = in({a});
    const Bytes y = in({c, b});
    Bytes all = call(x, {a}, {a}, static_cast<RegisterSet>(set_of(Pair::hl) | set_of(flags)));
    all.insert(all.end(), y.begin(), y.end());
    give_back(all);
    EXPECT_EQ(text_of(best_way().items), "CALL a16");
}

TEST_F(RecipesCall, EveryRegisterDestroyedNeedsSlotOrStack) {
    const Bytes x = in({l, h});
    (void)call({}, {}, {}, kAllRegisters);
    give_back(x);
    for (const Coder& way : translate(coder(), operation(), context())) {
        EXPECT_TRUE(way.complete()) << text_of(way.items);
        const bool slot = way.in_slot(x[0]) && way.in_slot(x[1]);
        const bool again = way.holds(Pair::hl, x[0], x[1]);
        EXPECT_TRUE(slot || again) << text_of(way.items);
    }
    EXPECT_EQ(text_of(best_way().items), "SHLD a16; CALL a16");
}

TEST_F(RecipesCall, PortsAreReadAndWrittenThroughA) {
    const Bytes value = builder.processor(Opcode::port_in, 0x42, {}, 1);
    give_back(value);
    const Coder way = best_way();
    EXPECT_EQ(text_of(way.items), "IN p8");
    EXPECT_EQ(way.items[0].operand.offset, 0x42);
    EXPECT_TRUE(way.holds(a, value[0]));
}

TEST_F(RecipesCall, BringingACircleOfPairs) {
    const Bytes x = in({l, h});
    const Bytes y = in({e, d});
    const Bytes z = in({c, b});
    give_back({x[0], x[1], y[0], y[1], z[0], z[1]});
    Coder way = coder();
    Wanted wanted;
    wanted.fill(kNone);
    const auto want = [&](Pair pair, const Bytes& value) {
        wanted[static_cast<unsigned>(low_of(pair))] = value[0];
        wanted[static_cast<unsigned>(high_of(pair))] = value[1];
    };
    want(Pair::hl, y);
    want(Pair::de, z);
    want(Pair::bc, x);
    way.position = facts.blocks[0].end - 1;
    if (!bring(way, wanted)) GTEST_SKIP() << "goes over the stack";
    EXPECT_TRUE(way.holds(Pair::hl, y[0], y[1]));
    EXPECT_TRUE(way.holds(Pair::de, z[0], z[1]));
    EXPECT_TRUE(way.holds(Pair::bc, x[0], x[1]));
}

}  // namespace
