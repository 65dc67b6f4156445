// encode.cpp - see encode.hpp.
#include "toolchain/asm/encode.hpp"

#include <fmt/format.h>

namespace toolchain::assembly {
namespace {

int32_t value_of(const Operand& operand, std::size_t section, const SymbolValues& values) {
    int32_t value = operand.offset;
    if (!operand.symbol.empty()) {
        const auto symbol = values.find(operand.symbol, section);
        if (!symbol) throw Mistake("'" + operand.symbol + "' is not defined");
        value += *symbol;
    }
    if (value < -32768 || value > 65535) {
        throw Mistake(fmt::format("'{}' is beyond 16 bits", operand_text(operand)));
    }
    const auto word = static_cast<uint16_t>(value);
    if (operand.part == Part::low) return word & 0xFF;
    if (operand.part == Part::high) return word >> 8;
    return value;
}

uint8_t byte_of(const Operand& operand, int32_t value) {
    if (value < -128 || value > 255) {
        throw Mistake(fmt::format("'{}' is {:04X}H, beyond 8 bits", operand_text(operand),
                                  static_cast<uint16_t>(value)));
    }
    return static_cast<uint8_t>(value);
}

}  // namespace

SymbolValues::SymbolValues(const Program& program) : local_(program.sections.size()) {
    for (const Symbol& symbol : program.symbols) {
        if (!is_local(symbol.name)) {
            global_.emplace(symbol.name, symbol.value);
        } else if (symbol.section) {
            local_[*symbol.section].emplace(symbol.name, symbol.value);
        }
    }
}

std::optional<uint16_t> SymbolValues::find(const std::string& name, std::size_t section) const {
    const auto& names = is_local(name) ? local_.at(section) : global_;
    const auto found = names.find(name);
    if (found == names.end()) return {};
    return found->second;
}

std::string operand_text(const Operand& operand) {
    std::string text = operand.symbol.empty() ? "" : symbol_text(operand.symbol);
    if (text.empty()) {
        text = fmt::format("{}", operand.offset);
    } else if (operand.offset != 0) {
        text += fmt::format("{:+}", operand.offset);
    }
    if (operand.part == Part::low) return "LOW(" + text + ")";
    if (operand.part == Part::high) return "HIGH(" + text + ")";
    return text;
}

std::vector<uint8_t> encode(const Item& item, std::size_t section, const SymbolValues& values) {
    switch (item.kind) {
        case ItemKind::label:
        case ItemKind::note:
            return {};
        case ItemKind::bytes:
            return item.bytes;
        case ItemKind::space:
            return std::vector<uint8_t>(item.size);
        default:
            break;
    }
    std::vector<uint8_t> bytes;
    const std::size_t size = item_size(item);
    if (item.kind == ItemKind::instruction) bytes.push_back(item.opcode);
    if (bytes.size() == size) return bytes;
    const int32_t value = value_of(item.operand, section, values);
    if (size - bytes.size() == 1) {
        bytes.push_back(byte_of(item.operand, value));
    } else {
        bytes.push_back(static_cast<uint8_t>(value));
        bytes.push_back(static_cast<uint8_t>(value >> 8));
    }
    return bytes;
}

}  // namespace toolchain::assembly
