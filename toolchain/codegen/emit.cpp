// emit.cpp - see emit.hpp.
#include "toolchain/codegen/emit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <utility>

#include "toolchain/codegen/abi.hpp"
#include "toolchain/codegen/overlay.hpp"

namespace toolchain::codegen {

namespace {

using assembly::Item;
using assembly::Location;
using assembly::Operand;
using assembly::Section;
using assembly::SectionKind;

Location location_of(uint32_t file, uint32_t line) {
    return file == kNone ? Location{} : Location{file, line};
}

std::string local_label(uint32_t id) {
    return fmt::format(".{}", id);
}

Operand operand_of(const CodeOperand& operand, const SafeNames& names,
                   const std::string& function) {
    Operand result;
    result.offset = operand.offset;
    result.part = operand.part == CodeOperand::Part::low    ? assembly::Part::low
                  : operand.part == CodeOperand::Part::high ? assembly::Part::high
                                                            : assembly::Part::word;
    switch (operand.kind) {
        case CodeOperand::Kind::none:
        case CodeOperand::Kind::number:
            break;
        case CodeOperand::Kind::symbol:
            result.symbol = names.of(operand.id);
            break;
        case CodeOperand::Kind::frame:
            result.symbol = frame_label(function);
            break;
        case CodeOperand::Kind::label:
            result.symbol = local_label(operand.id);
            break;
    }
    return result;
}

/// Initial bytes as items; neighbours that are a whole address become a word.
std::vector<Item> initial_items(const SafeNames& names, const Variable& variable) {
    std::vector<Item> items;
    std::vector<uint8_t> plain;
    const auto flush = [&] {
        if (!plain.empty()) items.push_back(assembly::data_bytes(std::exchange(plain, {})));
    };
    const std::vector<Datum>& data = variable.initial;
    for (std::size_t i = 0; i < data.size(); ++i) {
        const Datum& datum = data[i];
        if (datum.symbol == kNone) {
            plain.push_back(datum.value);
            continue;
        }
        flush();
        Operand operand{names.of(datum.symbol), datum.offset,
                        datum.high ? assembly::Part::high : assembly::Part::low};
        const bool is_word = !datum.high && i + 1 < data.size() && data[i + 1].high &&
                             data[i + 1].symbol == datum.symbol &&
                             data[i + 1].offset == datum.offset;
        if (is_word) {
            operand.part = assembly::Part::word;
            items.push_back(assembly::data_word(operand));
            ++i;
        } else {
            items.push_back(assembly::data_byte(operand));
        }
    }
    flush();
    return items;
}

bool is_zero(const Variable& variable) {
    return std::ranges::all_of(variable.initial, [](const Datum& datum) {
        return datum.symbol == kNone && datum.value == 0;
    });
}

}  // namespace

std::string frame_label(const std::string& function) {
    return function + "@frame";
}

Section code_section(const Module& module, const SafeNames& names, const Function& function,
                     const FunctionCode& code) {
    Section section;
    section.name = section.function = names.of(function.symbol);
    section.title = demangled(module.symbols[function.symbol]);
    const auto first = std::ranges::find_if(
        code.items, [](const CodeItem& item) { return item.file != kNone && item.line != 0; });
    if (first != code.items.end()) section.location = location_of(first->file, first->line);
    if (function.address_taken) section.alignment = function.alignment;
    section.items.push_back(
        assembly::label(section.name, assembly::LabelKind::automatic, 0, section.location));
    for (const CodeItem& item : code.items) {
        const Location location = location_of(item.file, item.line);
        const Operand operand = operand_of(item.operand, names, section.name);
        switch (item.kind) {
            case CodeItem::Kind::instruction:
                section.items.push_back(assembly::instruction(item.opcode, operand, location));
                break;
            case CodeItem::Kind::label:
                section.items.push_back(assembly::label(local_label(item.operand.id),
                                                        assembly::LabelKind::label, 0, location));
                break;
            case CodeItem::Kind::word:
                section.items.push_back(assembly::data_word(operand, location));
                break;
            case CodeItem::Kind::loop_bound:
                section.items.push_back(
                    assembly::note(fmt::format("loop {}", item.operand.offset), location));
                break;
        }
    }
    return section;
}

FrameLayout frame_layout(const Function& function, const FunctionCode& code) {
    FrameLayout layout;
    for (const FrameObject& object : function.frame) layout.objects.push_back(&object);
    std::ranges::stable_sort(layout.objects, std::greater{}, &FrameObject::alignment);
    for (const FrameObject* object : layout.objects) {
        layout.alignment = std::max(layout.alignment, object->alignment);
        layout.offsets.push_back(aligned(layout.size, object->alignment));
        layout.size = layout.offsets.back() + object->size;
    }
    layout.size += code.frame_bytes;
    return layout;
}

Section frame_section(const SafeNames& names, const Function& function, const FunctionCode& code) {
    Section section;
    section.function = names.of(function.symbol);
    section.name = frame_label(section.function);
    section.kind = SectionKind::frame;
    const FrameLayout layout = frame_layout(function, code);
    section.alignment = layout.alignment;
    uint32_t end = 0;
    for (std::size_t i = 0; i < layout.objects.size(); ++i) {
        const FrameObject& object = *layout.objects[i];
        if (layout.offsets[i] != end) {
            section.items.push_back(assembly::space(layout.offsets[i] - end));
        }
        section.items.push_back(
            assembly::label(names.of(object.symbol), assembly::LabelKind::data, object.size));
        section.items.push_back(assembly::space(object.size));
        end = layout.offsets[i] + object.size;
    }
    if (code.frame_bytes != 0) {
        section.items.push_back(
            assembly::label(section.name, assembly::LabelKind::data, code.frame_bytes));
        section.items.push_back(assembly::space(code.frame_bytes));
    }
    return section;
}

Section variable_section(const Module& module, const SafeNames& names, const Variable& variable) {
    Section section;
    const std::string& original = module.symbols[variable.symbol];
    section.name = names.of(variable.symbol);
    section.title = demangled(original);
    section.alignment = variable.alignment;
    section.items.push_back(
        assembly::label(section.name, assembly::LabelKind::data, variable.size));
    // What calls write before it is read needs no clearing.
    if (is_shared_name(original)) {
        section.kind = SectionKind::persistent;
    } else if (variable.is_constant) {
        section.kind = SectionKind::constant;
    } else {
        section.kind = is_zero(variable) ? SectionKind::zero : SectionKind::initialised;
    }
    if (section.kind == SectionKind::zero || section.kind == SectionKind::persistent) {
        section.items.push_back(assembly::space(variable.size));
        return section;
    }
    std::vector<Item> items = initial_items(names, variable);
    std::size_t size = 0;
    for (const Item& item : items) size += assembly::item_size(item);
    section.items.insert(section.items.end(), items.begin(), items.end());
    if (size < variable.size) {
        section.items.push_back(assembly::space(variable.size - static_cast<uint32_t>(size)));
    }
    return section;
}

}  // namespace toolchain::codegen
