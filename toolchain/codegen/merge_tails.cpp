// merge_tails.cpp - see merge_tails.hpp.
#include "toolchain/codegen/merge_tails.hpp"

#include <map>
#include <optional>

#include "toolchain/codegen/code_flow.hpp"
#include "toolchain/codegen/coder.hpp"
#include "toolchain/isa/instruction_set.hpp"

namespace toolchain::codegen {

namespace {

using Items = std::vector<CodeItem>;

/// Where a way ends: in front of a JMP, a RET or a label.
struct End {
    std::size_t at = 0;
    bool jumps = false;  ///< to the label, or returns: the item there is part of it
};

/// The last instructions of `dropped` are those of `kept` too.
struct Tail {
    End kept{};
    End dropped{};
    std::size_t kept_from = 0;
    std::size_t dropped_from = 0;
    uint32_t saved = 0;
};

constexpr uint32_t kReturn = UINT32_MAX;  ///< in place of a label
constexpr uint32_t kJumpBytes = 3;

bool goes_to(const CodeItem& item, uint32_t& label) {
    if (!is_instruction(item)) return false;
    if (item.opcode == op::kRet) {
        label = kReturn;
        return true;
    }
    label = item.operand.id;
    return item.opcode == op::kJmp && item.operand.kind == CodeOperand::Kind::label;
}

bool ends_flow(const CodeItem& item) {
    uint32_t label = 0;
    return goes_to(item, label) || item.kind == CodeItem::Kind::word ||
           (is_instruction(item) && item.opcode == op::kJmp);
}

std::map<uint32_t, std::vector<End>> find_ends(const Items& items) {
    std::map<uint32_t, std::vector<End>> ends;
    for (std::size_t i = 0; i < items.size(); ++i) {
        uint32_t label = 0;
        if (goes_to(items[i], label)) ends[label].push_back({i, true});
        const bool falls_in =
            items[i].kind == CodeItem::Kind::label && i > 0 && !ends_flow(items[i - 1]);
        if (falls_in) ends[items[i].operand.id].push_back({i, false});
    }
    return ends;
}

bool equal(const CodeItem& one, const CodeItem& other) {
    return one.opcode == other.opcode && one.operand == other.operand;
}

// What is pushed within a tail is popped within it: its stack is counted in the order of items.
std::optional<Tail> compare(const Items& items, const End& kept, const End& dropped) {
    std::optional<Tail> best;
    uint32_t bytes = 0;
    int depth = 0;
    std::size_t i = kept.at;
    std::size_t j = dropped.at;
    while (i > 0 && j > 0) {
        const bool skip =
            !is_instruction(items[i - 1]) && items[i - 1].kind == CodeItem::Kind::label;
        if (skip) {
            --i;
            continue;
        }
        --i;
        --j;
        if (!is_instruction(items[i]) || !is_instruction(items[j])) break;
        if (ends_flow(items[i]) || !equal(items[i], items[j])) break;
        const bool apart = kept.at < dropped.at ? j > kept.at : i > dropped.at;
        if (!apart) break;
        bytes += isa::instruction(items[i].opcode).bytes;
        if ((items[i].opcode & 0xCF) == op::kPop) ++depth;
        if ((items[i].opcode & 0xCF) == op::kPush) --depth;
        if (depth < 0) break;
        if (depth == 0) best = Tail{kept, dropped, i, j, bytes};
    }
    return best;
}

std::optional<Tail> best_tail(const Items& items) {
    std::optional<Tail> best;
    for (const auto& [label, ends] : find_ends(items)) {
        for (const End& kept : ends) {
            for (const End& dropped : ends) {
                if (!dropped.jumps || kept.at == dropped.at) continue;
                std::optional<Tail> tail = compare(items, kept, dropped);
                if (!tail) continue;
                if (label == kReturn) {
                    const uint32_t lost = kJumpBytes - 1;
                    if (tail->saved < lost + kWorthAJump) continue;
                    tail->saved -= lost;
                }
                if (!best || tail->saved > best->saved) best = tail;
            }
        }
    }
    return best;
}

void apply(Items& items, const Tail& tail, uint32_t label) {
    const CodeOperand operand{CodeOperand::Kind::label, CodeOperand::Part::word, label, 0};
    CodeItem there;
    there.kind = CodeItem::Kind::label;
    there.operand = operand;
    CodeItem jump;
    jump.opcode = op::kJmp;
    jump.operand = operand;
    jump.file = items[tail.dropped.at].file;
    jump.line = items[tail.dropped.at].line;
    Items result;
    for (std::size_t i = 0; i < items.size(); ++i) {
        if (i == tail.kept_from) result.push_back(there);
        if (i == tail.dropped.at) result.push_back(jump);
        const bool gone = i >= tail.dropped_from && i <= tail.dropped.at;
        if (!gone) result.push_back(items[i]);
    }
    items = std::move(result);
}

}  // namespace

void merge_tails(std::vector<CodeItem>& items, uint32_t& next_label) {
    while (const std::optional<Tail> tail = best_tail(items)) apply(items, *tail, next_label++);
}

}  // namespace toolchain::codegen
