// generate.hpp - one function to machine code.
// Depends on   mir.hpp behind lower_calls().
#pragma once

#include <functional>

#include "toolchain/codegen/machine.hpp"
#include "toolchain/codegen/mir.hpp"
#include "toolchain/codegen/steps.hpp"

namespace toolchain::codegen {

struct GenerateOptions {
    bool search = true;  ///< look for register homes; without it every value lives in memory
    uint64_t search_budget = 0;    ///< operations to translate at most while searching; 0: by size
    double byte_cost = 1;          ///< T-states per execution that a byte of code is worth
    bool undocumented = false;     ///< the instructions that Intel left out may be used
    Steps steps{};                 ///< to be taken
    uint64_t homes_by_chance = 0;  ///< for tests: a seed; registers are right, but not good
    /// What a call of a function may change. Not asked for runtime routines.
    std::function<RegisterSet(SymbolId)> clobbers_of{};
};

/// @errors std::logic_error for what verify() would have found
[[nodiscard]] FunctionCode generate(const Module& module, const Function& function,
                                    const GenerateOptions& options = {});

}  // namespace toolchain::codegen
