// prepare.cpp - replaces instructions and intrinsics by simpler ones; see prepare.hpp.
#include "toolchain/ir/prepare.hpp"

#include <llvm/CodeGen/IntrinsicLowering.h>
#include <llvm/IR/IRBuilder.h>
#include <llvm/IR/InstIterator.h>
#include <llvm/IR/IntrinsicInst.h>
#include <llvm/IR/Module.h>
#include <llvm/IR/PassManager.h>
#include <llvm/Passes/PassBuilder.h>
#include <llvm/Transforms/Utils/BasicBlockUtils.h>
#include <llvm/Transforms/Utils/LowerSwitch.h>

#include <vector>

namespace toolchain::ir {

namespace {

using Builder = llvm::IRBuilder<>;
using llvm::Value;

/// Minimum, maximum, absolute value as comparison and select.
Value* expand_choice(Builder& builder, const llvm::IntrinsicInst& call) {
    using Predicate = llvm::CmpInst::Predicate;
    Value* left = call.getArgOperand(0);
    if (call.getIntrinsicID() == llvm::Intrinsic::abs) {
        Value* zero = llvm::ConstantInt::get(left->getType(), 0);
        Value* negative = builder.CreateICmpSLT(left, zero);
        return builder.CreateSelect(negative, builder.CreateSub(zero, left), left);
    }
    Value* right = call.getArgOperand(1);
    Predicate predicate = Predicate::ICMP_ULT;
    switch (call.getIntrinsicID()) {
        case llvm::Intrinsic::umin:
            predicate = Predicate::ICMP_ULT;
            break;
        case llvm::Intrinsic::umax:
            predicate = Predicate::ICMP_UGT;
            break;
        case llvm::Intrinsic::smin:
            predicate = Predicate::ICMP_SLT;
            break;
        default:
            predicate = Predicate::ICMP_SGT;
            break;
    }
    return builder.CreateSelect(builder.CreateICmp(predicate, left, right), left, right);
}

/// {result, overflow} of a checked addition or subtraction; multiplication in twice the width.
std::pair<Value*, Value*> checked(Builder& builder, llvm::Intrinsic::ID id, Value* left,
                                  Value* right) {
    using I = llvm::Intrinsic::IndependentIntrinsics;
    Value* zero = llvm::ConstantInt::get(left->getType(), 0);
    const auto signed_overflow = [&](Value* result, Value* first, Value* second) {
        Value* both = builder.CreateAnd(builder.CreateXor(result, first), second);
        return builder.CreateICmpSLT(both, zero);
    };
    if (id == I::uadd_with_overflow || id == I::uadd_sat) {
        Value* sum = builder.CreateAdd(left, right);
        return {sum, builder.CreateICmpULT(sum, left)};
    }
    if (id == I::usub_with_overflow || id == I::usub_sat) {
        return {builder.CreateSub(left, right), builder.CreateICmpULT(left, right)};
    }
    if (id == I::sadd_with_overflow || id == I::sadd_sat) {
        Value* sum = builder.CreateAdd(left, right);
        return {sum, signed_overflow(sum, left, builder.CreateXor(sum, right))};
    }
    if (id == I::ssub_with_overflow || id == I::ssub_sat) {
        Value* difference = builder.CreateSub(left, right);
        return {difference, signed_overflow(difference, left, builder.CreateXor(left, right))};
    }
    const bool is_signed = id == I::smul_with_overflow;
    const unsigned bits = left->getType()->getIntegerBitWidth();
    llvm::Type* wide = builder.getIntNTy(bits * 2);
    const auto extend = [&](Value* value) {
        return is_signed ? builder.CreateSExt(value, wide) : builder.CreateZExt(value, wide);
    };
    Value* product = builder.CreateMul(extend(left), extend(right));
    Value* narrow = builder.CreateTrunc(product, left->getType());
    return {narrow, builder.CreateICmpNE(product, extend(narrow))};
}

Value* expand_saturating(Builder& builder, const llvm::IntrinsicInst& call) {
    Value* left = call.getArgOperand(0);
    const auto [result, overflow] =
        checked(builder, call.getIntrinsicID(), left, call.getArgOperand(1));
    const unsigned bits = left->getType()->getIntegerBitWidth();
    const auto number = [&](const llvm::APInt& value) {
        return llvm::ConstantInt::get(left->getType(), value);
    };
    Value* limit = nullptr;
    switch (call.getIntrinsicID()) {
        case llvm::Intrinsic::uadd_sat:
            limit = number(llvm::APInt::getMaxValue(bits));
            break;
        case llvm::Intrinsic::usub_sat:
            limit = number(llvm::APInt::getMinValue(bits));
            break;
        default: {
            Value* negative = builder.CreateICmpSLT(left, number(llvm::APInt(bits, 0)));
            limit = builder.CreateSelect(negative, number(llvm::APInt::getSignedMinValue(bits)),
                                         number(llvm::APInt::getSignedMaxValue(bits)));
        }
    }
    return builder.CreateSelect(overflow, limit, result);
}

Value* expand_checked(Builder& builder, const llvm::IntrinsicInst& call) {
    const auto [result, overflow] =
        checked(builder, call.getIntrinsicID(), call.getArgOperand(0), call.getArgOperand(1));
    Value* both = llvm::PoisonValue::get(call.getType());
    both = builder.CreateInsertValue(both, result, 0);
    return builder.CreateInsertValue(both, overflow, 1);
}

/// The two words side by side, shifted; the count is taken modulo the width.
Value* expand_funnel(Builder& builder, const llvm::IntrinsicInst& call) {
    Value* high = call.getArgOperand(0);
    Value* low = call.getArgOperand(1);
    const unsigned bits = high->getType()->getIntegerBitWidth();
    const auto number = [&](uint64_t value) {
        return llvm::ConstantInt::get(high->getType(), value);
    };
    Value* count = builder.CreateURem(call.getArgOperand(2), number(bits));
    // The other part is shifted in two steps, so that a count of 0 shifts it out whole.
    if (call.getIntrinsicID() == llvm::Intrinsic::fshl) {
        Value* part = builder.CreateLShr(builder.CreateLShr(low, number(1)),
                                         builder.CreateSub(number(bits - 1), count));
        return builder.CreateOr(builder.CreateShl(high, count), part);
    }
    Value* part = builder.CreateShl(builder.CreateShl(high, number(1)),
                                    builder.CreateSub(number(bits - 1), count));
    return builder.CreateOr(builder.CreateLShr(low, count), part);
}

/// -1, 0 or 1.
Value* expand_three_way(Builder& builder, const llvm::IntrinsicInst& call) {
    const bool is_signed = call.getIntrinsicID() == llvm::Intrinsic::scmp;
    Value* left = call.getArgOperand(0);
    Value* right = call.getArgOperand(1);
    Value* below =
        is_signed ? builder.CreateICmpSLT(left, right) : builder.CreateICmpULT(left, right);
    Value* above =
        is_signed ? builder.CreateICmpSGT(left, right) : builder.CreateICmpUGT(left, right);
    return builder.CreateSub(builder.CreateZExt(above, call.getType()),
                             builder.CreateZExt(below, call.getType()));
}

/// The call of a runtime routine for a memory intrinsic.
Value* expand_memory(Builder& builder, llvm::IntrinsicInst& call) {
    llvm::Module& module = *call.getModule();
    auto* memory = llvm::cast<llvm::MemIntrinsic>(&call);
    llvm::Type* pointer = builder.getPtrTy();
    llvm::Type* size = builder.getInt16Ty();
    Value* count = builder.CreateZExtOrTrunc(memory->getLength(), size);
    if (auto* fill = llvm::dyn_cast<llvm::MemSetInst>(memory)) {
        const auto routine = module.getOrInsertFunction("__memset", builder.getVoidTy(), pointer,
                                                        builder.getInt8Ty(), size);
        return builder.CreateCall(routine, {fill->getRawDest(), fill->getValue(), count});
    }
    auto* transfer = llvm::cast<llvm::MemTransferInst>(memory);
    const char* name = llvm::isa<llvm::MemMoveInst>(transfer) ? "__memmove" : "__memcpy";
    const auto routine =
        module.getOrInsertFunction(name, builder.getVoidTy(), pointer, pointer, size);
    return builder.CreateCall(routine, {transfer->getRawDest(), transfer->getRawSource(), count});
}

/// What replaces an intrinsic call, or nullptr when it is left alone.
Value* expand(Builder& builder, llvm::IntrinsicInst& call) {
    switch (call.getIntrinsicID()) {
        case llvm::Intrinsic::umin:
        case llvm::Intrinsic::umax:
        case llvm::Intrinsic::smin:
        case llvm::Intrinsic::smax:
        case llvm::Intrinsic::abs:
            return expand_choice(builder, call);
        case llvm::Intrinsic::uadd_sat:
        case llvm::Intrinsic::usub_sat:
        case llvm::Intrinsic::sadd_sat:
        case llvm::Intrinsic::ssub_sat:
            return expand_saturating(builder, call);
        case llvm::Intrinsic::uadd_with_overflow:
        case llvm::Intrinsic::usub_with_overflow:
        case llvm::Intrinsic::sadd_with_overflow:
        case llvm::Intrinsic::ssub_with_overflow:
        case llvm::Intrinsic::umul_with_overflow:
        case llvm::Intrinsic::smul_with_overflow:
            return expand_checked(builder, call);
        case llvm::Intrinsic::fshl:
        case llvm::Intrinsic::fshr:
            return expand_funnel(builder, call);
        case llvm::Intrinsic::ucmp:
        case llvm::Intrinsic::scmp:
            return expand_three_way(builder, call);
        case llvm::Intrinsic::memcpy:
        case llvm::Intrinsic::memcpy_inline:
        case llvm::Intrinsic::memmove:
        case llvm::Intrinsic::memset:
        case llvm::Intrinsic::memset_inline:
            return expand_memory(builder, call);
        case llvm::Intrinsic::expect:
        case llvm::Intrinsic::expect_with_probability:
        case llvm::Intrinsic::launder_invariant_group:
        case llvm::Intrinsic::strip_invariant_group:
            return call.getArgOperand(0);
        case llvm::Intrinsic::is_constant:
            return builder.getFalse();
        default:
            return nullptr;
    }
}

void expand_intrinsics(llvm::Function& function) {
    llvm::IntrinsicLowering lowering(function.getParent()->getDataLayout());
    std::vector<llvm::IntrinsicInst*> calls;
    for (llvm::Instruction& instruction : llvm::instructions(function)) {
        if (auto* call = llvm::dyn_cast<llvm::IntrinsicInst>(&instruction)) calls.push_back(call);
    }
    for (llvm::IntrinsicInst* call : calls) {
        switch (call->getIntrinsicID()) {
            case llvm::Intrinsic::ctpop:
            case llvm::Intrinsic::ctlz:
            case llvm::Intrinsic::cttz:
            case llvm::Intrinsic::bswap:
                lowering.LowerIntrinsicCall(call);
                continue;
            default:
                break;
        }
        Builder builder(call);
        if (Value* replacement = expand(builder, *call)) {
            if (!call->getType()->isVoidTy()) call->replaceAllUsesWith(replacement);
            call->eraseFromParent();
        }
    }
}

/// Each select becomes a branch around an empty block.
void expand_selects(llvm::Function& function) {
    std::vector<llvm::SelectInst*> selects;
    for (llvm::Instruction& instruction : llvm::instructions(function)) {
        if (auto* select = llvm::dyn_cast<llvm::SelectInst>(&instruction))
            selects.push_back(select);
    }
    for (llvm::SelectInst* select : selects) {
        llvm::BasicBlock* head = select->getParent();
        llvm::Instruction* end =
            llvm::SplitBlockAndInsertIfThen(select->getCondition(), select->getIterator(), false);
        llvm::BasicBlock* taken = end->getParent();
        auto* phi = llvm::PHINode::Create(select->getType(), 2, "", select->getIterator());
        phi->addIncoming(select->getTrueValue(), taken);
        phi->addIncoming(select->getFalseValue(), head);
        select->replaceAllUsesWith(phi);
        phi->takeName(select);
        select->eraseFromParent();
    }
}

}  // namespace

void prepare(llvm::Module& module) {
    llvm::FunctionAnalysisManager functions;
    llvm::PassBuilder builder;
    builder.registerFunctionAnalyses(functions);
    for (llvm::Function& function : module) {
        if (function.isDeclaration()) continue;
        expand_intrinsics(function);
        expand_selects(function);
        llvm::LowerSwitchPass().run(function, functions);
        functions.invalidate(function, llvm::PreservedAnalyses::none());
    }
}

}  // namespace toolchain::ir
