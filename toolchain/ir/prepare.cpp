// prepare.cpp - the order of the passes; see prepare.hpp and docs/design/ir-passes.md.
#include "toolchain/ir/prepare.hpp"

#include <llvm/IR/Module.h>
#include <llvm/IR/PassManager.h>
#include <llvm/IR/Verifier.h>
#include <llvm/Passes/PassBuilder.h>
#include <llvm/Support/raw_ostream.h>
#include <llvm/Transforms/Scalar/LowerConstantIntrinsics.h>

#include <stdexcept>
#include <string>

#include "toolchain/ir/passes.hpp"
#include "toolchain/ir/refuse.hpp"

namespace toolchain::ir {

namespace {

/// A broken pass must not become a wrong program.
void check(const llvm::Function& function, const char* behind) {
    std::string problem;
    llvm::raw_string_ostream stream(problem);
    if (llvm::verifyFunction(function, &stream)) {
        throw std::logic_error("behind " + std::string(behind) + ": " + problem);
    }
}

}  // namespace

void prepare(llvm::Module& module, bool undocumented, const Steps& steps) {
    const bool counts_up = undocumented && steps.contains(Step::zero_by_k);
    refuse_unsupported(module);
    llvm::FunctionAnalysisManager functions;
    llvm::PassBuilder builder;
    builder.registerFunctionAnalyses(functions);
    for (llvm::Function& function : module) {
        if (function.isDeclaration()) continue;
        const auto run = [&](const char* name, void (*pass)(llvm::Function&)) {
            pass(function);
            check(function, name);
        };
        llvm::LowerConstantIntrinsicsPass().run(function, functions);
        functions.invalidate(function, llvm::PreservedAnalyses::none());
        const auto take = [&](Step step, const char* name, void (*pass)(llvm::Function&)) {
            if (steps.contains(step)) run(name, pass);
        };
        run("copy_by_value_arguments", copy_by_value_arguments);
        take(Step::stepped_pointers, "step_pointers", step_pointers);
        take(Step::counting_down, "count_down", counts_up ? count_words_up : count_down);
        take(Step::pages, "find_pages", find_pages);
        take(Step::narrow_values, "narrow_values", narrow_values);
        run("expand_intrinsics", expand_intrinsics);
        run("expand_wide_products", expand_wide_products);
        run("lower_switches", lower_switches);
        take(Step::chosen_results, "choose_results", choose_results);
        run("split_conditions", split_conditions);
        run("expand_selects", expand_selects);
        run("split_conditions", split_conditions);  // those of selects
        take(Step::near_use, "place_near_use", place_near_use);
        if (counts_up) run("count_last", count_last);
    }
}

}  // namespace toolchain::ir
