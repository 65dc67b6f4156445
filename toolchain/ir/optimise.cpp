// optimise.cpp - LLVM's pipeline, set up for a machine without vectors and with dear code bytes.
// Depends on   libLLVM 19 (Passes).
#include <llvm/Passes/PassBuilder.h>

#include "toolchain/ir/analyses.hpp"
#include "toolchain/ir/prepare.hpp"

namespace toolchain::ir {

void optimise(llvm::Module& module, Optimisation level) {
    llvm::PipelineTuningOptions tuning;
    tuning.LoopVectorization = false;
    tuning.SLPVectorization = false;
    tuning.LoopUnrolling = false;
    llvm::PassBuilder builder(nullptr, tuning);
    ModuleAnalyses analyses(builder);
    using Level = llvm::OptimizationLevel;
    if (level == Optimisation::none) {
        analyses.run(builder.buildO0DefaultPipeline(Level::O0), module);
        return;
    }
    const Level wanted = level == Optimisation::less   ? Level::O1
                         : level == Optimisation::more ? Level::O2
                                                       : Level::Os;
    analyses.run(builder.buildPerModuleDefaultPipeline(wanted), module);
}

}  // namespace toolchain::ir
