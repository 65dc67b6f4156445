// analyses.hpp - LLVM's analyses of one function or of a module, computed when asked for; internal
// to toolchain/ir. Depends on   libLLVM 19.
#pragma once

#include <llvm/Analysis/LoopInfo.h>
#include <llvm/Analysis/ScalarEvolution.h>
#include <llvm/IR/Dominators.h>
#include <llvm/IR/PassManager.h>
#include <llvm/Passes/PassBuilder.h>

#include "toolchain/ir/costs.hpp"

namespace toolchain::ir {

/// A pass that changes the function asks anew, or tells the analyses what it did.
class Analyses {
public:
    explicit Analyses(llvm::Function& function) : function_(function) {
        manager_.registerPass([] { return operation_costs(); });
        llvm::PassBuilder().registerFunctionAnalyses(manager_);
    }

    template <typename Analysis>
    typename Analysis::Result& get() {
        return manager_.getResult<Analysis>(function_);
    }
    llvm::ScalarEvolution& evolution() { return get<llvm::ScalarEvolutionAnalysis>(); }
    llvm::LoopInfo& loops() { return get<llvm::LoopAnalysis>(); }
    llvm::DominatorTree& dominators() { return get<llvm::DominatorTreeAnalysis>(); }

    /// Runs a pass of LLVM.
    template <typename Pass>
    void run(Pass pass) {
        manager_.invalidate(function_, pass.run(function_, manager_));
    }

private:
    llvm::Function& function_;
    llvm::FunctionAnalysisManager manager_;
};

/// Of a whole module, for LLVM's own pass managers.
class ModuleAnalyses {
public:
    /// @param with_costs  false: those of LLVM
    explicit ModuleAnalyses(llvm::PassBuilder& builder, bool with_costs = true) {
        if (with_costs) functions_.registerPass([] { return operation_costs(); });
        builder.registerModuleAnalyses(modules_);
        builder.registerCGSCCAnalyses(components_);
        builder.registerFunctionAnalyses(functions_);
        builder.registerLoopAnalyses(loops_);
        builder.crossRegisterProxies(loops_, functions_, components_, modules_);
    }

    void run(llvm::ModulePassManager passes, llvm::Module& module) { passes.run(module, modules_); }

private:
    llvm::LoopAnalysisManager loops_;
    llvm::FunctionAnalysisManager functions_;
    llvm::CGSCCAnalysisManager components_;
    llvm::ModuleAnalysisManager modules_;
};

}  // namespace toolchain::ir
