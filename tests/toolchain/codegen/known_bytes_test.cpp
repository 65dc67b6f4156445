// What is known about bytes: demand, zeros, signs, also around loops.
#include "toolchain/codegen/known_bytes.hpp"

#include <gtest/gtest.h>

#include <string>

#include "toolchain/codegen/builder.hpp"

namespace {

using namespace toolchain::codegen;

/// A function f(word x) with blocks to fill.
class KnownBytesTest : public testing::Test {
protected:
    Module module;
    Function function;
    Builder builder{function};
    Bytes x;

    void SetUp() override {
        function.symbol = module.intern("f");
        function.blocks.resize(3);
        x = builder.parameter(2);
        function.parameters = {x};
        function.blocks[0].parameters = x;
        for (const BlockId id : {1U, 2U}) give_back(id, {});
    }

    void give_back(BlockId id, const Bytes& value) {
        Terminator& end = function.blocks[id].terminator;
        end.kind = Terminator::Kind::give_back;
        end.left = value;
    }
    void jump(BlockId from, BlockId to, const Bytes& arguments) {
        Terminator& end = function.blocks[from].terminator;
        end.kind = Terminator::Kind::jump;
        end.edges = {{to, arguments}};
    }
    /// Block 1 goes to itself or to 2, with a parameter each time round.
    Bytes loop(const Bytes& first, std::size_t size) {
        const Bytes parameter = builder.parameter(size);
        function.blocks[1].parameters = parameter;
        jump(0, 1, first);
        return parameter;
    }
    void close_loop(const Bytes& next) {
        Terminator& end = function.blocks[1].terminator;
        end = {};
        end.kind = Terminator::Kind::branch;
        end.left = end.right = {x[0]};
        end.edges = {{1, next}, {2, {}}};
    }
};

TEST_F(KnownBytesTest, RoutinesWithoutEffects) {
    for (const char* name : {"__mul8", "__umul16w", "__smul16w", "__udiv64", "__sdiv8", "__shl16",
                             "__lshr8", "__ashr64"}) {
        EXPECT_TRUE(is_arithmetic_routine(name)) << name;
    }
    for (const char* name : {"__memcpy", "__mul", "__shl_mine", "main", "__callhl"}) {
        EXPECT_FALSE(is_arithmetic_routine(name)) << name;
    }
}

TEST_F(KnownBytesTest, WidthsOfExtensions) {
    const Bytes zero = builder.zero_extended(x, 4);
    const Bytes sign = builder.sign_extended(x, 4);
    const Bytes both = builder.zero_extended(builder.sign_extended({x[0]}, 2), 4);
    const Bytes nested = builder.sign_extended(builder.sign_extended({x[0]}, 2), 4);
    KnownBytes known(function);
    EXPECT_EQ(known.zero_width(zero), 2U);
    EXPECT_EQ(known.sign_width(zero), 3U);
    EXPECT_EQ(known.zero_width(sign), 4U);
    EXPECT_EQ(known.sign_width(sign), 2U);
    EXPECT_EQ(known.zero_width(both), 2U);
    EXPECT_EQ(known.sign_width(both), 3U);
    EXPECT_EQ(known.sign_width(nested), 1U);
    EXPECT_EQ(known.zero_width(x), 2U);
    EXPECT_EQ(known.sign_width(x), 2U);
}

TEST_F(KnownBytesTest, SignsOfConstants) {
    const Bytes minus = builder.constant(0xFF80, 2);
    const Bytes plus = builder.constant(0x007F, 2);
    const Bytes wide = builder.constant(0x0080, 2);
    KnownBytes known(function);
    EXPECT_EQ(known.sign_width(minus), 1U);
    EXPECT_EQ(known.sign_width(plus), 1U);
    EXPECT_EQ(known.sign_width(wide), 2U);
}

TEST_F(KnownBytesTest, TopBitsThatAreZero) {
    const Bytes masked = builder.bitwise(Opcode::bit_and, {x[0]}, builder.constant(0x7F, 1));
    const Bytes wider = builder.bitwise(Opcode::bit_and, {x[0]}, builder.constant(0x81, 1));
    const Bytes right = builder.shift_right(x, 1);
    const ByteId flag = builder.compare(Predicate::less, x, builder.constant(5, 2));
    KnownBytes known(function);
    EXPECT_TRUE(known.is_not_negative(masked[0]));
    EXPECT_FALSE(known.is_not_negative(wider[0]));
    EXPECT_FALSE(known.is_not_negative(right[0]));
    EXPECT_TRUE(known.is_not_negative(right[1]));
    EXPECT_TRUE(known.is_not_negative(flag));
    EXPECT_FALSE(known.is_not_negative(x[0]));
}

TEST_F(KnownBytesTest, WhatGoesRoundALoopUnchangedIsKnown) {
    const Bytes round = loop(builder.sign_extended({x[0]}, 4), 4);
    close_loop(round);
    KnownBytes known(function);
    EXPECT_EQ(known.sign_width(round), 1U);
    EXPECT_EQ(known.zero_width(round), 4U);
}

TEST_F(KnownBytesTest, OneWayThatDiffersIsEnough) {
    const Bytes round = loop(builder.zero_extended({x[0]}, 3), 3);
    builder.set_block(1);
    const Bytes more = builder.add(round, builder.constant(1, 3));
    close_loop({round[0], more[1], round[2]});
    KnownBytes known(function);
    // The middle byte changes, so the top byte is still zero but nothing below.
    EXPECT_EQ(known.zero_width(round), 2U);
    EXPECT_FALSE(known.is_constant(round[1], 0));
    EXPECT_TRUE(known.is_constant(round[2], 0));
}

// The middle byte is the sign of the lowest only if the top one is of the middle one, and that is
// false: a yes on the way must not be kept.
TEST_F(KnownBytesTest, AWrongGuessIsForgotten) {
    const Bytes round = loop(builder.sign_extended({x[0]}, 2), 2);
    builder.set_block(1);
    close_loop({round[1], round[0]});
    KnownBytes known(function);
    EXPECT_FALSE(known.is_sign_of(round[1], round[0]));
    EXPECT_FALSE(known.is_sign_of(round[0], round[1]));
    EXPECT_FALSE(known.is_sign_of(round[1], round[0]));
}

TEST_F(KnownBytesTest, OnlyWhatMattersIsDemanded) {
    const Bytes sum = builder.add(builder.zero_extended(x, 4), builder.constant(0x01010101, 4));
    const Bytes product =
        builder.call(module.intern("__mul32"), {sum, builder.zero_extended(x, 4)}, 4);
    const Bytes dead = builder.add(x, x);
    jump(0, 1, {});
    give_back(1, {product[0], product[1]});
    const auto demanded = demanded_bytes(module, function);
    EXPECT_TRUE(demanded[product[0]] && demanded[product[1]]);
    EXPECT_FALSE(demanded[product[2]] || demanded[product[3]]);
    EXPECT_TRUE(demanded[sum[0]] && demanded[sum[1]]);
    EXPECT_FALSE(demanded[sum[2]] || demanded[sum[3]]);
    EXPECT_FALSE(demanded[dead[0]]);
}

TEST_F(KnownBytesTest, EffectsAreDemandedAndSoAreEdges) {
    const Bytes address = builder.address(module.intern("v"), 0);
    const Bytes sum = builder.add(x, builder.constant(3, 2));
    const Bytes quiet = builder.load(sum, 1, false);
    const Bytes loud = builder.load(builder.add(x, builder.constant(9, 2)), 1, true);
    const Bytes parameter = builder.parameter(2);
    function.blocks[1].parameters = parameter;
    jump(0, 1, {x[0], x[1]});
    builder.set_block(1);
    builder.store(address, {parameter[1]}, false);
    const auto demanded = demanded_bytes(module, function);
    EXPECT_FALSE(demanded[quiet[0]] || demanded[sum[0]]);
    EXPECT_FALSE(demanded[loud[0]]);  // the load stays, its value does not matter
    EXPECT_TRUE(demanded[parameter[1]] && demanded[x[1]]);
    EXPECT_FALSE(demanded[parameter[0]]);
    EXPECT_TRUE(demanded[function.blocks[0].operations.back().left[0]]);
}

}  // namespace
