// costs.hpp - what LLVM's passes are told about the price of operations on the 8085; internal to
// toolchain/ir.
// Why          without a target LLVM takes a product for as cheap as a sum, and puts products where
//              a loop would have counted the result.
// Depends on   libLLVM 19 (Analysis).
#pragma once

#include <llvm/Analysis/TargetTransformInfo.h>

namespace toolchain::ir {

/// To be registered in front of LLVM's own, which then stays away.
[[nodiscard]] llvm::TargetIRAnalysis operation_costs();

}  // namespace toolchain::ir
