// constants.hpp - LLVM constants as bytes: numbers, addresses of symbols, aggregates with padding.
// Depends on   libLLVM 19 (IR), toolchain/codegen/mir.hpp.
#pragma once

#include <llvm/IR/Constants.h>
#include <llvm/IR/DataLayout.h>

#include <stdexcept>
#include <vector>

#include "toolchain/codegen/mir.hpp"

namespace toolchain::ir {

/// A constant that has no bytes before the program runs; the message says which.
class BadConstant : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

/// The bytes of a constant as they stand in memory. @errors BadConstant
[[nodiscard]] std::vector<codegen::Datum> constant_data(codegen::Module& out,
                                                        const llvm::DataLayout& layout,
                                                        const llvm::Constant& constant);

/// A variable with its initial contents. @errors Refused
[[nodiscard]] codegen::Variable make_variable(codegen::Module& out, const llvm::DataLayout& layout,
                                              const llvm::GlobalVariable& variable);

}  // namespace toolchain::ir
