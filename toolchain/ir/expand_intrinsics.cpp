// expand_intrinsics.cpp - intrinsics as instructions; see passes.hpp.
// Depends on   libLLVM 19.
#include <llvm/CodeGen/IntrinsicLowering.h>
#include <llvm/IR/IRBuilder.h>
#include <llvm/IR/InstIterator.h>
#include <llvm/IR/IntrinsicInst.h>
#include <llvm/IR/Module.h>
#include <llvm/Transforms/Utils/Local.h>

#include <utility>
#include <vector>

#include "toolchain/ir/passes.hpp"

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
    const auto* constant = llvm::dyn_cast<llvm::Constant>(right);
    if (predicate == Predicate::ICMP_SGT && constant != nullptr && constant->isNullValue()) {
        // Its sign alone decides.
        return builder.CreateSelect(builder.CreateICmpSLT(left, right), right, left);
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
    const unsigned width = left->getType()->getIntegerBitWidth();
    const bool is_wide = width > 16 && width % 8 == 0;
    if (is_wide && (id == I::uadd_with_overflow || id == I::uadd_sat ||
                    id == I::usub_with_overflow || id == I::usub_sat)) {
        // One byte more holds the carry: cheaper than a comparison of all the others.
        const bool adds = id == I::uadd_with_overflow || id == I::uadd_sat;
        llvm::Type* wider = builder.getIntNTy(width + 8);
        Value* first = builder.CreateZExt(left, wider);
        Value* second = builder.CreateZExt(right, wider);
        Value* whole = adds ? builder.CreateAdd(first, second) : builder.CreateSub(first, second);
        Value* carry = builder.CreateTrunc(builder.CreateLShr(whole, width), builder.getInt8Ty());
        return {builder.CreateTrunc(whole, left->getType()),
                builder.CreateICmpNE(carry, builder.getInt8(0))};
    }
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
    llvm::Type* wide = builder.getIntNTy(width * 2);
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
        default:  // the copies of the sign, or of its opposite: no branch, and only in the rare
                  // case
            limit = builder.CreateXor(builder.CreateAShr(left, bits - 1),
                                      number(llvm::APInt::getSignedMaxValue(bits)));
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
    const bool to_left = call.getIntrinsicID() == llvm::Intrinsic::fshl;
    if (const auto* known = llvm::dyn_cast<llvm::ConstantInt>(call.getArgOperand(2))) {
        const uint64_t shift = known->getValue().urem(bits);
        if (shift == 0) return to_left ? high : low;
        const uint64_t left = to_left ? shift : bits - shift;
        return builder.CreateOr(builder.CreateShl(high, left),
                                builder.CreateLShr(low, bits - left));
    }
    Value* count = builder.CreateURem(call.getArgOperand(2), number(bits));
    // The other part is shifted in two steps, so that a count of 0 shifts it out whole.
    if (to_left) {
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

/// Bytes in the other order, then the bits of each byte.
Value* expand_bit_reversal(Builder& builder, const llvm::IntrinsicInst& call) {
    const unsigned bits = call.getType()->getIntegerBitWidth();
    const unsigned whole = (bits + 7) / 8 * 8;
    llvm::Type* type = builder.getIntNTy(whole);
    Value* value = builder.CreateZExt(call.getArgOperand(0), type);
    Value* reversed = llvm::ConstantInt::get(type, 0);
    for (unsigned from = 0; from < whole; from += 8) {
        Value* byte = builder.CreateZExt(
            builder.CreateTrunc(builder.CreateLShr(value, from), builder.getInt8Ty()), type);
        reversed = builder.CreateOr(reversed, builder.CreateShl(byte, whole - 8 - from));
    }
    for (const auto& [mask, distance] : {std::pair{0x55U, 1U}, {0x33U, 2U}, {0x0FU, 4U}}) {
        const llvm::APInt pattern = llvm::APInt::getSplat(whole, llvm::APInt(8, mask));
        Value* low = builder.CreateShl(builder.CreateAnd(reversed, pattern), distance);
        Value* high = builder.CreateAnd(builder.CreateLShr(reversed, distance), pattern);
        reversed = builder.CreateOr(low, high);
    }
    return builder.CreateTrunc(builder.CreateLShr(reversed, whole - bits), call.getType());
}

/// Nothing may run any more: interrupts off, then HLT for ever.
void halt_for_ever(llvm::IntrinsicInst& call) {
    llvm::Module& module = *call.getModule();
    const llvm::DebugLoc place = call.getDebugLoc();
    llvm::BasicBlock* head = call.getParent();
    llvm::changeToUnreachable(&call);
    head->getTerminator()->eraseFromParent();
    auto* trap = llvm::BasicBlock::Create(module.getContext(), "trap", head->getParent());
    Builder builder(head);
    builder.SetCurrentDebugLocation(place);
    builder.CreateCall(module.getOrInsertFunction("__i85_di", builder.getVoidTy()));
    builder.CreateBr(trap);
    builder.SetInsertPoint(trap);
    builder.CreateCall(module.getOrInsertFunction("__i85_hlt", builder.getVoidTy()));
    builder.CreateBr(trap);
}

/// What only informs an optimiser.
bool is_dropped(llvm::Intrinsic::ID id) {
    switch (id) {
        case llvm::Intrinsic::assume:
        case llvm::Intrinsic::donothing:
        case llvm::Intrinsic::sideeffect:
        case llvm::Intrinsic::prefetch:
        case llvm::Intrinsic::invariant_start:
        case llvm::Intrinsic::invariant_end:
        case llvm::Intrinsic::lifetime_start:
        case llvm::Intrinsic::lifetime_end:
        case llvm::Intrinsic::var_annotation:
        case llvm::Intrinsic::experimental_noalias_scope_decl:
        case llvm::Intrinsic::pseudoprobe:
            return true;
        default:
            return false;
    }
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
        case llvm::Intrinsic::annotation:
        case llvm::Intrinsic::ptr_annotation:
        case llvm::Intrinsic::ssa_copy:
            return call.getArgOperand(0);
        case llvm::Intrinsic::bitreverse:
            return expand_bit_reversal(builder, call);
        case llvm::Intrinsic::ptrmask: {
            Value* bits = builder.CreatePtrToInt(call.getArgOperand(0), builder.getInt16Ty());
            return builder.CreateIntToPtr(builder.CreateAnd(bits, call.getArgOperand(1)),
                                          call.getType());
        }
        case llvm::Intrinsic::debugtrap:
            return builder.CreateCall(
                call.getModule()->getOrInsertFunction("__i85_hlt", builder.getVoidTy()));
        default:
            return nullptr;
    }
}

}  // namespace

void expand_intrinsics(llvm::Function& function) {
    llvm::IntrinsicLowering lowering(function.getParent()->getDataLayout());
    std::vector<llvm::IntrinsicInst*> calls;
    llvm::removeUnreachableBlocks(function);
    std::vector<llvm::IntrinsicInst*> traps;  // the first of each block: the rest is dead
    for (llvm::Instruction& instruction : llvm::instructions(function)) {
        auto* call = llvm::dyn_cast<llvm::IntrinsicInst>(&instruction);
        if (call == nullptr) continue;
        const llvm::Intrinsic::ID id = call->getIntrinsicID();
        const bool traps_here = id == llvm::Intrinsic::trap || id == llvm::Intrinsic::ubsantrap;
        if (!traps_here) {
            calls.push_back(call);
        } else if (traps.empty() || traps.back()->getParent() != call->getParent()) {
            traps.push_back(call);
        }
    }
    for (llvm::IntrinsicInst* call : calls) {
        switch (call->getIntrinsicID()) {
            case llvm::Intrinsic::ctpop:
            case llvm::Intrinsic::ctlz:
            case llvm::Intrinsic::cttz:
                lowering.LowerIntrinsicCall(call);
                continue;
            default:
                break;
        }
        if (is_dropped(call->getIntrinsicID())) {
            call->replaceAllUsesWith(llvm::PoisonValue::get(call->getType()));
            call->eraseFromParent();
            continue;
        }
        Builder builder(call);
        if (Value* replacement = expand(builder, *call)) {
            if (!call->getType()->isVoidTy()) call->replaceAllUsesWith(replacement);
            call->eraseFromParent();
        }
    }
    // Last: they cut blocks short, and with them calls that stand behind.
    for (llvm::IntrinsicInst* trap : traps) halt_for_ever(*trap);
    if (!traps.empty()) llvm::removeUnreachableBlocks(function);
}

}  // namespace toolchain::ir
