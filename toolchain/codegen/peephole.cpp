// peephole.cpp - see peephole.hpp.
#include "toolchain/codegen/peephole.hpp"

#include <map>
#include <set>

#include "toolchain/codegen/coder.hpp"
#include "toolchain/isa/instruction_set.hpp"

namespace toolchain::codegen {

namespace {

using Items = std::vector<CodeItem>;
using ItemKind = CodeItem::Kind;

bool is_instruction(const CodeItem& item) {
    return item.kind == ItemKind::instruction;
}

bool jumps_to_label(const CodeItem& item) {
    return is_instruction(item) && item.operand.kind == CodeOperand::Kind::label &&
           isa::instruction(item.opcode).flow == isa::Flow::jump;
}

/// Control does not go on behind it.
bool ends_flow(const CodeItem& item) {
    if (!is_instruction(item)) return false;
    const isa::Instruction& instruction = isa::instruction(item.opcode);
    const bool leaves = instruction.flow == isa::Flow::jump || instruction.flow == isa::Flow::ret ||
                        instruction.flow == isa::Flow::jump_hl;
    return leaves && !instruction.conditional();
}

std::map<uint32_t, std::size_t> label_places(const Items& items) {
    std::map<uint32_t, std::size_t> places;
    for (std::size_t i = 0; i < items.size(); ++i) {
        if (items[i].kind == ItemKind::label) places[items[i].operand.id] = i;
    }
    return places;
}

std::size_t next_instruction(const Items& items, std::size_t at) {
    while (at < items.size() && items[at].kind != ItemKind::instruction &&
           items[at].kind != ItemKind::word) {
        ++at;
    }
    return at;
}

bool thread_jumps(Items& items) {
    const std::map<uint32_t, std::size_t> places = label_places(items);
    bool changed = false;
    for (CodeItem& item : items) {
        const bool word = item.kind == ItemKind::word;
        if (!jumps_to_label(item) && !word) continue;
        const std::size_t at = next_instruction(items, places.at(item.operand.id));
        if (at >= items.size() || items[at].kind == ItemKind::word) continue;
        const CodeItem& target = items[at];
        if (target.opcode == op::kJmp && jumps_to_label(target) &&
            target.operand.id != item.operand.id) {
            item.operand.id = target.operand.id;
            changed = true;
        } else if (target.opcode == op::kRet && !word && !op::asks_k(item.opcode)) {
            // Jcc to RET is Rcc: the same condition bits with other low bits.
            item.opcode =
                item.opcode == op::kJmp ? op::kRet : static_cast<uint8_t>((item.opcode & 0xF8));
            item.operand = {};
            changed = true;
        }
    }
    return changed;
}

bool drop_unreached(Items& items) {
    Items kept;
    bool reached = true;
    for (const CodeItem& item : items) {
        if (item.kind == ItemKind::label || item.kind == ItemKind::word) reached = true;
        if (item.kind == ItemKind::loop_bound || reached) kept.push_back(item);
        if (ends_flow(item)) reached = false;
    }
    const bool changed = kept.size() != items.size();
    items = std::move(kept);
    return changed;
}

bool drop_labels(Items& items) {
    std::set<uint32_t> used;
    for (const CodeItem& item : items) {
        if (item.kind != ItemKind::label && item.operand.kind == CodeOperand::Kind::label) {
            used.insert(item.operand.id);
        }
    }
    return std::erase_if(items, [&](const CodeItem& item) {
               return item.kind == ItemKind::label && !used.contains(item.operand.id);
           }) != 0;
}

// A jump over nothing; a jump over a jump or a return.
bool drop_jumps(Items& items) {
    for (std::size_t i = 0; i < items.size(); ++i) {
        if (!jumps_to_label(items[i])) continue;
        const std::size_t target = label_places(items).at(items[i].operand.id);
        if (target > i && next_instruction(items, i + 1) >= target) {
            items.erase(items.begin() + static_cast<std::ptrdiff_t>(i));
            return true;
        }
        const std::size_t next = i + 1;
        const bool over = next < items.size() && items[i].opcode != op::kJmp &&
                          items[next].opcode == op::kJmp && jumps_to_label(items[next]) &&
                          target > next && next_instruction(items, next + 1) >= target;
        if (over) {
            items[i].opcode = op::inverted(items[i].opcode);
            items[i].operand = items[next].operand;
            items.erase(items.begin() + static_cast<std::ptrdiff_t>(next));
            return true;
        }
        const bool over_return = next < items.size() && items[i].opcode != op::kJmp &&
                                 !op::asks_k(items[i].opcode) && is_instruction(items[next]) &&
                                 items[next].opcode == op::kRet && target > next &&
                                 next_instruction(items, next + 1) >= target;
        if (over_return) {  // Jcc and Rcc differ in their low bits
            items[i].opcode = static_cast<uint8_t>((items[i].opcode ^ 0x08) & 0xF8);
            items[i].operand = {};
            items.erase(items.begin() + static_cast<std::ptrdiff_t>(next));
            return true;
        }
    }
    return false;
}

bool reads_flags(uint8_t opcode) {
    const isa::Instruction& instruction = isa::instruction(opcode);
    if (instruction.conditional()) return true;
    const unsigned group = opcode & 0xF8;
    const bool with_carry = group == 0x88 || group == 0x98 || opcode == 0xCE || opcode == 0xDE;
    return with_carry || opcode == op::kRal || opcode == op::kRar || opcode == op::kCmc ||
           opcode == 0x27 || opcode == op::kPushPsw;
}

bool flags_dead_behind(const Items& items, std::size_t at) {
    constexpr uint8_t kAll = isa::flag::kCarry | isa::flag::kZero | isa::flag::kSign;
    for (std::size_t i = at + 1; i < items.size(); ++i) {
        if (items[i].kind == ItemKind::word) return true;
        if (!is_instruction(items[i])) continue;
        if (reads_flags(items[i].opcode)) return false;
        const isa::Instruction& instruction = isa::instruction(items[i].opcode);
        if ((instruction.flags & kAll) == kAll) return true;
        if (instruction.flow != isa::Flow::next) return true;
    }
    return true;
}

void shorten(Items& items) {
    constexpr uint8_t kMviA = 0x3E;
    constexpr uint8_t kXraA = 0xAF;
    for (std::size_t i = 0; i < items.size(); ++i) {
        const bool zero = is_instruction(items[i]) && items[i].opcode == kMviA &&
                          items[i].operand.kind == CodeOperand::Kind::number &&
                          items[i].operand.offset == 0;
        if (!zero || !flags_dead_behind(items, i)) continue;
        items[i].opcode = kXraA;
        items[i].operand = {};
    }
}

}  // namespace

void improve(Items& items) {
    for (bool changed = true; changed;) {
        changed = thread_jumps(items);
        changed = drop_unreached(items) || changed;
        changed = drop_jumps(items) || changed;
        changed = drop_labels(items) || changed;
    }
    shorten(items);
}

}  // namespace toolchain::codegen
