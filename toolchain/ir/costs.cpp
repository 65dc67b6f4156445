// costs.cpp - see costs.hpp. Prices are in operations on a byte, and roughly what the runtime's
// routines take.
#include "toolchain/ir/costs.hpp"

#include <llvm/Analysis/TargetTransformInfoImpl.h>
#include <llvm/IR/Function.h>

namespace toolchain::ir {

namespace {

using TTI = llvm::TargetTransformInfo;
using llvm::InstructionCost;

constexpr int kProduct = 20;
constexpr int kProductByConstant = 4;
constexpr int kQuotient = 40;
constexpr int kShift = 10;  ///< by a distance that is not known
constexpr int kShiftByConstant = 2;
constexpr int kSelect = 2;

int bytes_of(const llvm::Type& type) {
    constexpr unsigned kByteBits = 8;
    return static_cast<int>((type.getIntegerBitWidth() + kByteBits - 1) / kByteBits);
}

/// What a pass asks; the names are LLVM's.
class Costs final : public llvm::TargetTransformInfoImplCRTPBase<Costs> {
    using Base = llvm::TargetTransformInfoImplCRTPBase<Costs>;

public:
    explicit Costs(const llvm::DataLayout& layout) : Base(layout) {}

    // NOLINTBEGIN(readability-identifier-naming)
    InstructionCost getArithmeticInstrCost(unsigned opcode, llvm::Type* type,
                                           TTI::TargetCostKind kind, TTI::OperandValueInfo first,
                                           TTI::OperandValueInfo second,
                                           llvm::ArrayRef<const llvm::Value*> operands,
                                           const llvm::Instruction* instruction = nullptr) const {
        using llvm::Instruction;
        if (!type->isIntegerTy()) {
            return Base::getArithmeticInstrCost(opcode, type, kind, first, second, operands,
                                                instruction);
        }
        const int bytes = bytes_of(*type);
        switch (opcode) {
            case Instruction::Mul:
                return bytes *
                       (first.isConstant() || second.isConstant() ? kProductByConstant : kProduct);
            case Instruction::UDiv:
            case Instruction::SDiv:
            case Instruction::URem:
            case Instruction::SRem:
                return bytes * kQuotient;
            case Instruction::Shl:
            case Instruction::LShr:
            case Instruction::AShr:
                return bytes * (second.isConstant() ? kShiftByConstant : kShift);
            default:
                return bytes;
        }
    }

    InstructionCost getCmpSelInstrCost(unsigned opcode, llvm::Type* type, llvm::Type* condition,
                                       llvm::CmpInst::Predicate predicate, TTI::TargetCostKind kind,
                                       const llvm::Instruction* instruction) const {
        if (!type->isIntegerTy()) {
            return Base::getCmpSelInstrCost(opcode, type, condition, predicate, kind, instruction);
        }
        return bytes_of(*type) * (opcode == llvm::Instruction::Select ? kSelect : 1);
    }

    /// Quotient and remainder come from one call: a remainder is not made of the quotient.
    bool hasDivRemOp(llvm::Type* /*type*/, bool /*is_signed*/) const { return true; }
    // NOLINTEND(readability-identifier-naming)
};

}  // namespace

llvm::TargetIRAnalysis operation_costs() {
    return llvm::TargetIRAnalysis(
        [](const llvm::Function& function) { return TTI(Costs(function.getDataLayout())); });
}

}  // namespace toolchain::ir
