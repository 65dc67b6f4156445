// code_flow.cpp - see code_flow.hpp.
#include "toolchain/codegen/code_flow.hpp"

#include <algorithm>

#include "toolchain/codegen/coder.hpp"
#include "toolchain/isa/instruction_set.hpp"

namespace toolchain::codegen {

bool is_instruction(const CodeItem& item) {
    return item.kind == CodeItem::Kind::instruction;
}

bool can_be_followed(const std::vector<CodeItem>& items) {
    return std::none_of(items.begin(), items.end(), [](const CodeItem& item) {
        return is_instruction(item) && (item.opcode == op::kPchl || (item.opcode & 0xC7) == 0xC7);
    });
}

std::vector<Exits> find_exits(const std::vector<CodeItem>& items) {
    std::vector<Exits> exits(items.size());
    for (std::size_t i = 0; i < items.size(); ++i) {
        const CodeItem& item = items[i];
        if (item.kind == CodeItem::Kind::word) exits[i].falls = false;
        if (!is_instruction(item)) continue;
        const isa::Instruction& instruction = isa::instruction(item.opcode);
        if (instruction.flow == isa::Flow::jump) {
            exits[i].falls = instruction.conditional();
            if (item.operand.kind == CodeOperand::Kind::label) {
                exits[i].labels.push_back(item.operand.id);
                continue;
            }
            // To the routine for tables: the words behind it.
            for (std::size_t at = i + 1; at < items.size() && !is_instruction(items[at]); ++at) {
                if (items[at].kind == CodeItem::Kind::word) {
                    exits[i].labels.push_back(items[at].operand.id);
                }
            }
        } else if (instruction.flow == isa::Flow::ret) {
            exits[i].falls = instruction.conditional();
            exits[i].leaves = true;
        }
    }
    return exits;
}

namespace {

void step_back(Live& live, const CodeItem& item, const SlotAccess& access) {
    const Effects effects = effects_of(item);
    live.registers &= static_cast<ResourceSet>(~effects.writes);
    live.registers |= effects.reads;
    if (access.writes && access.known()) {
        for (uint32_t i = 0; i < access.size; ++i) live.slots.reset(access.first + i);
    }
    if (!access.reads) return;
    if (!access.known()) {
        live.slots.set();
        return;
    }
    for (uint32_t i = 0; i < access.size; ++i) live.slots.set(access.first + i);
}

}  // namespace

std::vector<Live> find_live(const std::vector<CodeItem>& items, const std::vector<Exits>& exits,
                            const std::vector<SlotAccess>& accesses, ResourceSet at_return) {
    std::vector<Live> behind(items.size());
    std::map<uint32_t, Live> at_label;
    for (bool again = true; again;) {
        again = false;
        Live next;
        for (std::size_t i = items.size(); i-- > 0;) {
            Live live;
            if (exits[i].falls) live = next;
            if (exits[i].leaves) live.registers |= at_return;
            for (const uint32_t label : exits[i].labels) live.add(at_label[label]);
            behind[i] = live;
            if (is_instruction(items[i])) step_back(live, items[i], accesses[i]);
            if (items[i].kind == CodeItem::Kind::label) {
                Live& known = at_label[items[i].operand.id];
                if (!(known == live)) {
                    known = live;
                    again = true;
                }
            }
            next = live;
        }
    }
    return behind;
}

namespace {

using namespace resource;

bool holds_slot(const CodeItem& item) {
    return item.operand.kind == CodeOperand::Kind::frame && (item.opcode & 0xCF) == op::kLxi;
}

// `pushed`: an address of a slot may be on the stack.
ResourceSet step_pointers(ResourceSet held, const CodeItem& item, bool& pushed) {
    const Effects effects = effects_of(item);
    const uint8_t opcode = item.opcode;
    const auto exchanged = [&] {
        const auto de = static_cast<ResourceSet>(held & kDe);
        const auto hl = static_cast<ResourceSet>(held & kHl);
        return static_cast<ResourceSet>((held & ~(kDe | kHl)) | hl >> 2 | de << 2);
    };
    if (opcode == op::kXchg) return exchanged();
    const bool push = (opcode & 0xCF) == op::kPush;
    if (push && (held & effects.reads) != 0) pushed = true;
    const bool pop = (opcode & 0xCF) == op::kPop;
    bool taken = holds_slot(item) || (pop && pushed);
    const bool computes = effects.pure && !holds_slot(item);
    if (computes && (effects.reads & held) != 0) taken = true;
    const auto written = static_cast<ResourceSet>(effects.writes & ~kFlags);
    return static_cast<ResourceSet>(taken ? held | written : held & ~written);
}

}  // namespace

std::vector<ResourceSet> find_slot_pointers(const std::vector<CodeItem>& items,
                                            const std::vector<Exits>& exits) {
    std::vector<ResourceSet> before(items.size(), 0);
    std::map<uint32_t, ResourceSet> at_label;
    bool pushed = false;
    for (bool again = true; again;) {
        again = false;
        ResourceSet held = 0;
        for (std::size_t i = 0; i < items.size(); ++i) {
            if (items[i].kind == CodeItem::Kind::label) held |= at_label[items[i].operand.id];
            before[i] = held;
            if (is_instruction(items[i])) {
                const bool was_pushed = pushed;
                held = step_pointers(held, items[i], pushed);
                again = again || was_pushed != pushed;
            }
            for (const uint32_t label : exits[i].labels) {
                ResourceSet& known = at_label[label];
                if ((held & ~known) != 0) {
                    known |= held;
                    again = true;
                }
            }
            if (!exits[i].falls) held = 0;
        }
    }
    return before;
}

}  // namespace toolchain::codegen
