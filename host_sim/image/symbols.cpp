// symbols.cpp - the tables by address and by name.
#include "host_sim/image/symbols.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace host_sim {

Symbols::Symbols(std::vector<Symbol> symbols, std::string_view file)
    : symbols_(std::move(symbols)), owner_(kAddressSpaceSize, -1), line_(kAddressSpaceSize, -1) {
    std::ranges::stable_sort(symbols_, {}, &Symbol::address);
    for (std::size_t i = 0; i < symbols_.size(); ++i) {
        const Symbol& symbol = symbols_[i];
        if (symbol.address + symbol.size > kAddressSpaceSize) {
            throw ImageError(file, symbol.file_line,
                             fmt::format("'{}' goes beyond FFFFH", symbol.name),
                             "correct its address or size");
        }
        if (symbol.name == "-") continue;
        const auto [place, added] = by_name_.emplace(symbol.name, i);
        if (!added) {
            throw ImageError(file, symbol.file_line,
                             fmt::format("'{}' is named again, first at line {}", symbol.name,
                                         symbols_[place->second].file_line),
                             "give each symbol its own name");
        }
    }
    occupy(file);
}

/// A symbol without size goes on to the next address that has a symbol of its own kind or above.
std::size_t Symbols::end_of(std::size_t index) const {
    const Symbol& symbol = symbols_[index];
    if (symbol.size != 0) return symbol.address + symbol.size;
    for (std::size_t i = index + 1; i < symbols_.size(); ++i) {
        const bool counts =
            symbol.kind == SymbolKind::label || symbols_[i].kind != SymbolKind::label;
        if (counts && symbols_[i].address > symbol.address) return symbols_[i].address;
    }
    return kAddressSpaceSize;
}

void Symbols::occupy(std::string_view file) {
    for (const bool labels : {true, false}) {  // functions and data win over labels
        for (std::size_t i = 0; i < symbols_.size(); ++i) {
            const Symbol& symbol = symbols_[i];
            if ((symbol.kind == SymbolKind::label) != labels || symbol.name == "-") continue;
            const std::size_t end = end_of(i);
            for (std::size_t address = symbol.address; address < end; ++address) {
                const Symbol* other = get(owner_[address]);
                if (!labels && other != nullptr && other->kind != SymbolKind::label) {
                    throw ImageError(
                        file, symbol.file_line,
                        fmt::format("'{}' and '{}' of line {} share address {:04X}H", symbol.name,
                                    other->name, other->file_line, address),
                        "correct their addresses or sizes");
                }
                owner_[address] = static_cast<int32_t>(i);
            }
        }
    }
    // A smaller range lies inside of a larger one: statements in their function.
    std::vector<std::size_t> with_line;
    for (std::size_t i = 0; i < symbols_.size(); ++i) {
        if (symbols_[i].source_line != 0) with_line.push_back(i);
    }
    std::ranges::stable_sort(with_line, std::ranges::greater{},
                             [this](std::size_t i) { return end_of(i) - symbols_[i].address; });
    for (const std::size_t i : with_line) {
        const std::size_t end = end_of(i);
        for (std::size_t address = symbols_[i].address; address < end; ++address) {
            line_[address] = static_cast<int32_t>(i);
        }
    }
}

const Symbol* Symbols::find(std::string_view name) const {
    const auto found = by_name_.find(name);
    return found == by_name_.end() ? nullptr : &symbols_[found->second];
}

const Symbol* Symbols::function_at(uint16_t address) const {
    const Symbol* symbol = at(address);
    return symbol != nullptr && symbol->is_function() ? symbol : nullptr;
}

std::string Symbols::describe(uint16_t address) const {
    const Symbol* symbol = at(address);
    if (symbol == nullptr) return {};
    if (symbol->address == address) return symbol->name;
    return fmt::format("{}+{}", symbol->name, address - symbol->address);
}

}  // namespace host_sim
