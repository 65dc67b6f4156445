// routine_stack.cpp - see routine_stack.hpp.
#include "toolchain/codegen/routine_stack.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <stdexcept>
#include <utility>
#include <vector>

#include "toolchain/isa/instruction_set.hpp"

namespace toolchain::codegen {

namespace {

using assembly::Item;
using assembly::ItemKind;
using assembly::Section;

constexpr uint32_t kAddress = 2;
constexpr uint32_t kOpen = UINT32_MAX;  ///< a routine whose depth is being found

bool is_push(uint8_t opcode) {
    return (opcode & 0xCF) == 0xC5;
}
bool is_pop(uint8_t opcode) {
    return (opcode & 0xCF) == 0xC1;
}

}  // namespace

RoutineStack::RoutineStack(std::span<const assembly::Module> modules) {
    for (const assembly::Module& module : modules) {
        for (const Section& section : module.sections) {
            if (section.kind != assembly::SectionKind::code) continue;
            for (std::size_t i = 0; i < section.items.size(); ++i) {
                const Item& item = section.items[i];
                if (item.kind != ItemKind::label || assembly::is_local(item.operand.symbol)) {
                    continue;
                }
                labels_[item.operand.symbol] = {&section, i};
            }
        }
    }
}

uint32_t RoutineStack::of(const std::string& label) {
    const auto place = labels_.find(label);
    if (place == labels_.end()) return 0;
    const auto [entry, is_new] = known_.try_emplace(label, kOpen);
    if (!is_new) {
        if (entry->second == kOpen) throw std::logic_error(label + " calls itself");
        return entry->second;
    }
    const uint32_t depth = follow(place->second);
    known_[label] = depth;
    return depth;
}

RoutineStack::Place RoutineStack::place_of(const Section& section, const std::string& label) const {
    if (!assembly::is_local(label)) {
        const auto found = labels_.find(label);
        return found == labels_.end() ? Place{} : found->second;
    }
    for (std::size_t i = 0; i < section.items.size(); ++i) {
        const Item& item = section.items[i];
        if (item.kind == ItemKind::label && item.operand.symbol == label) return {&section, i};
    }
    return {};
}

// Every pair of place and depth once.
uint32_t RoutineStack::follow(const Place& start) {
    struct Way {
        Place place;
        uint32_t depth;
    };
    uint32_t most = 0;
    std::vector<Way> open = {{start, 0}};
    std::set<std::pair<const Item*, uint32_t>> seen;
    const auto go = [&](const Section& from, const std::string& label, uint32_t depth) {
        const Place target = place_of(from, label);
        if (target.section == nullptr) throw std::logic_error("no label " + label);
        open.push_back({target, depth});
    };
    while (!open.empty()) {
        auto [place, depth] = open.back();
        open.pop_back();
        const Section& section = *place.section;
        for (std::size_t i = place.item; i < section.items.size(); ++i) {
            const Item& item = section.items[i];
            if (item.kind != ItemKind::instruction) continue;
            if (!seen.insert({&item, depth}).second) break;
            const isa::Instruction& instruction = isa::instruction(item.opcode);
            const std::string target = item.operand.symbol;
            if (is_push(item.opcode)) depth += kAddress;
            if (is_pop(item.opcode)) {
                if (depth < kAddress) throw std::logic_error(section.name + " pops too much");
                depth -= kAddress;
            }
            most = std::max(most, depth);
            if (instruction.flow == isa::Flow::call) {
                most = std::max(most, depth + kAddress + of(target));
            } else if (instruction.flow == isa::Flow::jump) {
                go(section, target, depth);
            }
            const bool goes_on = instruction.flow == isa::Flow::next ||
                                 instruction.flow == isa::Flow::call || instruction.conditional();
            if (!goes_on) break;
        }
    }
    return most;
}

}  // namespace toolchain::codegen
