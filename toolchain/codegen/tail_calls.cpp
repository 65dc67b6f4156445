// tail_calls.cpp - see tail_calls.hpp.
#include "toolchain/codegen/tail_calls.hpp"

#include <map>

#include "toolchain/codegen/code_flow.hpp"
#include "toolchain/codegen/coder.hpp"
#include "toolchain/isa/instruction_set.hpp"

namespace toolchain::codegen {

namespace {

using Items = std::vector<CodeItem>;

bool leaves(const CodeItem& item) {
    return is_instruction(item) && (item.opcode == op::kRet || item.opcode == op::kJmp);
}

bool jumps_out(const CodeItem& item) {
    return is_instruction(item) && item.opcode == op::kJmp &&
           item.operand.kind == CodeOperand::Kind::symbol;
}

/// Past labels and remarks.
std::size_t next_instruction(const Items& items, std::size_t at) {
    while (at < items.size() && items[at].kind != CodeItem::Kind::instruction &&
           items[at].kind != CodeItem::Kind::word) {
        ++at;
    }
    return at;
}

bool is_return(const Items& items, std::size_t at) {
    return at < items.size() && is_instruction(items[at]) && items[at].opcode == op::kRet;
}

// Branches to a jump out of the function go out themselves.
void branch_out(Items& items) {
    std::map<uint32_t, std::size_t> places;
    for (std::size_t i = 0; i < items.size(); ++i) {
        if (items[i].kind == CodeItem::Kind::label) places[items[i].operand.id] = i;
    }
    std::map<uint32_t, uint32_t> uses;
    for (CodeItem& item : items) {
        if (item.kind == CodeItem::Kind::label) continue;
        if (item.operand.kind != CodeOperand::Kind::label) continue;
        const std::size_t at = next_instruction(items, places.at(item.operand.id));
        const bool out = is_instruction(item) && at < items.size() && jumps_out(items[at]);
        if (out)
            item.operand = items[at].operand;
        else
            ++uses[item.operand.id];
    }
    Items kept;
    bool reached = true;
    for (const CodeItem& item : items) {
        const bool label = item.kind == CodeItem::Kind::label;
        if (label && uses[item.operand.id] == 0) continue;
        reached = reached || label || item.kind == CodeItem::Kind::word;
        if (reached) kept.push_back(item);
        if (leaves(item)) reached = false;
    }
    items = std::move(kept);
}

}  // namespace

void jump_to_last_calls(Items& items, uint32_t indirect) {
    bool changed = false;
    for (std::size_t i = 0; i < items.size(); ++i) {
        const bool calls = is_instruction(items[i]) && items[i].opcode == op::kCall &&
                           items[i].operand.kind == CodeOperand::Kind::symbol &&
                           items[i].operand.id != indirect;
        if (!calls || !is_return(items, next_instruction(items, i + 1))) continue;
        items[i].opcode = op::kJmp;
        changed = true;
    }
    if (changed) branch_out(items);
}

}  // namespace toolchain::codegen
