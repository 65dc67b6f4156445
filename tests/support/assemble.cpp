// assemble.cpp - one source as a program in flat memory, by toolchain/asm.
#include "tests/support/assemble.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "toolchain/asm/link.hpp"
#include "toolchain/asm/parse.hpp"

namespace test_support {
namespace {

using namespace toolchain::assembly;

/// Puts sections behind each other, as memory that is loaded as a whole.
void flatten(Module& module) {
    uint32_t end = 0;
    for (Section& section : module.sections) {
        section.kind = SectionKind::code;
        const uint32_t step = section.alignment;
        const uint32_t address = section.address.value_or((end + step - 1) / step * step);
        section.address = static_cast<uint16_t>(address);
        end = address + static_cast<uint32_t>(section_size(section));
    }
}

Assembled collect(const Program& program, const Module& module) {
    Assembled result;
    uint32_t first = 0;
    uint32_t end = 0;
    for (const PlacedSection& placed : program.sections) {
        if (placed.size == 0) continue;
        if (end == 0) first = placed.address;
        end = std::max(end, placed.address + placed.size);
    }
    result.origin = static_cast<uint16_t>(first);
    for (uint32_t address = first; address < end; ++address) {
        const bool present = program.image.present[address];
        result.bytes.push_back(present ? program.image.bytes[address] : uint8_t{0});
    }
    for (const Symbol& symbol : program.symbols) {
        if (symbol.section) result.symbols.emplace(symbol.name, symbol.value);
    }
    for (const Equate& equate : module.equates) {
        result.symbols.emplace(equate.name, program.find(equate.name)->value);
    }
    return result;
}

}  // namespace

AssembleError::AssembleError(std::size_t line, const std::string& reason)
    : std::runtime_error(fmt::format("line {}: {}", line, reason)), line_(line) {}

Assembled assemble(std::string_view source) {
    try {
        Module module = parse(source, {"source", uint16_t{0}});
        flatten(module);
        return collect(link({module}), module);
    } catch (const Error& error) {
        const Diagnostic& first = error.diagnostics().front();
        throw AssembleError(first.line, first.text);
    }
}

}  // namespace test_support
