// prepare.hpp - brings LLVM IR into the subset that select() knows.
// Depends on   libLLVM 19.
// Removes      switch, select, minimum and maximum, saturating and checked arithmetic, funnel
// shifts, bit
//              counting, byte swaps; memory intrinsics become calls of the runtime.
#pragma once

#include <cstdint>

#include "toolchain/codegen/steps.hpp"

namespace llvm {
class Module;
}

namespace toolchain::ir {

enum class Optimisation : uint8_t { none, less, more, size };

/// LLVM's own pipeline for that level, without vectors and unrolling. Of the steps, LLVM keeps
/// counting_loops for the whole process.
void optimise(llvm::Module& module, Optimisation level, const Steps& steps = {});

/// Pointer parameters that always hold the same address are replaced by it; variables of a caller
/// become internal ones with kFrameAttribute, which select() gives back to its static frame.
void fix_places(llvm::Module& module);
inline constexpr const char* kFrameAttribute = "i85-frame";  ///< its value: the function

/// Replaces what select() does not know.
/// @param undocumented  the code will have JNK: long counts go up to 0, INX tells by K
void prepare(llvm::Module& module, bool undocumented = false, const Steps& steps = {});

}  // namespace toolchain::ir
