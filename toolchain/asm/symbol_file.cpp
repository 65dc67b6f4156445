// symbol_file.cpp - see symbol_file.hpp.
#include "toolchain/asm/symbol_file.hpp"

#include <fmt/format.h>

#include <iterator>
#include <map>

namespace toolchain::assembly {
namespace {

char kind_letter(const Symbol& symbol, const Program& program) {
    if (program.sections[*symbol.section].section.kind == SectionKind::frame) return 'L';
    switch (symbol.kind) {
        case LabelKind::function:
            return 'F';
        case LabelKind::interrupt_entry:
            return 'I';
        case LabelKind::data:
            return 'D';
        default:
            return 'L';
    }
}

/// The title of a section is the name of what it begins with.
std::string shown_name(const Symbol& symbol, const Program& program) {
    const PlacedSection& placed = program.sections[*symbol.section];
    const bool titled = symbol.value == placed.address && !placed.section.title.empty() &&
                        symbol.kind != LabelKind::label;
    return titled ? placed.section.title : symbol.name;
}

std::string source_of(const Program& program, Location location) {
    if (!location.known() || location.file >= program.files.size()) return {};
    return fmt::format(" @ {}:{}", program.files[location.file], location.line);
}

void add_source_lines(std::string& out, const Program& program, const PlacedSection& placed) {
    uint32_t address = placed.address;
    uint32_t first = address;
    Location current{};
    const auto flush = [&] {
        const std::string source = source_of(program, current);
        if (address != first && !source.empty()) {
            out += fmt::format("{:04X} {:04X} L -{}\n", first, address - first, source);
        }
        first = address;
    };
    for (const Item& item : placed.section.items) {
        if (item.kind == ItemKind::instruction && item.location != current) {
            flush();
            current = item.location;
        }
        address += static_cast<uint32_t>(item_size(item));
    }
    flush();
}

}  // namespace

std::string symbol_file(const Program& program) {
    std::map<std::string, int> uses;
    const auto listed = [](const Symbol& symbol) {
        return symbol.section && !is_local(symbol.name);
    };
    for (const Symbol& symbol : program.symbols) {
        if (!listed(symbol)) continue;
        ++uses[symbol.name];
        const std::string shown = shown_name(symbol, program);
        if (shown != symbol.name) ++uses[shown];
    }
    std::string out;
    for (const Symbol& symbol : program.symbols) {
        if (!listed(symbol)) continue;
        const std::string shown = shown_name(symbol, program);
        const Section& section = program.sections[*symbol.section].section;
        const Location location = symbol.location.known() ? symbol.location : section.location;
        fmt::format_to(std::back_inserter(out), "{:04X} {:04X} {} {}{}\n", symbol.value,
                       symbol.size, kind_letter(symbol, program),
                       uses[shown] == 1 ? shown : symbol.name, source_of(program, location));
    }
    for (const PlacedSection& placed : program.sections) {
        if (placed.section.kind == SectionKind::code) add_source_lines(out, program, placed);
    }
    return out;
}

}  // namespace toolchain::assembly
