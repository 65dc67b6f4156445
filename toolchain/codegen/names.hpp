// names.hpp - names of the program as names that the assembler takes.
// Why          clang calls a string ".str.1"; to the assembler a leading dot means local.
// Depends on   mir.hpp.
#pragma once

#include <string>
#include <vector>

#include "toolchain/codegen/mir.hpp"

namespace toolchain::codegen {

/// Every symbol of a module by another name if it needs one. Different symbols stay different.
class SafeNames {
public:
    explicit SafeNames(const Module& module);
    [[nodiscard]] const std::string& of(SymbolId symbol) const { return names_.at(symbol); }

private:
    std::vector<std::string> names_;
};

/// "step(int)" for "_Z4stepi"; empty if that is no C++ name.
[[nodiscard]] std::string demangled(const std::string& name);

}  // namespace toolchain::codegen
