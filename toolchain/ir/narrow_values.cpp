// narrow_values.cpp - values that never need their upper bytes say so; see passes.hpp.
// Why          LLVM widens 8-bit counters and indices to 16 bits. Behind `zext(trunc x)` the upper
//              bytes are the constant 0: the code generator computes and keeps only the others.
// How          ScalarEvolution's ranges, which know loops, and known bits.
// Depends on   libLLVM 19.
#include <llvm/Analysis/ValueTracking.h>
#include <llvm/IR/IRBuilder.h>
#include <llvm/IR/InstIterator.h>
#include <llvm/IR/Instructions.h>
#include <llvm/IR/Module.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "toolchain/ir/analyses.hpp"
#include "toolchain/ir/passes.hpp"

namespace toolchain::ir {

namespace {

/// The constant bits at the top are seen without help.
bool shows_its_range(const llvm::Instruction& instruction) {
    using Code = llvm::Instruction;
    const unsigned code = instruction.getOpcode();
    if (code == Code::ZExt || code == Code::Trunc || code == Code::Freeze) return true;
    return (code == Code::And || code == Code::LShr) &&
           llvm::isa<llvm::ConstantInt>(instruction.getOperand(1));
}

}  // namespace

void narrow_values(llvm::Function& function) {
    Analyses analyses(function);
    llvm::ScalarEvolution& evolution = analyses.evolution();
    const llvm::DataLayout& layout = function.getParent()->getDataLayout();
    std::vector<std::pair<llvm::Instruction*, unsigned>> narrow;
    for (llvm::Instruction& instruction : llvm::instructions(function)) {
        if (!instruction.getType()->isIntegerTy() || instruction.use_empty()) continue;
        const unsigned bits = instruction.getType()->getIntegerBitWidth();
        if (bits <= 8 || shows_its_range(instruction)) continue;
        unsigned needed = llvm::computeKnownBits(&instruction, layout).countMaxActiveBits();
        if (bits <= 64) {
            const auto range = evolution.getUnsignedRange(evolution.getSCEV(&instruction));
            needed = std::min(needed, range.getUnsignedMax().getActiveBits());
        }
        const unsigned whole = std::max(8U, (needed + 7) / 8 * 8);
        if (whole < bits) narrow.emplace_back(&instruction, whole);
    }
    for (const auto& [instruction, bits] : narrow) {
        const auto place = instruction->getInsertionPointAfterDef();
        if (!place) continue;
        llvm::IRBuilder<> builder(instruction->getParent(), *place);
        llvm::Value* part = builder.CreateTrunc(instruction, builder.getIntNTy(bits));
        llvm::Value* whole = builder.CreateZExt(part, instruction->getType());
        instruction->replaceUsesWithIf(
            whole, [&, self = part](const llvm::Use& use) { return use.getUser() != self; });
    }
}

}  // namespace toolchain::ir
