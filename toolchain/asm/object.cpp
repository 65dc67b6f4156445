// object.cpp - see object.hpp.
#include "toolchain/asm/object.hpp"

#include <fmt/format.h>

#include <utility>

#include "toolchain/isa/instruction_set.hpp"

namespace toolchain::assembly {
namespace {

Item make(ItemKind kind, Location location) {
    Item item;
    item.kind = kind;
    item.location = location;
    return item;
}

std::string all_messages(std::span<const Diagnostic> diagnostics) {
    std::string text;
    for (const Diagnostic& diagnostic : diagnostics) {
        if (!text.empty()) text += '\n';
        text += diagnostic.message();
    }
    return text;
}

}  // namespace

Item instruction(uint8_t opcode, Operand operand, Location location) {
    Item item = make(ItemKind::instruction, location);
    item.opcode = opcode;
    item.operand = std::move(operand);
    return item;
}

Item label(std::string name, LabelKind kind, uint32_t size, Location location) {
    Item item = make(ItemKind::label, location);
    item.operand.symbol = std::move(name);
    item.label_kind = kind;
    item.size = size;
    return item;
}

Item data_bytes(std::vector<uint8_t> bytes, Location location) {
    Item item = make(ItemKind::bytes, location);
    item.bytes = std::move(bytes);
    return item;
}

Item data_byte(Operand operand, Location location) {
    Item item = make(ItemKind::byte, location);
    item.operand = std::move(operand);
    return item;
}

Item data_word(Operand operand, Location location) {
    Item item = make(ItemKind::word, location);
    item.operand = std::move(operand);
    return item;
}

Item space(uint32_t size, Location location) {
    Item item = make(ItemKind::space, location);
    item.size = size;
    return item;
}

Item note(std::string text, Location location) {
    Item item = make(ItemKind::note, location);
    item.text = std::move(text);
    return item;
}

std::string_view kind_name(SectionKind kind) {
    switch (kind) {
        case SectionKind::code:
            return "code";
        case SectionKind::constant:
            return "constant";
        case SectionKind::initialised:
            return "initialised";
        case SectionKind::zero:
            return "zero";
        case SectionKind::persistent:
            return "persistent";
        case SectionKind::frame:
            return "frame";
    }
    throw std::invalid_argument("kind_name: no such kind");
}

std::size_t item_size(const Item& item) {
    switch (item.kind) {
        case ItemKind::instruction:
            return isa::instruction(item.opcode).bytes;
        case ItemKind::bytes:
            return item.bytes.size();
        case ItemKind::byte:
            return 1;
        case ItemKind::word:
            return 2;
        case ItemKind::space:
            return item.size;
        case ItemKind::label:
        case ItemKind::note:
            return 0;
    }
    throw std::invalid_argument("item_size: no such kind");
}

std::size_t section_size(const Section& section) {
    std::size_t size = 0;
    for (const Item& item : section.items) size += item_size(item);
    return size;
}

std::string_view reference_of(const Item& item) {
    if (item.kind == ItemKind::label) return {};
    return item.operand.symbol;
}

std::string Diagnostic::message() const {
    if (line != 0) return fmt::format("{}:{}: {}", file, line, text);
    return file.empty() ? text : fmt::format("{}: {}", file, text);
}

Error::Error(std::vector<Diagnostic> diagnostics)
    : std::runtime_error(all_messages(diagnostics)), diagnostics_(std::move(diagnostics)) {}

}  // namespace toolchain::assembly
