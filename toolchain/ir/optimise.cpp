// optimise.cpp - LLVM's pipeline, set up for a machine without vectors and with dear code bytes.
// Depends on   libLLVM 19 (Passes).
#include <llvm/Passes/PassBuilder.h>

#include "toolchain/ir/prepare.hpp"

namespace toolchain::ir {

void optimise(llvm::Module& module, Optimisation level) {
    llvm::PipelineTuningOptions tuning;
    tuning.LoopVectorization = false;
    tuning.SLPVectorization = false;
    tuning.LoopUnrolling = false;
    llvm::PassBuilder builder(nullptr, tuning);
    llvm::LoopAnalysisManager loops;
    llvm::FunctionAnalysisManager functions;
    llvm::CGSCCAnalysisManager components;
    llvm::ModuleAnalysisManager modules;
    builder.registerModuleAnalyses(modules);
    builder.registerCGSCCAnalyses(components);
    builder.registerFunctionAnalyses(functions);
    builder.registerLoopAnalyses(loops);
    builder.crossRegisterProxies(loops, functions, components, modules);
    using Level = llvm::OptimizationLevel;
    if (level == Optimisation::none) {
        builder.buildO0DefaultPipeline(Level::O0).run(module, modules);
        return;
    }
    const Level wanted = level == Optimisation::less   ? Level::O1
                         : level == Optimisation::more ? Level::O2
                                                       : Level::Os;
    builder.buildPerModuleDefaultPipeline(wanted).run(module, modules);
}

}  // namespace toolchain::ir
