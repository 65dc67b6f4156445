// steps.cpp - see steps.hpp.
#include "toolchain/codegen/steps.hpp"

#include <algorithm>

namespace toolchain {

namespace {

constexpr StepName kNames[] = {
    {Step::operation_costs, "operation-costs", "LLVM's passes know what operations cost",
     "ir/costs.cpp"},
    {Step::counting_loops, "counting-loops", "loops that count are not replaced by products",
     "ir/optimise.cpp"},
    {Step::fixed_places, "fixed-places", "pointers that always hold one address are that address",
     "ir/fix_places.cpp"},
    {Step::stepped_pointers, "stepped-pointers", "addresses in loops are stepped",
     "ir/step_pointers.cpp"},
    {Step::counting_down, "counting-down", "counters run down to 0, in as few bits as they need",
     "ir/count_down.cpp"},
    {Step::pages, "pages", "addresses within a page are computed in one byte", "ir/find_pages.cpp"},
    {Step::narrow_values, "narrow-values", "upper bytes that are always 0 are not computed",
     "ir/narrow_values.cpp"},
    {Step::chosen_results, "chosen-results", "a choice of operands becomes one of results",
     "ir/choose_results.cpp"},
    {Step::near_use, "near-use", "addresses and loads stand next to their only use",
     "ir/place_near_use.cpp"},
    {Step::narrow_calls, "narrow-calls", "the narrowest runtime routine for each call",
     "codegen/narrow_calls.cpp"},
    {Step::passages, "passages", "blocks that do nothing disappear", "codegen/simplify.cpp"},
    {Step::homes, "homes", "values live in registers across blocks", "codegen/homes.cpp"},
    {Step::detours, "detours", "a detour stands between what it leaves and what it joins",
     "codegen/homes.cpp"},
    {Step::carry_answers, "carry-answers", "comparisons that a sum's carry answers",
     "codegen/carries.cpp"},
    {Step::carry_signs, "carry-signs", "signs that a doubling leaves in the carry",
     "codegen/recipes_compare.cpp"},
    {Step::word_chains, "word-chains", "the lowest word of a long sum by DAD",
     "codegen/recipes_add.cpp"},
    {Step::clean_up, "clean-up", "values that are where they are wanted, dead results",
     "codegen/cleanup.cpp"},
    {Step::early_loads, "early-loads", "loads come in front of a branch to them",
     "codegen/early_loads.cpp"},
    {Step::merged_tails, "merged-tails", "equal ends of ways that meet are there once",
     "codegen/merge_tails.cpp"},
    {Step::short_forms, "short-forms", "shorter instructions where flags are not read",
     "codegen/short_forms.cpp"},
    {Step::tail_calls, "tail-calls", "a call in front of a return is a jump",
     "codegen/tail_calls.cpp"},
    {Step::lhlx, "lhlx", "LHLX", "codegen/recipes_memory.cpp", true},
    {Step::shlx, "shlx", "SHLX", "codegen/recipes_memory.cpp", true},
    {Step::dsub, "dsub", "DSUB", "codegen/recipes_add.cpp", true},
    {Step::arhl, "arhl", "ARHL", "codegen/recipes_undocumented.cpp", true},
    {Step::rdel, "rdel", "RDEL", "codegen/recipes_undocumented.cpp", true},
    {Step::ldhi, "ldhi", "LDHI", "codegen/coder_moves.cpp", true},
    {Step::less_by_k, "less-by-k", "JK and JNK behind a subtraction", "codegen/recipes_compare.cpp",
     true},
    {Step::zero_by_k, "zero-by-k", "JNK behind INX", "ir/count_down.cpp", true},
};

}  // namespace

std::span<const StepName> step_names() {
    return kNames;
}

std::optional<Step> step_named(std::string_view name) {
    const auto* found = std::ranges::find(kNames, name, &StepName::name);
    if (found == std::end(kNames)) return std::nullopt;
    return found->step;
}

Steps Steps::documented() const {
    Steps result = *this;
    for (const StepName& name : kNames) {
        if (name.undocumented) result.leave_out(name.step);
    }
    return result;
}

}  // namespace toolchain
