// optimise.cpp - LLVM's pipeline, set up for a machine without vectors and with dear code bytes.
// Depends on   libLLVM 19 (Passes).
#include <llvm/Passes/PassBuilder.h>
#include <llvm/Support/CommandLine.h>
#include <llvm/Transforms/Utils/LoopUtils.h>

#include "toolchain/ir/analyses.hpp"
#include "toolchain/ir/prepare.hpp"

namespace toolchain::ir {

namespace {

/// A loop that counts something is not replaced by products of its counts: they take longer here.
void keep_counting_loops(bool keep) {
    using Option = llvm::cl::opt<llvm::ReplaceExitVal>;
    auto& option = *static_cast<Option*>(llvm::cl::getRegisteredOptions()["replexitval"]);
    const auto wanted =
        keep ? llvm::ReplaceExitVal::UnusedIndVarInLoop : llvm::ReplaceExitVal::OnlyCheapRepl;
    if (option != wanted) option.setValue(wanted);
}

}  // namespace

void optimise(llvm::Module& module, Optimisation level, const Steps& steps) {
    keep_counting_loops(steps.contains(Step::counting_loops));
    llvm::PipelineTuningOptions tuning;
    tuning.LoopVectorization = false;
    tuning.SLPVectorization = false;
    tuning.LoopUnrolling = false;
    llvm::PassBuilder builder(nullptr, tuning);
    ModuleAnalyses analyses(builder, steps.contains(Step::operation_costs));
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
