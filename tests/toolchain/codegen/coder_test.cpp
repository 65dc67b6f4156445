// The account of registers and slots, and single instructions.
#include "toolchain/codegen/coder.hpp"

#include <gtest/gtest.h>

#include "tests/toolchain/codegen/coder_fixture.hpp"

namespace {

using namespace toolchain::codegen;
using namespace codegen_test;
using enum Register;

class CoderTest : public CoderFixture {
protected:
    Bytes x = in({l, h});
    Bytes y = in({e});
    Bytes sum;

    void SetUp() override {
        sum = builder.add({x[0]}, y);
        give_back({sum[0], x[1]});
    }
};

TEST_F(CoderTest, CostIsTStatesAndWeighedBytes) {
    Coder cheap = coder(0);
    Coder dear = coder(2);
    for (Coder* one : {&cheap, &dear}) {
        one->emit_number(by_pair(op::kLxi, Pair::bc), 0x1234);
        one->emit(op::kXchg);
    }
    EXPECT_EQ(cheap.cost, 10 + 4);
    EXPECT_EQ(dear.cost, 10 + 4 + 2 * (3 + 1));
    Coder jumping = coder(0);
    jumping.emit_jump(op::kJz, 1, 0.5);  // 7 or 10
    EXPECT_EQ(jumping.cost, 8.5);
}

TEST_F(CoderTest, WhatIsWhere) {
    Coder start = coder();
    EXPECT_TRUE(start.holds(Pair::hl, x[0], x[1]));
    EXPECT_EQ(start.find(y[0]), e);
    EXPECT_EQ(start.find(y[0], set_of(Pair::hl)), flags);
    EXPECT_FALSE(start.in_slot(y[0]));
    start.mark_stored(y[0]);
    EXPECT_TRUE(start.in_slot(y[0]));
}

TEST_F(CoderTest, NeedsEndWithTheLastUse) {
    Coder start = coder();
    EXPECT_TRUE(start.needed(x[0], false));  // by the operation at hand
    EXPECT_FALSE(start.needed(x[0], true));  // not behind it
    EXPECT_TRUE(start.needed(x[1], true));   // returned
    EXPECT_EQ(start.next_use(x[1]), 1U);
    EXPECT_TRUE(start.only_copy(h, true));
    start.set(b, x[1]);
    EXPECT_FALSE(start.only_copy(h, true));
    EXPECT_TRUE(start.only_copy(h, true, set_of(b)));  // if B is lost too
}

TEST_F(CoderTest, ArithmeticForgetsWhatTheFlagsTold) {
    Coder start = coder();
    start.state.tested = y[0];
    start.emit(mov(b, c));
    EXPECT_EQ(start.state.tested, y[0]);
    start.emit(op::kInr);
    EXPECT_EQ(start.state.tested, kNone);
}

TEST_F(CoderTest, OperandsWhereverTheyAre) {
    Coder in_register = coder();
    in_register.alu(alu::kAdd, y[0]);
    EXPECT_EQ(text_of(in_register.items), "ADD E");
    Coder in_slot = coder();
    in_slot.mark_stored(y[0]);
    in_slot.forget(set_of(e));
    in_slot.lock(Pair::hl);
    in_slot.alu(alu::kXra, y[0]);
    EXPECT_EQ(text_of(in_slot.items), "PUSH H; LXI H,d16; XRA M; POP H");
    Coder nowhere = coder();
    nowhere.forget(set_of(e));
    nowhere.alu(alu::kAdd, y[0]);
    EXPECT_TRUE(nowhere.failed);
}

}  // namespace
