// constructors.cpp - see constructors.hpp.
#include "toolchain/ir/constructors.hpp"

#include <llvm/IR/Constants.h>
#include <llvm/IR/Module.h>

#include <algorithm>
#include <utility>

namespace toolchain::ir {

std::vector<codegen::SymbolId> constructors_of(codegen::Module& out, const llvm::Module& module) {
    const llvm::GlobalVariable* list = module.getGlobalVariable("llvm.global_ctors");
    if (list == nullptr || !list->hasInitializer()) return {};
    std::vector<std::pair<uint64_t, codegen::SymbolId>> found;
    for (const llvm::Use& entry : list->getInitializer()->operands()) {
        const auto* fields = llvm::dyn_cast<llvm::ConstantStruct>(entry);
        if (fields == nullptr) continue;
        const auto* priority = llvm::cast<llvm::ConstantInt>(fields->getOperand(0));
        const llvm::Value* function = fields->getOperand(1)->stripPointerCasts();
        if (!llvm::isa<llvm::Function>(function)) continue;  // null ends a list of old
        found.emplace_back(priority->getZExtValue(), out.intern(function->getName().str()));
    }
    std::ranges::stable_sort(found, {}, &decltype(found)::value_type::first);
    std::vector<codegen::SymbolId> result;
    result.reserve(found.size());
    for (const auto& [priority, symbol] : found) result.push_back(symbol);
    return result;
}

}  // namespace toolchain::ir
