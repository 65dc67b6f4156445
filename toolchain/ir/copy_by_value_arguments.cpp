// copy_by_value_arguments.cpp - structs passed by value; see passes.hpp.
// Why          the front end passes every struct as a pointer marked "byval": the callee may change
//              what it points to, so somebody has to copy. A variable of the caller for each
//              argument is a fixed address in its static frame.
// Depends on   libLLVM 19.
#include <llvm/IR/IRBuilder.h>
#include <llvm/IR/InstIterator.h>
#include <llvm/IR/Instructions.h>
#include <llvm/IR/Module.h>

#include <vector>

#include "toolchain/ir/passes.hpp"

namespace toolchain::ir {

void copy_by_value_arguments(llvm::Function& function) {
    std::vector<llvm::CallBase*> calls;
    for (llvm::Instruction& instruction : llvm::instructions(function)) {
        auto* call = llvm::dyn_cast<llvm::CallBase>(&instruction);
        if (call != nullptr && call->hasByValArgument()) calls.push_back(call);
    }
    const llvm::DataLayout& layout = function.getParent()->getDataLayout();
    for (llvm::CallBase* call : calls) {
        for (unsigned i = 0; i < call->arg_size(); ++i) {
            if (!call->isByValArgument(i)) continue;
            llvm::Type* type = call->getParamByValType(i);
            llvm::IRBuilder<> at_entry(&function.getEntryBlock(),
                                       function.getEntryBlock().getFirstInsertionPt());
            llvm::AllocaInst* copy = at_entry.CreateAlloca(type);
            llvm::IRBuilder<> builder(call);
            builder.CreateMemCpy(copy, llvm::MaybeAlign(1), call->getArgOperand(i),
                                 llvm::MaybeAlign(1), layout.getTypeAllocSize(type));
            call->setArgOperand(i, copy);
            call->removeParamAttr(i, llvm::Attribute::ByVal);
        }
    }
}

}  // namespace toolchain::ir
