// mir.cpp - symbols of a module, and lookups.
#include "toolchain/codegen/mir.hpp"

namespace toolchain::codegen {

SymbolId Module::intern(const std::string& name) {
    const auto [entry, added] = symbol_ids.try_emplace(name, static_cast<SymbolId>(symbols.size()));
    if (added) symbols.push_back(name);
    return entry->second;
}

const Function* Module::find(SymbolId symbol) const {
    for (const Function& function : functions) {
        if (function.symbol == symbol) return &function;
    }
    return nullptr;
}

}  // namespace toolchain::codegen
