// Whole functions: interrupts' prologue and epilogue, what is clobbered, the stack, the frame.
#include "toolchain/codegen/generate.hpp"

#include <gtest/gtest.h>

#include "tests/toolchain/codegen/coder_fixture.hpp"
#include "toolchain/codegen/lower_calls.hpp"

namespace {

using namespace toolchain::codegen;
using namespace codegen_test;
using enum Register;

class GenerateTest : public CoderFixture {
protected:
    FunctionCode make() {
        give_back({});
        return generate(module, function);
    }
    Bytes variable() { return builder.address(module.intern("v"), 0); }
};

TEST_F(GenerateTest, AnEmptyFunctionReturns) {
    const FunctionCode code = make();
    EXPECT_EQ(text_of(code.items), "RET");
    EXPECT_EQ(code.clobbers, 0);
    EXPECT_EQ(code.frame_bytes, 0U);
    EXPECT_EQ(code.stack_bytes, 0U);
}

TEST_F(GenerateTest, OnlyWhatIsWrittenIsClobbered) {
    const Bytes x = in({l, h});
    builder.store(variable(), x, false);
    EXPECT_EQ(make().clobbers, 0);  // SHLD reads
    builder.store(variable(), {builder.load(variable(), 2, true)[0]}, false);
    EXPECT_EQ(make().clobbers & set_of(Pair::de), 0);
    EXPECT_NE(make().clobbers & (set_of(a) | set_of(Pair::hl)), 0);
}

TEST_F(GenerateTest, AnInterruptKeepsWhatItUses) {
    function.interrupt = 0x2C;  // RST 5.5
    (void)builder.processor(Opcode::port_in, 1, {}, 1);
    const FunctionCode code = make();
    EXPECT_EQ(text_of(code.items), "PUSH PSW; IN p8; POP PSW; EI; RET");
    EXPECT_EQ(code.stack_bytes, 2U);
    EXPECT_EQ(code.clobbers, 0);
}

TEST_F(GenerateTest, AnInterruptThatUsesNothingKeepsNothing) {
    function.interrupt = 0x34;
    EXPECT_EQ(text_of(make().items), "EI; RET");
}

// RIM behind TRAP says whether interrupts were on before it; they stay off if they were off.
TEST_F(GenerateTest, TrapRestoresTheInterruptEnable) {
    function.interrupt = 0x24;
    builder.store(variable(), builder.load(variable(), 2, false), false);
    const FunctionCode code = make();
    EXPECT_EQ(text_of(code.items),
              "PUSH PSW; RIM; PUSH PSW; PUSH H; LHLD a16; SHLD a16; POP H; POP PSW; ANI d8; "
              "JZ a16; POP PSW; EI; RET; L:; POP PSW; RET");
    EXPECT_EQ(code.stack_bytes, 6U);
    for (const CodeItem& item : code.items) {
        if (item.opcode == 0xE6) {
            EXPECT_EQ(item.operand.offset, 0x08);  // IE
        }
    }
}

TEST_F(GenerateTest, CallsAreListedWithWhatIsPushed) {
    (void)builder.call(module.intern("g"), {}, 0);
    function.blocks[0].operations.back().arguments = {{}};
    const FunctionCode code = make();
    ASSERT_EQ(code.calls.size(), 1U);
    EXPECT_EQ(code.calls[0].symbol, module.intern("g"));
    EXPECT_EQ(code.calls[0].pushed, 0U);
    EXPECT_EQ(code.clobbers, kAllRegisters);  // nobody says what g changes
}

TEST_F(GenerateTest, WhatACalleeLeavesAloneIsNotClobbered) {
    (void)builder.call(module.intern("g"), {}, 0);
    function.blocks[0].operations.back().arguments = {{}};
    give_back({});
    GenerateOptions options;
    options.clobbers_of = [](SymbolId) { return set_of(Pair::de); };
    EXPECT_EQ(generate(module, function, options).clobbers, set_of(Pair::de));
}

TEST_F(GenerateTest, VariablesOnTheStackAreMadeAndUnmade) {
    function.stack_bytes = 4;
    function.recursive = true;
    const FunctionCode code = make();
    EXPECT_EQ(text_of(code.items),
              "SHLD a16; LXI H,d16; DAD SP; SPHL; LHLD a16; "
              "SHLD a16; LXI H,d16; DAD SP; SPHL; LHLD a16; RET");
    EXPECT_EQ(code.items[1].operand.offset, 0xFFFC);
    EXPECT_EQ(code.items[6].operand.offset, 4);
    EXPECT_EQ(code.stack_bytes, 4U);
    EXPECT_EQ(code.frame_bytes, 2U);  // HL meanwhile
}

TEST_F(GenerateTest, ValuesThatDoNotMeetShareTheFrame) {
    for (int i = 0; i < 3; ++i) {
        const Bytes value = builder.load(variable(), 8, true);
        builder.store(variable(), value, true);
    }
    EXPECT_EQ(make().frame_bytes, 8U);
}

}  // namespace
