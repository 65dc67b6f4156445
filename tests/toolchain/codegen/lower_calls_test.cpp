// Calls behind lower_calls(): where values are, what re-enters, what is on the stack.
#include "toolchain/codegen/lower_calls.hpp"

#include <gtest/gtest.h>

#include <string>

#include "tests/toolchain/codegen/interpreter.hpp"
#include "tests/toolchain/ir/ir_program.hpp"

namespace {

using namespace toolchain::codegen;

Module lowered(const std::string& text) {
    return ir_test::lowered(ir_test::to_mir(text));
}

const Function& function_of(const Module& module, const std::string& name) {
    return *module.find(module.symbol_ids.at(name));
}

/// The n-th operation with an opcode, over all blocks.
const Operation& operation_of(const Function& function, Opcode opcode, std::size_t n = 0) {
    for (const Block& block : function.blocks) {
        for (const Operation& operation : block.operations) {
            if (operation.opcode == opcode && n-- == 0) return operation;
        }
    }
    throw std::runtime_error("no such operation");
}

using Registers = std::vector<Register>;
const Registers kHl = {Register::l, Register::h};
const Registers kDe = {Register::e, Register::d};

TEST(LowerCalls, ACallerAndACalleeAgree) {
    const Module module = lowered(R"(
define i16 @f(i16 %a, i16 %b) {
  %1 = sub i16 %a, %b
  ret i16 %1
}
define i16 @g(i16 %a) {
  %1 = call i16 @f(i16 %a, i16 5)
  ret i16 %1
}
)");
    Registers both = kHl;
    both.insert(both.end(), kDe.begin(), kDe.end());
    const Function& f = function_of(module, "f");
    EXPECT_EQ(f.parameter_registers, both);
    EXPECT_EQ(f.result_registers, kHl);
    EXPECT_TRUE(f.frame.empty());
    const Operation& call = operation_of(function_of(module, "g"), Opcode::call);
    EXPECT_EQ(call.argument_registers, both);
    EXPECT_EQ(call.result_registers, kHl);
    EXPECT_EQ(call.arguments.size(), 1U);
    EXPECT_EQ(codegen_test::Interpreter(module).call("g", {105}), 100U);
}

TEST(LowerCalls, LargeValuesAreInTheCalleesFrame) {
    const Module module = lowered(R"(
define i64 @f(i64 %a) {
  %1 = add i64 %a, 1
  ret i64 %1
}
define i64 @g(i64 %a) {
  %1 = call i64 @f(i64 %a)
  ret i64 %1
}
)");
    const Function& f = function_of(module, "f");
    ASSERT_EQ(f.frame.size(), 2U);
    EXPECT_EQ(module.symbols[f.frame[0].symbol], "f@args");
    EXPECT_EQ(f.frame[0].size, 8U);
    EXPECT_EQ(module.symbols[f.frame[1].symbol], "f@result");
    EXPECT_EQ(f.result_size, 0U);
    EXPECT_TRUE(f.blocks[0].parameters.empty());
    EXPECT_EQ(codegen_test::Interpreter(module).call("g", {UINT64_MAX}), 0U);
}

TEST(LowerCalls, AnIndirectCallHasItsTargetInHl) {
    const Module module = lowered(R"(
@p = global ptr @f
define i8 @f(i16 %a, i64 %b) {
  %1 = trunc i64 %b to i8
  ret i8 %1
}
define i8 @g() {
  %1 = load ptr, ptr @p
  %2 = call i8 %1(i16 3, i64 77)
  ret i8 %2
}
)");
    const Operation& call = operation_of(function_of(module, "g"), Opcode::call_indirect);
    EXPECT_EQ(module.symbols[call.symbol], "__callhl");
    EXPECT_EQ(module.symbols[call.signature], "p2_8r1");
    EXPECT_EQ(call.argument_registers,
              (Registers{Register::l, Register::h, Register::e, Register::d}));
    EXPECT_TRUE(call.left.empty());
    const Function& f = function_of(module, "f");
    EXPECT_TRUE(f.address_taken);
    EXPECT_EQ(f.signature, call.signature);
    EXPECT_TRUE(f.frame.empty());
    bool found = false;
    for (const Variable& variable : module.variables) {
        found = found || module.symbols[variable.symbol] == "__args@p2_8r1";
    }
    EXPECT_TRUE(found);
    EXPECT_EQ(codegen_test::Interpreter(module).call("g"), 77U);
}

TEST(LowerCalls, CallsThatComeBackAreMarked) {
    const Module module = lowered(R"(
declare void @other(ptr)
define void @leaf() {
  ret void
}
define void @f(i16 %n) {
  %v = alloca [3 x i8], align 1
  %w = alloca i16, align 2
  %x = alloca i8, align 1
  store i16 %n, ptr %w
  %at = getelementptr i8, ptr %w, i16 1
  call void @other(ptr %at)
  call void @leaf()
  call void @f(i16 1)
  call void @other(ptr %v)
  call void @other(ptr %x)
  ret void
}
)");
    const Function& f = function_of(module, "f");
    EXPECT_TRUE(f.recursive);
    EXPECT_FALSE(function_of(module, "leaf").recursive);
    // 3 bytes, one lost, 2 bytes, 1 byte, and one that keeps SP even.
    EXPECT_EQ(f.stack_bytes, 8U);
    EXPECT_TRUE(f.frame.empty());
    EXPECT_FALSE(operation_of(f, Opcode::call, 0).reenters);
    EXPECT_FALSE(operation_of(f, Opcode::call, 1).reenters);
    EXPECT_TRUE(operation_of(f, Opcode::call, 2).reenters);
    EXPECT_EQ(operation_of(f, Opcode::stack_address, 0).immediate16, 4U);
    EXPECT_EQ(operation_of(f, Opcode::stack_address, 1).immediate16, 5U);
    EXPECT_EQ(operation_of(f, Opcode::stack_address, 2).immediate16, 0U);
    EXPECT_EQ(operation_of(f, Opcode::stack_address, 3).immediate16, 6U);
}

TEST(LowerCalls, AShortCopyTakesTheShortRoutine) {
    const Module module = lowered(R"(
declare void @llvm.memcpy.p0.p0.i16(ptr, ptr, i16, i1)
define void @f(ptr %a, ptr %b, i16 %n) {
  call void @llvm.memcpy.p0.p0.i16(ptr %a, ptr %b, i16 255, i1 false)
  call void @llvm.memcpy.p0.p0.i16(ptr %a, ptr %b, i16 256, i1 false)
  call void @llvm.memcpy.p0.p0.i16(ptr %a, ptr %b, i16 %n, i1 false)
  ret void
}
)");
    const Function& f = function_of(module, "f");
    EXPECT_EQ(module.symbols[operation_of(f, Opcode::call, 0).symbol], "__memcpy8");
    EXPECT_EQ(module.symbols[operation_of(f, Opcode::call, 1).symbol], "__memcpy");
    EXPECT_EQ(module.symbols[operation_of(f, Opcode::call, 2).symbol], "__memcpy");
}

TEST(LowerCalls, RoutinesSayWhatTheyChange) {
    const Module module = lowered(R"(
define i16 @f(i16 %a, i16 %b) {
  %1 = mul i16 %a, %b
  ret i16 %1
}
)");
    const Operation& call = operation_of(function_of(module, "f"), Opcode::call);
    // docs/spec/runtime.md: __mul16 leaves BC and DE alone.
    EXPECT_EQ(call.clobbers, set_of(Register::a) | set_of(Register::flags) | set_of(Register::h) |
                                 set_of(Register::l));
}

}  // namespace
