// choose_results.cpp - `x + (c ? y : 0)` becomes `c ? x + y : x`; see passes.hpp.
// Why          the sum is then computed on one of two ways only, and nothing is added on the other.
//              `x + (c as a number)` becomes `c ? x + 1 : x`: a jump and an INX.
// Depends on   libLLVM 19.
#include <llvm/IR/IRBuilder.h>
#include <llvm/IR/InstIterator.h>
#include <llvm/IR/Instructions.h>
#include <llvm/IR/PatternMatch.h>

#include <vector>

#include "toolchain/ir/passes.hpp"

namespace toolchain::ir {

namespace {

using namespace llvm::PatternMatch;
using llvm::BinaryOperator;
using llvm::Value;

/// A choice between two values.
struct Choice {
    Value* condition = nullptr;
    Value* yes = nullptr;
    Value* no = nullptr;
};

bool as_choice(Value* value, Choice& choice) {
    if (!value->hasOneUse()) return false;
    if (match(value,
              m_Select(m_Value(choice.condition), m_Value(choice.yes), m_Value(choice.no)))) {
        return true;
    }
    llvm::Type* type = value->getType();
    if (!type->isIntegerTy() || type->getIntegerBitWidth() < 8) return false;
    const bool is_signed = match(value, m_SExt(m_Value(choice.condition)));
    if (!is_signed && !match(value, m_ZExt(m_Value(choice.condition)))) return false;
    if (!choice.condition->getType()->isIntegerTy(1)) return false;
    choice.yes =
        is_signed ? llvm::ConstantInt::getAllOnesValue(type) : llvm::ConstantInt::get(type, 1);
    choice.no = llvm::ConstantInt::get(type, 0);
    return true;
}

/// The operation with that right operand, or nullptr if it changes nothing.
bool is_neutral(const BinaryOperator& operation, const Value* right) {
    switch (operation.getOpcode()) {
        case llvm::Instruction::Add:
        case llvm::Instruction::Sub:
        case llvm::Instruction::Or:
        case llvm::Instruction::Xor:
        case llvm::Instruction::Shl:
        case llvm::Instruction::LShr:
        case llvm::Instruction::AShr:
            return match(right, m_Zero());
        case llvm::Instruction::And:
            return match(right, m_AllOnes());
        case llvm::Instruction::Mul:
            return match(right, m_One());
        default:
            return false;
    }
}

/// `and` and `mul` by 0 give 0.
bool is_absorbing(const BinaryOperator& operation, const Value* right) {
    const bool applies = operation.getOpcode() == llvm::Instruction::And ||
                         operation.getOpcode() == llvm::Instruction::Mul;
    return applies && match(right, m_Zero());
}

bool rewrite(BinaryOperator& operation) {
    for (unsigned side = 0; side < 2; ++side) {
        if (side == 0 && !operation.isCommutative()) continue;
        Value* chosen = operation.getOperand(side);
        Value* other = operation.getOperand(1 - side);
        Choice choice;
        if (!as_choice(chosen, choice)) continue;
        const bool simple_yes =
            is_neutral(operation, choice.yes) || is_absorbing(operation, choice.yes);
        const bool simple_no =
            is_neutral(operation, choice.no) || is_absorbing(operation, choice.no);
        if (!simple_yes && !simple_no) continue;
        llvm::IRBuilder<> builder(&operation);
        const auto result = [&](Value* right) -> Value* {
            if (is_neutral(operation, right)) return other;
            if (is_absorbing(operation, right)) return right;
            return builder.CreateBinOp(operation.getOpcode(), other, right);
        };
        Value* yes = result(choice.yes);
        Value* no = result(choice.no);
        operation.replaceAllUsesWith(builder.CreateSelect(choice.condition, yes, no));
        operation.eraseFromParent();
        llvm::cast<llvm::Instruction>(chosen)->eraseFromParent();
        return true;
    }
    return false;
}

}  // namespace

void choose_results(llvm::Function& function) {
    std::vector<BinaryOperator*> operations;
    for (llvm::Instruction& instruction : llvm::instructions(function)) {
        if (auto* operation = llvm::dyn_cast<BinaryOperator>(&instruction)) {
            if (operation->getType()->getIntegerBitWidth() >= 8) operations.push_back(operation);
        }
    }
    for (BinaryOperator* operation : operations) rewrite(*operation);
}

}  // namespace toolchain::ir
