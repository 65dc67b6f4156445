// expand_wide_products.cpp - products of more than 64 bits from 32-bit parts; see passes.hpp.
// Why          LLVM computes the sums of series in more bits than the result has: a loop over 64
//              bits leaves an i65 product. There is no runtime routine for it.
// Depends on   libLLVM 19.
#include <llvm/IR/IRBuilder.h>
#include <llvm/IR/InstIterator.h>
#include <llvm/IR/Instructions.h>

#include <vector>

#include "toolchain/ir/passes.hpp"

namespace toolchain::ir {

namespace {

constexpr unsigned kPartBits = 32;

llvm::Value* product(llvm::IRBuilder<>& builder, llvm::Value* left, llvm::Value* right) {
    llvm::Type* type = left->getType();
    const unsigned bits = type->getIntegerBitWidth();
    const auto part = [&](llvm::Value* value, unsigned from) {
        llvm::Value* narrow =
            builder.CreateTrunc(builder.CreateLShr(value, from), builder.getIntNTy(kPartBits));
        return builder.CreateZExt(narrow, builder.getInt64Ty());
    };
    llvm::Value* sum = llvm::ConstantInt::get(type, 0);
    for (unsigned i = 0; i < bits; i += kPartBits) {
        for (unsigned k = 0; i + k < bits; k += kPartBits) {
            llvm::Value* partial = builder.CreateMul(part(left, i), part(right, k));
            llvm::Value* placed = builder.CreateShl(builder.CreateZExt(partial, type), i + k);
            sum = builder.CreateAdd(sum, placed);
        }
    }
    return sum;
}

}  // namespace

void expand_wide_products(llvm::Function& function) {
    std::vector<llvm::BinaryOperator*> products;
    for (llvm::Instruction& instruction : llvm::instructions(function)) {
        if (instruction.getOpcode() == llvm::Instruction::Mul &&
            instruction.getType()->getIntegerBitWidth() > 64) {
            products.push_back(llvm::cast<llvm::BinaryOperator>(&instruction));
        }
    }
    for (llvm::BinaryOperator* operation : products) {
        llvm::IRBuilder<> builder(operation);
        operation->replaceAllUsesWith(
            product(builder, operation->getOperand(0), operation->getOperand(1)));
        operation->eraseFromParent();
    }
}

}  // namespace toolchain::ir
