// print.cpp - see print.hpp.
#include "toolchain/asm/print.hpp"

#include <fmt/format.h>

#include <iterator>

#include "toolchain/asm/encode.hpp"
#include "toolchain/asm/source_lines.hpp"
#include "toolchain/isa/disassemble.hpp"
#include "toolchain/isa/instruction_set.hpp"

namespace toolchain::assembly {
namespace {

/// Numbers in hexadecimal, as wide as the place they go to.
std::string sized_operand(const Operand& operand, std::size_t bytes) {
    if (!operand.symbol.empty()) return operand_text(operand);
    if (operand.part != Part::word) return operand_text(operand);
    return bytes == 1 ? isa::intel_hex(static_cast<uint8_t>(operand.offset), 2)
                      : isa::intel_hex(static_cast<uint16_t>(operand.offset), 4);
}

std::string instruction_text(const Item& item) {
    const isa::Instruction& entry = isa::instruction(item.opcode);
    if (entry.operands().empty()) return std::string(entry.mnemonic());
    std::string operands(entry.operands());
    if (entry.operand != isa::Operand::none) {
        const std::size_t comma = operands.find(',');  // the placeholder comes last
        operands.resize(comma == std::string::npos ? 0 : comma + 1);
        operands += sized_operand(item.operand, entry.bytes - 1u);
    }
    return fmt::format("{:<5} {}", entry.mnemonic(), operands);
}

std::string section_line(const Section& section) {
    std::string text =
        fmt::format("SECTION {},{}", symbol_text(section.name), kind_name(section.kind));
    const auto out = std::back_inserter(text);
    if (section.address) fmt::format_to(out, ",AT {}", isa::intel_hex(*section.address, 4));
    if (section.alignment != 1) fmt::format_to(out, ",ALIGN {}", section.alignment);
    if (section.frame_offset != 0) fmt::format_to(out, ",OFFSET {}", section.frame_offset);
    if (!section.function.empty()) {
        fmt::format_to(out, ",FUNCTION {}", symbol_text(section.function));
    }
    if (!section.title.empty()) {
        std::string quoted;
        for (const char letter : section.title)
            quoted += letter == '\'' ? "''" : std::string{letter};
        fmt::format_to(out, ",TITLE '{}'", quoted);
    }
    return text + '\n';
}

}  // namespace

std::string item_text(const Item& item) {
    switch (item.kind) {
        case ItemKind::instruction:
            return instruction_text(item);
        case ItemKind::bytes: {
            std::string text;
            for (const uint8_t byte : item.bytes) {
                text += (text.empty() ? "DB    " : ",") + isa::intel_hex(byte, 2);
            }
            return text;
        }
        case ItemKind::byte:
            return "DB    " + sized_operand(item.operand, 1);
        case ItemKind::word:
            return "DW    " + sized_operand(item.operand, 2);
        case ItemKind::space:
            return fmt::format("DS    {}", item.size);
        case ItemKind::label:
        case ItemKind::note:
            break;
    }
    return {};
}

std::string source_text(const Module& module) {
    std::string text;
    for (const Section& section : module.sections) {
        text += section_line(section);
        for (const Item& item : section.items) {
            if (item.kind == ItemKind::label) {
                text += symbol_text(item.operand.symbol) + ":\n";
            } else if (item.kind == ItemKind::note) {
                text += "        ;@" + item.text + '\n';
            } else if (const std::string line = item_text(item); !line.empty()) {
                text += "        " + line + '\n';
            }
        }
    }
    for (const Equate& equate : module.equates) {
        text += symbol_text(equate.name) + " EQU " + operand_text(equate.value) + '\n';
    }
    return text;
}

}  // namespace toolchain::assembly
