// names.cpp - see names.hpp.
#include "tools/debug/names.hpp"

#include <fmt/format.h>

#include "toolchain/isa/disassemble.hpp"
#include "tools/debug/arguments.hpp"

namespace debug_console {

using host_sim::Symbol;

namespace {

constexpr std::string_view kNameless = "-";

bool contains(std::string_view text, std::string_view part) {
    for (std::size_t i = 0; i + part.size() <= text.size(); ++i) {
        if (same_word(text.substr(i, part.size()), part)) return true;
    }
    return false;
}

}  // namespace

std::optional<uint16_t> Names::find(std::string_view name) const {
    if (name == kNameless || name.empty()) return std::nullopt;
    if (const Symbol* symbol = symbols_.find(name)) return symbol->address;
    std::optional<uint16_t> found;
    for (const Symbol& symbol : symbols_.all()) {
        if (symbol.name.find('(') != name.size() || !symbol.name.starts_with(name)) continue;
        if (found) return std::nullopt;
        found = symbol.address;
    }
    return found;
}

std::vector<std::string> Names::at(uint16_t address) const {
    std::vector<std::string> list;
    for (const Symbol& symbol : symbols_.all()) {
        if (symbol.address == address && symbol.name != kNameless) list.push_back(symbol.name);
    }
    return list;
}

std::string Names::address_text(uint16_t address) const {
    const std::string name = near(address);
    const std::string number = toolchain::isa::intel_hex(address, 4);
    return name.empty() ? number : number + " " + name;
}

std::string Names::source_text(uint16_t address) const {
    const Symbol* symbol = symbols_.source_at(address);
    return symbol == nullptr ? std::string()
                             : fmt::format("{}:{}", symbol->source, symbol->source_line);
}

std::vector<Symbol> Names::containing(std::string_view part) const {
    std::vector<Symbol> list;
    for (const Symbol& symbol : symbols_.all()) {
        if (symbol.name != kNameless && contains(symbol.name, part)) list.push_back(symbol);
    }
    return list;
}

}  // namespace debug_console
