// What the builder folds needs no operation, and means what the operation would.
#include "toolchain/codegen/builder.hpp"

#include <gtest/gtest.h>

#include <cstdint>

#include "tests/toolchain/codegen/interpreter.hpp"

namespace {

using namespace toolchain::codegen;

class BuilderTest : public testing::Test {
protected:
    Module module;
    Function function;
    Builder builder{function};
    Bytes x;

    void SetUp() override {
        function.symbol = module.intern("f");
        function.blocks.emplace_back();
        x = builder.parameter(2);
        function.parameters = {x};
        function.blocks[0].parameters = x;
    }
    [[nodiscard]] std::size_t operations() const { return function.blocks[0].operations.size(); }

    /// The function's result for an argument, by the interpreter.
    uint64_t result(const Bytes& value, uint64_t argument) {
        Function whole = function;
        whole.result_size = static_cast<uint32_t>(value.size());
        whole.blocks[0].terminator.kind = Terminator::Kind::give_back;
        whole.blocks[0].terminator.left = value;
        EXPECT_EQ(verify(whole), "");
        module.functions = {whole};
        return codegen_test::Interpreter(module).call("f", {argument});
    }
};

TEST_F(BuilderTest, ConstantsAreComputedAtOnce) {
    const Bytes sum = builder.add(builder.constant(0xFFFF, 2), builder.constant(2, 2));
    EXPECT_EQ(builder.value_of(sum), 1U);
    EXPECT_EQ(builder.value_of(builder.shift_left(builder.constant(0x0181, 2), 1)), 0x0302U);
    EXPECT_EQ(builder.value_of(builder.shift_right_signed(builder.constant(0x8000, 2), 15)),
              0xFFFFU);
    EXPECT_EQ(builder.value_of(builder.bitwise(Opcode::bit_xor, builder.constant(0xF0, 1),
                                               builder.constant(0xFF, 1))),
              0x0FU);
    EXPECT_EQ(operations(), 0U);
}

TEST_F(BuilderTest, NeutralOperandsNeedNoCode) {
    EXPECT_EQ(builder.add(x, builder.constant(0, 2)), x);
    EXPECT_EQ(builder.bitwise(Opcode::bit_and, x, builder.constant(0xFFFF, 2)), x);
    EXPECT_EQ(builder.bitwise(Opcode::bit_or, x, builder.constant(0, 2)), x);
    EXPECT_EQ(builder.value_of(builder.subtract(x, x)), 0U);
    EXPECT_EQ(builder.shift_left(x, 0), x);
    EXPECT_EQ(operations(), 0U);
}

TEST_F(BuilderTest, ShiftsByWholeBytesMoveThem) {
    const Bytes left = builder.shift_left(x, 8);
    EXPECT_EQ(left[1], x[0]);
    const Bytes right = builder.shift_right(x, 8);
    EXPECT_EQ(right[0], x[1]);
    EXPECT_EQ(operations(), 0U);
    EXPECT_EQ(result(left, 0x1234), 0x3400U);
    EXPECT_EQ(result(right, 0x1234), 0x0012U);
}

TEST_F(BuilderTest, AdditionStartsAtTheFirstByteThatChanges) {
    const Bytes sum = builder.add(x, builder.constant(0x0100, 2));
    EXPECT_EQ(sum[0], x[0]);
    ASSERT_EQ(operations(), 1U);
    EXPECT_EQ(function.blocks[0].operations[0].results.size(), 1U);
    EXPECT_EQ(result(sum, 0xFFFF), 0x00FFU);
}

TEST_F(BuilderTest, ShiftedAndExtendedValuesAreRight) {
    EXPECT_EQ(result(builder.shift_left(x, 3), 0x8123), 0x0918U);
    EXPECT_EQ(result(builder.shift_right(x, 11), 0x8123), 0x0010U);
    EXPECT_EQ(result(builder.shift_right_signed(x, 11), 0x8123), 0xFFF0U);
    EXPECT_EQ(result(builder.sign_extended({x[0]}, 3), 0x0080), 0xFFFF80U);
    EXPECT_EQ(result(builder.zero_extended({x[0]}, 3), 0x0080), 0x000080U);
}

TEST_F(BuilderTest, AddressPlusConstantStaysAnAddress) {
    const SymbolId table = module.intern("table");
    const Bytes sum = builder.add(builder.address(table, 5), builder.constant(0xFFFE, 2));
    EXPECT_EQ(function.bytes[sum[0]].kind, ByteInfo::Kind::address_low);
    EXPECT_EQ(function.bytes[sum[1]].kind, ByteInfo::Kind::address_high);
    EXPECT_EQ(function.bytes[sum[0]].offset, 3);
    EXPECT_EQ(operations(), 0U);
}

TEST_F(BuilderTest, LeadingZeroBytesAreKnown) {
    EXPECT_EQ(builder.leading_zero_bytes(builder.zero_extended({x[0]}, 4)), 3U);
    EXPECT_EQ(builder.leading_zero_bytes(x), 0U);
}

}  // namespace
