// select_integers.cpp - arithmetic, shifts, casts, comparisons, addresses. An integer of an odd
// width keeps zeros in the bits above it. Depends on   selector.hpp.
#include <fmt/format.h>
#include <llvm/Analysis/ValueTracking.h>
#include <llvm/IR/DataLayout.h>
#include <llvm/IR/GetElementPtrTypeIterator.h>
#include <llvm/IR/Metadata.h>
#include <llvm/IR/Operator.h>

#include <bit>
#include <vector>

#include "toolchain/ir/passes.hpp"
#include "toolchain/ir/selector.hpp"

namespace toolchain::ir {

using codegen::Bytes;
using codegen::Opcode;
using codegen::Predicate;

namespace {

unsigned bits_of(const llvm::Value& value) {
    return value.getType()->getIntegerBitWidth();
}

// Digits -1, 0 and 1, from the lowest on, no two beside each other other than 0.
std::vector<int> signed_digits(uint64_t factor, std::size_t bits) {
    std::vector<int> digits;
    for (std::size_t i = 0; i < bits; ++i) {
        int digit = static_cast<int>(factor & 1);
        // 3, 7, 15 ... end as 4 - 1, 8 - 1, 16 - 1.
        if (digit != 0 && (factor & 2) != 0) digit = -1;
        factor = (factor >> 1) + (digit < 0 ? 1U : 0U);
        digits.push_back(digit);
    }
    return digits;
}

std::vector<int> binary_digits(uint64_t factor, std::size_t bits) {
    std::vector<int> digits;
    for (std::size_t i = 0; i < bits; ++i) digits.push_back(static_cast<int>(factor >> i & 1));
    return digits;
}

// T-states of the shifts and additions, roughly: DAD for words, MOV and RAL or ADC for other bytes.
unsigned chain_cost(const std::vector<int>& digits, std::size_t size) {
    const unsigned shift = size == 2 ? 10 : static_cast<unsigned>(size) * 12;
    const unsigned plus = size == 2 ? 12 : static_cast<unsigned>(size) * 16;
    const unsigned minus = size == 2 ? 26 : plus;
    unsigned cost = 0;
    unsigned pending = 0;
    for (const int digit : digits) {
        if (digit != 0) {
            cost += (digit > 0 ? plus : minus) + pending % 8 * shift;
            pending = 0;
        }
        ++pending;
    }
    return cost;
}

// Subtracting a word is longer than adding one.
std::vector<int> best_digits(uint64_t factor, std::size_t size) {
    const std::vector<int> few = signed_digits(factor, 8 * size);
    const std::vector<int> positive = binary_digits(factor, 8 * size);
    return chain_cost(positive, size) < chain_cost(few, size) ? positive : few;
}

}  // namespace

Bytes Selector::select_binary(const llvm::BinaryOperator& operation) {
    using Instruction = llvm::Instruction;
    const unsigned bits = bits_of(operation);
    const auto left = [&] { return value(operation.getOperand(0)); };
    const auto right = [&] { return value(operation.getOperand(1)); };
    switch (operation.getOpcode()) {
        case Instruction::Add:
            return masked(builder_.add(left(), right()), bits);
        case Instruction::Sub:
            return masked(builder_.subtract(left(), right()), bits);
        case Instruction::And:
            return builder_.bitwise(Opcode::bit_and, left(), mask_of(operation));
        case Instruction::Or:
            return builder_.bitwise(Opcode::bit_or, left(), right());
        case Instruction::Xor:
            return builder_.bitwise(Opcode::bit_xor, left(), right());
        case Instruction::Mul:
            return masked(select_multiply(operation), bits);
        case Instruction::Shl:
        case Instruction::LShr:
        case Instruction::AShr:
            return masked(select_shift(operation), bits);
        case Instruction::UDiv:
        case Instruction::URem:
        case Instruction::SDiv:
        case Instruction::SRem:
            return masked(select_divide(operation), bits);
        default:
            break;
    }
    refuse(operation, fmt::format("'{}': the 8085 has no floating point; use a Q format",
                                  operation.getOpcodeName()));
}

// LLVM takes bits out of a mask that are 0 anyway; a byte that no bit of is to go needs no mask.
Bytes Selector::mask_of(const llvm::BinaryOperator& operation) {
    Bytes mask = value(operation.getOperand(1));
    const auto* number = llvm::dyn_cast<llvm::ConstantInt>(operation.getOperand(1));
    if (number == nullptr) return mask;
    const llvm::APInt zero =
        llvm::computeKnownBits(operation.getOperand(0), layout_).Zero | number->getValue();
    for (unsigned at = 0; at < mask.size(); ++at) {
        const unsigned bits = std::min(8U, zero.getBitWidth() - 8 * at);
        const bool clears = zero.extractBitsAsZExtValue(bits, 8 * at) + 1 != 1ULL << bits;
        if (!clears) mask[at] = builder_.constant(0xFF, 1)[0];
    }
    return mask;
}

// Horner's scheme over the digits.
Bytes Selector::multiply_by_constant(const Bytes& value, uint64_t factor) {
    const std::vector<int> digits = best_digits(factor, value.size());
    Bytes sum = builder_.constant(0, value.size());
    unsigned shift = 0;
    bool empty = true;
    for (std::size_t i = digits.size(); i-- > 0;) {
        if (!empty) ++shift;
        if (digits[i] == 0) continue;
        sum = builder_.shift_left(sum, shift);
        sum = digits[i] > 0 ? builder_.add(sum, value) : builder_.subtract(sum, value);
        shift = 0;
        empty = false;
    }
    return builder_.shift_left(sum, shift);
}

Bytes Selector::select_multiply(const llvm::BinaryOperator& operation) {
    Bytes left = value(operation.getOperand(0));
    Bytes right = value(operation.getOperand(1));
    if (builder_.value_of(left)) std::swap(left, right);
    if (const auto factor = builder_.value_of(right)) {
        constexpr unsigned kCostPerBit = 25;  // of the routines
        const auto bits = static_cast<unsigned>(right.size() * 8);
        if (chain_cost(best_digits(*factor, right.size()), right.size()) <= kCostPerBit * bits) {
            return multiply_by_constant(left, *factor);
        }
    }
    const std::size_t size = left.size();
    const std::size_t left_size = size - builder_.leading_zero_bytes(left);
    const std::size_t right_size = size - builder_.leading_zero_bytes(right);
    if (size <= 4 && left_size <= 1 && right_size <= 1 && size > 1) {
        left.resize(1);
        right.resize(1);
        return builder_.zero_extended(runtime("__mul8", {left, right}, 2), size);
    }
    if (size == 4 && left_size <= 2 && right_size <= 2) {
        left.resize(2);
        right.resize(2);
        return runtime("__umul16w", {left, right}, 4);
    }
    if (size == 1) {
        Bytes product = runtime("__mul8", {left, right}, 2);
        product.resize(1);
        return product;
    }
    const std::size_t wide = std::bit_ceil(size);
    Bytes product =
        runtime(wide == 2   ? "__mul16"
                : wide == 4 ? "__mul32"
                            : "__mul64",
                {builder_.zero_extended(left, wide), builder_.zero_extended(right, wide)}, wide);
    product.resize(size);
    return product;
}

Bytes Selector::select_divide(const llvm::BinaryOperator& operation) {
    using Instruction = llvm::Instruction;
    const auto opcode = operation.getOpcode();
    const bool is_signed = opcode == Instruction::SDiv || opcode == Instruction::SRem;
    const bool remainder = opcode == Instruction::URem || opcode == Instruction::SRem;
    const unsigned bits = bits_of(operation);
    const std::size_t size = (bits + 7) / 8;
    const std::size_t wide = std::bit_ceil(size);
    if (size > 8) refuse(operation, "a division of more than 64 bits");
    const auto operand = [&](unsigned index) {
        const Bytes bytes = value(operation.getOperand(index));
        return is_signed ? sign_from(bytes, bits, wide) : builder_.zero_extended(bytes, wide);
    };
    // One call gives both: the second of quotient and remainder only takes its half.
    Bytes& result = divisions_[{operation.getParent(), operation.getOperand(0),
                                operation.getOperand(1), is_signed}];
    if (result.empty()) {
        result = runtime(fmt::format("__{}div{}", is_signed ? "s" : "u", wide * 8),
                         {operand(0), operand(1)}, 2 * wide);
    }
    const auto middle = result.begin() + static_cast<std::ptrdiff_t>(wide);
    Bytes half = remainder ? Bytes(middle, result.end()) : Bytes(result.begin(), middle);
    half.resize(size);
    return half;
}

Bytes Selector::select_shift(const llvm::BinaryOperator& operation) {
    using Instruction = llvm::Instruction;
    const auto opcode = operation.getOpcode();
    const unsigned bits = bits_of(operation);
    const Bytes count = value(operation.getOperand(1));
    Bytes shifted = value(operation.getOperand(0));
    if (opcode == Instruction::AShr) shifted = sign_from(shifted, bits, shifted.size());
    const std::size_t known = std::min<std::size_t>(count.size(), 8);
    const Bytes low_count(count.begin(), count.begin() + static_cast<std::ptrdiff_t>(known));
    if (const auto number = builder_.value_of(low_count);
        number && builder_.leading_zero_bytes(count) >= count.size() - known) {
        const auto amount = static_cast<unsigned>(std::min<uint64_t>(*number, bits));
        if (opcode == Instruction::Shl) return builder_.shift_left(shifted, amount);
        if (opcode == Instruction::LShr) return builder_.shift_right(shifted, amount);
        return builder_.shift_right_signed(shifted, amount);
    }
    if (shifted.size() > 8) refuse(operation, "a shift of more than 64 bits by a variable");
    const std::size_t wide = std::bit_ceil(shifted.size());
    const char* name = opcode == Instruction::Shl    ? "shl"
                       : opcode == Instruction::LShr ? "lshr"
                                                     : "ashr";
    const std::size_t size = shifted.size();
    shifted = opcode == Instruction::AShr ? builder_.sign_extended(shifted, wide)
                                          : builder_.zero_extended(shifted, wide);
    Bytes result = runtime(fmt::format("__{}{}", name, wide * 8), {shifted, {count[0]}}, wide);
    result.resize(size);
    return result;
}

Bytes Selector::select_cast(const llvm::CastInst& cast) {
    const Bytes bytes = value(cast.getOperand(0));
    const std::size_t size = size_of(cast.getType());
    switch (cast.getOpcode()) {
        case llvm::Instruction::ZExt:
        case llvm::Instruction::IntToPtr:
        case llvm::Instruction::BitCast:
            return builder_.zero_extended(bytes, size);
        case llvm::Instruction::Trunc:
            // What is cut off is 0, as for a bool from memory: nothing to mask.
            if (llvm::cast<llvm::TruncInst>(cast).hasNoUnsignedWrap()) {
                return builder_.zero_extended(bytes, size);
            }
            [[fallthrough]];
        case llvm::Instruction::PtrToInt:
            return masked(builder_.zero_extended(bytes, size), bits_of(cast));
        case llvm::Instruction::SExt:
            return masked(sign_from(bytes, bits_of(*cast.getOperand(0)), size), bits_of(cast));
        default:
            break;
    }
    refuse(cast, fmt::format("'{}': the 8085 has no floating point; use a Q format",
                             cast.getOpcodeName()));
}

// Top bytes that are 0 on both sides decide nothing; without them the rest is unsigned.
bool Selector::drop_equal_tops(Bytes& left, Bytes& right, bool is_signed) const {
    const std::size_t zeros =
        std::min(builder_.leading_zero_bytes(left), builder_.leading_zero_bytes(right));
    const std::size_t dropped = std::min(zeros, left.size() - 1);
    left.resize(left.size() - dropped);
    right.resize(right.size() - dropped);
    return !is_signed || zeros > 0;
}

Selector::Comparison Selector::comparison(const llvm::ICmpInst& compare) {
    using Wanted = llvm::CmpInst::Predicate;
    const bool is_signed = compare.isSigned();
    const auto operand = [&](unsigned index) {
        const llvm::Value* which = compare.getOperand(index);
        return is_signed ? signed_value(which) : value(which);
    };
    Bytes left = operand(0);
    Bytes right = operand(1);
    const bool is_unsigned = drop_equal_tops(left, right, is_signed);
    const Predicate less = is_unsigned ? Predicate::below : Predicate::less;
    const Predicate not_less = inverse(less);
    switch (compare.getPredicate()) {
        case Wanted::ICMP_EQ:
            return {Predicate::equal, left, right};
        case Wanted::ICMP_NE:
            return {Predicate::not_equal, left, right};
        case Wanted::ICMP_ULT:
            return {Predicate::below, left, right};
        case Wanted::ICMP_UGE:
            return {Predicate::not_below, left, right};
        case Wanted::ICMP_UGT:
            return {Predicate::below, right, left};
        case Wanted::ICMP_ULE:
            return {Predicate::not_below, right, left};
        case Wanted::ICMP_SLT:
            return {less, left, right};
        case Wanted::ICMP_SGE:
            return {not_less, left, right};
        case Wanted::ICMP_SGT:
            return {less, right, left};
        case Wanted::ICMP_SLE:
            return {not_less, right, left};
        default:
            break;
    }
    refuse(compare, "comparison not supported");
}

Bytes Selector::select_compare(const llvm::ICmpInst& compare) {
    const Comparison wanted = comparison(compare);
    return {builder_.compare(wanted.predicate, wanted.left, wanted.right)};
}

// Behind find_pages(): the lower byte is a sum of bytes, the upper one known.
Bytes Selector::select_in_page(const llvm::GetElementPtrInst& address, const llvm::MDNode& note) {
    const unsigned bits = layout_.getIndexTypeSizeInBits(address.getType());
    llvm::APInt fixed(bits, 0);
    const auto* variable = llvm::cast<llvm::GlobalVariable>(
        address.getPointerOperand()->stripAndAccumulateConstantOffsets(layout_, fixed,
                                                                       /*AllowNonInbounds=*/true));
    llvm::MapVector<llvm::Value*, llvm::APInt> subscripts;
    llvm::APInt inner(bits, 0);
    llvm::cast<llvm::GEPOperator>(address).collectOffset(layout_, bits, subscripts, inner);
    const auto offset = static_cast<int32_t>((fixed + inner).getSExtValue());
    const auto page = llvm::mdconst::extract<llvm::ConstantInt>(note.getOperand(0))->getZExtValue();
    const auto symbol = out_.intern(variable->getName().str());
    Bytes low = {builder_.address(symbol, offset)[0]};
    if (variable->getAlign().valueOrOne().value() >= 256) {
        low = builder_.constant(static_cast<uint8_t>(offset), 1);
    }
    for (const auto& [index, stride] : subscripts) {
        const Bytes scaled = multiply_by_constant({value(index)[0]}, stride.getZExtValue() & 0xFF);
        low = builder_.add(low, scaled);
    }
    return {low[0], builder_.address(symbol, static_cast<int32_t>(page))[1]};
}

// Fields of an element of a variable that lies in one page lie in it, too.
std::optional<Bytes> Selector::select_field_in_page(const llvm::GetElementPtrInst& address) {
    const auto* element = llvm::dyn_cast<llvm::GetElementPtrInst>(address.getPointerOperand());
    llvm::APInt fixed(layout_.getIndexTypeSizeInBits(address.getType()), 0);
    if (element == nullptr || element->getMetadata(kPageNote) == nullptr ||
        !address.accumulateConstantOffset(layout_, fixed)) {
        return std::nullopt;
    }
    llvm::APInt before = fixed;
    const auto* variable = llvm::cast<llvm::GlobalVariable>(
        element->getPointerOperand()->stripAndAccumulateConstantOffsets(layout_, before,
                                                                        /*AllowNonInbounds=*/true));
    if (layout_.getTypeAllocSize(variable->getValueType()).getFixedValue() > 256) {
        return std::nullopt;
    }
    const Bytes whole = value(element);
    const uint64_t offset = fixed.getZExtValue() & 0xFF;
    return Bytes{builder_.add({whole[0]}, builder_.constant(offset, 1))[0], whole[1]};
}

Bytes Selector::select_address(const llvm::GetElementPtrInst& address) {
    constexpr std::size_t kPointerSize = 2;
    if (const llvm::MDNode* note = address.getMetadata(kPageNote)) {
        return select_in_page(address, *note);
    }
    if (const auto field = select_field_in_page(address)) return *field;
    Bytes sum = value(address.getPointerOperand());
    int64_t fixed = 0;
    for (auto index = llvm::gep_type_begin(address); index != llvm::gep_type_end(address);
         ++index) {
        const llvm::Value* operand = index.getOperand();
        if (auto* structure = index.getStructTypeOrNull()) {
            const auto field = llvm::cast<llvm::ConstantInt>(operand)->getZExtValue();
            fixed += static_cast<int64_t>(layout_.getStructLayout(structure)
                                              ->getElementOffset(static_cast<unsigned>(field))
                                              .getFixedValue());
            continue;
        }
        const auto stride =
            static_cast<uint64_t>(index.getSequentialElementStride(layout_).getFixedValue());
        if (const auto* number = llvm::dyn_cast<llvm::ConstantInt>(operand)) {
            fixed += number->getSExtValue() * static_cast<int64_t>(stride);
            continue;
        }
        Bytes scaled = sign_from(value(operand), bits_of(*operand), kPointerSize);
        sum = builder_.add(sum, multiply_by_constant(scaled, stride));
    }
    return builder_.add(sum, builder_.constant(static_cast<uint64_t>(fixed), kPointerSize));
}

}  // namespace toolchain::ir
