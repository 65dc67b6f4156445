// placement.cpp - see placement.hpp.
#include "tools/budget/placement.hpp"

#include <algorithm>
#include <map>

#include "firmware/config/eeprom_layout.hpp"

namespace rover_budget {
namespace {

/// What people call a section: its function's title, its variable's C++ name, else its own.
class Titles {
public:
    Titles(const ImageMap& map, const host_sim::Symbols& symbols) : symbols_(symbols) {
        for (const MapFunction& function : map.functions) {
            functions_.emplace(function.address, function.name);
        }
    }
    [[nodiscard]] std::string of(const MapSection& section) const {
        if (section.kind == "code") {
            const auto found = functions_.find(section.first);
            if (found != functions_.end()) return found->second;
        }
        const host_sim::Symbol* symbol = symbols_.at(static_cast<uint16_t>(section.first));
        const bool exact = symbol != nullptr && symbol->address == section.first &&
                           symbol->kind == host_sim::SymbolKind::data;
        return exact ? symbol->name : section.name;
    }

private:
    const host_sim::Symbols& symbols_;
    std::map<uint32_t, std::string> functions_;
};

}  // namespace

Placement place(const ImageMap& map, const host_sim::Symbols& symbols, const ModuleTable& table) {
    Placement placement;
    placement.module_of.assign(host_sim::kAddressSpaceSize, static_cast<uint16_t>(table.other()));
    placement.bytes.resize(table.modules().size());
    const Titles titles(map, symbols);
    for (const MapSection& section : map.sections) {
        if (section.is_frame()) continue;
        const std::string title = titles.of(section);
        const std::size_t module = table.of(title);
        if (module == table.other()) placement.unmapped.push_back(title);
        ModuleBytes& bytes = placement.bytes[module];
        (section.in_rom() ? bytes.rom : bytes.ram) += section.size;
        if (section.kind == "initialised") bytes.rom += section.size;
        const uint32_t end =
            std::min<uint32_t>(section.first + section.size, host_sim::kAddressSpaceSize);
        for (uint32_t at = section.first; at < end; ++at) {
            placement.module_of[at] = static_cast<uint16_t>(module);
        }
    }
    // The loader in front of the image has symbols, and its bytes are its own.
    for (const host_sim::Symbol& symbol : symbols.all()) {
        const bool is_loader = symbol.name.starts_with("loader start: ");
        if (!is_loader || symbol.address >= rover::loader::kApplicationFirst ||
            symbol.kind == host_sim::SymbolKind::label) {
            continue;
        }
        const auto module = static_cast<uint16_t>(table.of(symbol.name));
        std::fill_n(placement.module_of.begin() + symbol.address, symbol.size, module);
    }
    for (const MapFunction& function : map.functions) {
        ModuleBytes& bytes = placement.bytes[placement.module_of[function.address & 0xFFFF]];
        bytes.stack = std::max(bytes.stack, function.stack_bytes.value_or(0));
    }
    return placement;
}

}  // namespace rover_budget
