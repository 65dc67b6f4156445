// passes.hpp - the passes of prepare(), one a file; prepare.cpp has their order.
// Depends on   libLLVM 19.
// Design note  docs/design/ir-passes.md
#pragma once

namespace llvm {
class Function;
class Module;
}  // namespace llvm

namespace toolchain::ir {

/// Arguments passed by value in memory: the caller makes the copy, in a variable of its own.
void copy_by_value_arguments(llvm::Function& function);

/// Addresses and products that grow evenly in a loop are stepped instead of computed.
void step_pointers(llvm::Function& function);

/// Counters that nothing else uses run down to 0, in 8 bits where that is enough.
void count_down(llvm::Function& function);
/// The same, but those of 16 bits go up to 0: INX tells it by K.
void count_words_up(llvm::Function& function);

/// Words that go up to 0 are stepped in front of their branch: another INX would change K.
void count_last(llvm::Function& function);

/// Integers whose upper bytes are always 0 are marked by `zext(trunc x)`.
void narrow_values(llvm::Function& function);

/// Intrinsics become instructions, calls of the runtime, or nothing. Traps halt for ever.
void expand_intrinsics(llvm::Function& function);

/// Multiplications of more than 64 bits become sums of 32-bit products.
void expand_wide_products(llvm::Function& function);

/// Switches become trees of comparisons and dense tables: a switch is left only with an i8
/// condition, cases 0, 1, 2 ... and a default that is never reached.
void lower_switches(llvm::Function& function);

/// Operations on a choice where one value is neutral become a choice of results.
void choose_results(llvm::Function& function);

/// A branch on `a and b` or `a or b` becomes two.
void split_conditions(llvm::Function& function);

/// Each select becomes a branch, with what only one value needs on its way.
void expand_selects(llvm::Function& function);

/// Addresses whose upper byte does not depend on the subscript get kPageNote.
void find_pages(llvm::Function& function);
/// Metadata: the variable's byte whose address has that upper byte.
inline constexpr const char* kPageNote = "i85.page";

/// Addresses and loads stand next to their only use.
void place_near_use(llvm::Function& function);

}  // namespace toolchain::ir
