// join.hpp - bitcode to one module of LLVM: reading, linking, what stays visible, what is missing.
// Depends on   libLLVM 19, driver.hpp.
#pragma once

#include <llvm/IR/LLVMContext.h>
#include <llvm/IR/Module.h>

#include <filesystem>
#include <functional>
#include <memory>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "toolchain/driver/driver.hpp"

namespace toolchain::driver {

using ModulePointer = std::unique_ptr<llvm::Module>;

/// Reads bitcode or LLVM's text. @errors Failed
[[nodiscard]] ModulePointer read_module(const std::filesystem::path& file, const std::string& name,
                                        llvm::LLVMContext& context);

/// Links the second into the first. @errors Failed: a name that both define
void link_into(llvm::Module& into, ModulePointer from);

/// Names that are used in one of the modules and defined in none.
[[nodiscard]] std::set<std::string> missing_names(std::span<const ModulePointer> modules);

/// The symbols that `keep` means: by symbol, or demangled with or without parameters. Those that
/// are static become visible.
/// @errors Failed: a name that nothing bears
[[nodiscard]] std::set<std::string> find_kept(std::span<const ModulePointer> modules,
                                              const std::vector<std::string>& keep);

/// C++'s mangled main gets its plain name, and a main with parameters an other one that calls it
/// with zeros.
void settle_main(llvm::Module& module);

/// Makes all but main, interrupt functions and `visible` internal, and drops what is unused.
void internalise(llvm::Module& module, const std::set<std::string>& visible);

/// Replaces aliases by what they stand for, and weak names that nobody defines by null.
void settle_names(llvm::Module& module);

/// What does not depend on other modules nor on optimisation.
/// @errors Failed: an interrupt function that is called, or has no vector of the 8085, or the
/// vector
///         of another one; a call that does not fit the function; assembly outside of functions
void check_functions(const llvm::Module& module);

/// The same of all modules together.
/// @errors Failed: also what is used but not defined, and constructors if they are not allowed
void check_whole(const llvm::Module& module, bool allow_constructors);

/// Functions and variables with __attribute__((used)).
[[nodiscard]] std::vector<std::string> used_names(const llvm::Module& module);

}  // namespace toolchain::driver
