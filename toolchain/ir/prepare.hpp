// prepare.hpp - brings LLVM IR into the subset that select() knows.
// Depends on   libLLVM 19.
// Removes      switch, select, minimum and maximum, saturating and checked arithmetic, funnel
// shifts, bit
//              counting, byte swaps; memory intrinsics become calls of the runtime.
#pragma once

#include <cstdint>

namespace llvm {
class Module;
}

namespace toolchain::ir {

enum class Optimisation : uint8_t { none, less, more, size };

/// LLVM's own pipeline for that level, without vectors and unrolling.
void optimise(llvm::Module& module, Optimisation level);

/// Pointer parameters that always hold the same address are replaced by it; variables of a caller
/// become internal ones with kFrameAttribute, which select() gives back to its static frame.
void fix_places(llvm::Module& module);
inline constexpr const char* kFrameAttribute = "i85-frame";  ///< its value: the function

/// Replaces what select() does not know.
/// @param undocumented  the code will have JNK: long counts go up to 0, INX tells by K
void prepare(llvm::Module& module, bool undocumented = false);

}  // namespace toolchain::ir
