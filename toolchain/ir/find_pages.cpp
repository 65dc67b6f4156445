// find_pages.cpp - subscripts of small tables need no carry; see passes.hpp.
// Why          `base + i` of words is MVI H, two DADs and a constant in another pair: 41 T-states.
// In
//              a table that does not cross a 256-byte page, the upper byte of every element's
//              address is that of the table: ADD A, ADI, MOV L,A, MVI H are 22, and no pair is
//              used.
// Invariant    an address that is only loaded from and stored to lies inside its variable.
// How          notes at the address for select(); the variable's alignment grows to its size, so
//              that it lies in one page. One that its source has aligned to pages may be larger:
//              there the range of the subscript counts.
// Depends on   libLLVM 19.
#include <llvm/ADT/bit.h>
#include <llvm/IR/GetElementPtrTypeIterator.h>
#include <llvm/IR/InstIterator.h>
#include <llvm/IR/Instructions.h>
#include <llvm/IR/Module.h>
#include <llvm/IR/Operator.h>

#include <optional>

#include "toolchain/ir/analyses.hpp"
#include "toolchain/ir/passes.hpp"

namespace toolchain::ir {

namespace {

constexpr uint64_t kPage = 256;
/// Alignment leaves gaps; in ROM something else fills them.
constexpr uint64_t kMostInRam = 64;

bool is_access(const llvm::Use& use) {
    if (llvm::isa<llvm::LoadInst>(use.getUser())) return true;
    const auto* store = llvm::dyn_cast<llvm::StoreInst>(use.getUser());
    return store != nullptr && use.getOperandNo() == llvm::StoreInst::getPointerOperandIndex();
}

bool is_field(const llvm::User& user) {
    const auto* address = llvm::dyn_cast<llvm::GetElementPtrInst>(&user);
    return address != nullptr && address->hasAllConstantIndices();
}

/// Is the address, or a field behind it, used for nothing but accesses?
bool only_accessed(const llvm::Instruction& address) {
    return !address.use_empty() && llvm::all_of(address.uses(), [](const llvm::Use& use) {
        if (is_access(use)) return true;
        return is_field(*use.getUser()) && llvm::all_of(use.getUser()->uses(), is_access);
    });
}

/// A variable of this program plus a fixed number of bytes, and one subscript.
struct Subscript {
    llvm::GlobalVariable* variable = nullptr;
    uint64_t fixed = 0;
    llvm::Value* index = nullptr;
    uint64_t stride = 0;
};

std::optional<Subscript> subscript_of(llvm::GetElementPtrInst& address,
                                      const llvm::DataLayout& layout) {
    llvm::APInt before(layout.getIndexTypeSizeInBits(address.getType()), 0);
    auto* base = llvm::dyn_cast<llvm::GlobalVariable>(
        address.getPointerOperand()->stripAndAccumulateConstantOffsets(layout, before, true));
    if (base == nullptr || base->isDeclaration() || base->isThreadLocal()) return std::nullopt;
    llvm::MapVector<llvm::Value*, llvm::APInt> variable;
    llvm::APInt fixed(before.getBitWidth(), 0);
    const bool known = llvm::cast<llvm::GEPOperator>(address).collectOffset(
        layout, fixed.getBitWidth(), variable, fixed);
    if (!known || variable.size() != 1) return std::nullopt;
    const auto& [index, stride] = *variable.begin();
    return Subscript{base, (before + fixed).getZExtValue(), index, stride.getZExtValue()};
}

class PageFinder {
public:
    explicit PageFinder(llvm::Function& function)
        : function_(function), layout_(function.getParent()->getDataLayout()) {}

    void run() {
        for (llvm::Instruction& instruction : llvm::instructions(function_)) {
            auto* address = llvm::dyn_cast<llvm::GetElementPtrInst>(&instruction);
            if (address == nullptr || address->hasAllConstantIndices()) continue;
            const auto subscript = subscript_of(*address, layout_);
            if (!subscript) continue;
            const auto page = page_of(*address, *subscript);
            if (page) note(*address, *page);
        }
    }

private:
    /// First byte of the page in the variable that all elements lie in.
    std::optional<uint64_t> page_of(const llvm::Instruction& address, const Subscript& of) {
        llvm::GlobalVariable& variable = *of.variable;
        const uint64_t size = layout_.getTypeAllocSize(variable.getValueType()).getFixedValue();
        const uint64_t alignment =
            layout_.getValueOrABITypeAlignment(variable.getAlign(), variable.getValueType())
                .value();
        if (size <= kPage && only_accessed(address)) {
            const uint64_t wanted = llvm::bit_ceil(size);
            if (alignment < wanted && !variable.isConstant() && size > kMostInRam) {
                return std::nullopt;
            }
            if (alignment < wanted) variable.setAlignment(llvm::Align(wanted));
            return 0;
        }
        if (alignment < kPage) return std::nullopt;
        const llvm::ConstantRange range =
            analyses_.evolution().getUnsignedRange(analyses_.evolution().getSCEV(of.index));
        const uint64_t most = range.getUnsignedMax().getLimitedValue(kPage);
        if (of.fixed % kPage + most * of.stride >= kPage) return std::nullopt;
        return of.fixed - of.fixed % kPage;
    }

    void note(llvm::Instruction& address, uint64_t page) {
        llvm::LLVMContext& context = function_.getContext();
        auto* number = llvm::ConstantInt::get(llvm::Type::getInt16Ty(context), page);
        address.setMetadata(kPageNote,
                            llvm::MDNode::get(context, llvm::ConstantAsMetadata::get(number)));
    }

    llvm::Function& function_;
    const llvm::DataLayout& layout_;
    Analyses analyses_{function_};
};

}  // namespace

void find_pages(llvm::Function& function) {
    PageFinder(function).run();
}

}  // namespace toolchain::ir
