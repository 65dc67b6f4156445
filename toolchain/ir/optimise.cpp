// optimise.cpp - LLVM's pipeline, set up for a machine without vectors and with dear code bytes.
// Depends on   libLLVM 19 (Passes).
#include <llvm/Passes/PassBuilder.h>
#include <llvm/Support/CommandLine.h>

#include <mutex>

#include "toolchain/ir/analyses.hpp"
#include "toolchain/ir/prepare.hpp"

namespace toolchain::ir {

namespace {

/// A loop that counts something is not replaced by products of its counts: they take longer here.
void keep_counting_loops() {
    static std::once_flag once;
    std::call_once(once, [] {
        llvm::cl::getRegisteredOptions()["replexitval"]->addOccurrence(0, "replexitval",
                                                                       "unusedindvarinloop");
    });
}

}  // namespace

void optimise(llvm::Module& module, Optimisation level) {
    keep_counting_loops();
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
