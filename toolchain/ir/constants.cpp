// constants.cpp - see constants.hpp.
#include "toolchain/ir/constants.hpp"

#include <fmt/format.h>
#include <llvm/IR/GlobalAlias.h>
#include <llvm/IR/GlobalVariable.h>
#include <llvm/IR/Operator.h>
#include <llvm/Support/raw_ostream.h>

#include "toolchain/ir/refuse.hpp"

namespace toolchain::ir {

using codegen::Datum;

namespace {

/// A number plus perhaps a symbol: what every constant of integer or pointer type is.
struct Relocatable {
    llvm::APInt number;
    const llvm::GlobalValue* symbol = nullptr;
};

std::string text_of(const llvm::Constant& constant) {
    std::string text;
    llvm::raw_string_ostream stream(text);
    constant.print(stream);
    return text;
}

Relocatable evaluate(const llvm::DataLayout& layout, const llvm::Constant& constant);

Relocatable evaluate_expression(const llvm::DataLayout& layout,
                                const llvm::ConstantExpr& expression) {
    const unsigned bits = static_cast<unsigned>(layout.getTypeSizeInBits(expression.getType()));
    switch (expression.getOpcode()) {
        case llvm::Instruction::GetElementPtr: {
            const auto* address = llvm::cast<llvm::GEPOperator>(&expression);
            Relocatable base =
                evaluate(layout, *llvm::cast<llvm::Constant>(address->getPointerOperand()));
            llvm::APInt offset(bits, 0);
            if (address->accumulateConstantOffset(layout, offset)) {
                base.number += offset;
                return base;
            }
            break;
        }
        case llvm::Instruction::IntToPtr:
        case llvm::Instruction::PtrToInt:
        case llvm::Instruction::BitCast:
        case llvm::Instruction::Trunc: {
            Relocatable inner = evaluate(layout, *expression.getOperand(0));
            inner.number = inner.number.zextOrTrunc(bits);
            if (inner.symbol == nullptr || bits >= 16) return inner;
            break;
        }
        case llvm::Instruction::Add:
        case llvm::Instruction::Sub: {
            Relocatable left = evaluate(layout, *expression.getOperand(0));
            const Relocatable right = evaluate(layout, *expression.getOperand(1));
            const bool add = expression.getOpcode() == llvm::Instruction::Add;
            if (add && left.symbol != nullptr && right.symbol != nullptr) break;
            if (!add && right.symbol != nullptr && right.symbol != left.symbol) break;
            left.number = add ? left.number + right.number : left.number - right.number;
            if (!add && right.symbol != nullptr) left.symbol = nullptr;
            if (add && left.symbol == nullptr) left.symbol = right.symbol;
            return left;
        }
        default:
            break;
    }
    throw BadConstant("constant expression not supported: " + text_of(expression));
}

Relocatable evaluate(const llvm::DataLayout& layout, const llvm::Constant& constant) {
    const unsigned bits = static_cast<unsigned>(layout.getTypeSizeInBits(constant.getType()));
    if (const auto* number = llvm::dyn_cast<llvm::ConstantInt>(&constant)) {
        return {number->getValue(), nullptr};
    }
    if (llvm::isa<llvm::ConstantPointerNull>(constant) || llvm::isa<llvm::UndefValue>(constant)) {
        return {llvm::APInt(bits, 0), nullptr};
    }
    if (const auto* symbol = llvm::dyn_cast<llvm::GlobalValue>(&constant)) {
        if (const auto* alias = llvm::dyn_cast<llvm::GlobalAlias>(symbol)) {
            return evaluate(layout, *alias->getAliasee());
        }
        return {llvm::APInt(bits, 0), symbol};
    }
    if (const auto* expression = llvm::dyn_cast<llvm::ConstantExpr>(&constant)) {
        return evaluate_expression(layout, *expression);
    }
    throw BadConstant("constant not supported: " + text_of(constant));
}

void put_scalar(codegen::Module& out, const llvm::DataLayout& layout,
                const llvm::Constant& constant, std::vector<Datum>& data) {
    const Relocatable value = evaluate(layout, constant);
    const std::size_t size = layout.getTypeStoreSize(constant.getType());
    const auto number = value.number.zextOrTrunc(static_cast<unsigned>(size * 8));
    for (std::size_t i = 0; i < size; ++i) {
        const auto byte =
            static_cast<uint8_t>(number.extractBitsAsZExtValue(8, static_cast<unsigned>(i * 8)));
        if (value.symbol != nullptr && i < 2) {
            const auto offset = static_cast<int32_t>(value.number.trunc(16).getSExtValue());
            data.push_back({0, out.intern(value.symbol->getName().str()), offset, i == 1});
        } else {
            data.push_back({value.symbol != nullptr ? uint8_t{0} : byte});
        }
    }
}

}  // namespace

std::vector<Datum> constant_data(codegen::Module& out, const llvm::DataLayout& layout,
                                 const llvm::Constant& constant) {
    llvm::Type* type = constant.getType();
    const std::size_t size = layout.getTypeAllocSize(type);
    std::vector<Datum> data;
    if (llvm::isa<llvm::ConstantAggregateZero>(constant) || llvm::isa<llvm::UndefValue>(constant)) {
        data.resize(size);
    } else if (type->isArrayTy() || type->isStructTy()) {
        const unsigned count = type->isArrayTy()
                                   ? static_cast<unsigned>(type->getArrayNumElements())
                                   : type->getStructNumElements();
        for (unsigned i = 0; i < count; ++i) {
            const std::size_t offset =
                type->isArrayTy() ? i * layout.getTypeAllocSize(type->getArrayElementType())
                                  : layout.getStructLayout(llvm::cast<llvm::StructType>(type))
                                        ->getElementOffset(i);
            data.resize(offset);
            const std::vector<Datum> element =
                constant_data(out, layout, *constant.getAggregateElement(i));
            data.insert(data.end(), element.begin(), element.end());
        }
    } else if (type->isIntegerTy() || type->isPointerTy()) {
        put_scalar(out, layout, constant, data);
    } else {
        throw BadConstant("constant not supported: " + text_of(constant) +
                          ": only integers, pointers and aggregates of them exist on the 8085");
    }
    data.resize(size);
    return data;
}

codegen::Variable make_variable(codegen::Module& out, const llvm::DataLayout& layout,
                                const llvm::GlobalVariable& variable) {
    codegen::Variable result;
    result.symbol = out.intern(variable.getName().str());
    result.size = static_cast<uint32_t>(layout.getTypeAllocSize(variable.getValueType()));
    result.alignment = static_cast<uint32_t>(variable.getAlign().valueOrOne().value());
    result.is_constant = variable.isConstant();
    if (variable.hasInitializer() && !variable.getInitializer()->isNullValue()) {
        try {
            result.initial = constant_data(out, layout, *variable.getInitializer());
        } catch (const BadConstant& problem) {
            throw Refused(fmt::format("{}: in {}: {}", place_text(variable),
                                      variable.getName().str(), problem.what()));
        }
    }
    return result;
}

}  // namespace toolchain::ir
