// short_forms.cpp - see short_forms.hpp.
#include "toolchain/codegen/short_forms.hpp"

#include "toolchain/codegen/code_flow.hpp"
#include "toolchain/codegen/coder.hpp"
#include "toolchain/isa/instruction_set.hpp"

namespace toolchain::codegen {

namespace {

using namespace resource;

constexpr uint8_t kXraA = 0xAF, kAddA = 0x87, kRrc = 0x0F, kAni = 0xE6;
constexpr unsigned kMemory = 6;

class ShortForms {
public:
    ShortForms(std::vector<CodeItem>& items, RegisterSet at_return)
        : items_(items),
          live_(find_live(items, find_exits(items), std::vector<SlotAccess>(items.size()),
                          of(at_return))),
          dropped_(items.size(), false) {}

    void run() {
        for (std::size_t i = 0; i < items_.size(); ++i) {
            if (dropped_[i] || !is_instruction(items_[i])) continue;
            clear_a(i);
            operate_on_memory(i);
            test_bit(i);
        }
        std::size_t kept = 0;
        for (std::size_t i = 0; i < items_.size(); ++i) {
            if (!dropped_[i]) items_[kept++] = items_[i];
        }
        items_.resize(kept);
    }

private:
    [[nodiscard]] bool dead(std::size_t behind, ResourceSet which) const {
        return (live_[behind].registers & which) == 0;
    }
    [[nodiscard]] static bool is_number(const CodeItem& item, int32_t value) {
        return item.operand.kind == CodeOperand::Kind::number &&
               (item.operand.offset & 0xFF) == value;
    }
    void become(std::size_t at, uint8_t opcode) {
        items_[at].opcode = opcode;
        items_[at].operand = {};
    }

    // MVI A,0 is XRA A if nobody wants the flags.
    void clear_a(std::size_t at) {
        const bool clears =
            items_[at].opcode == by_register(op::kMvi, Register::a) && is_number(items_[at], 0);
        if (clears && dead(at, kFlags)) become(at, kXraA);
    }

    // MOV r,M; ADD r is ADD M if nobody wants r. A move to A may stand between.
    void operate_on_memory(std::size_t at) {
        const uint8_t load = items_[at].opcode;
        const unsigned to = load >> 3 & 7U;
        if (load < 0x40 || load >= 0x80 || (load & 7U) != kMemory) return;
        if (to == kMemory || to == 7) return;
        std::size_t next = at + 1;
        if (next < items_.size() && moves_to_a(items_[next], to)) ++next;
        if (next >= items_.size() || !is_instruction(items_[next])) return;
        const uint8_t opcode = items_[next].opcode;
        const bool uses = opcode >= 0x80 && opcode < 0xC0 && (opcode & 7U) == to;
        if (!uses || !dead(next, of(to))) return;
        items_[next].opcode = static_cast<uint8_t>((opcode & 0xF8U) | kMemory);
        dropped_[at] = true;
    }

    static bool moves_to_a(const CodeItem& item, unsigned but) {
        const unsigned from = item.opcode & 7U;
        return is_instruction(item) && (item.opcode & 0xF8) == 0x78 && from != kMemory &&
               from != but;
    }

    // A bit at an end of A that a branch asks for: by rotating or doubling it.
    void test_bit(std::size_t at) {
        if (items_[at].opcode != kAni || items_[at].operand.kind != CodeOperand::Kind::number) {
            return;
        }
        const std::size_t next = at + 1;
        if (next >= items_.size() || !is_instruction(items_[next])) return;
        const isa::Instruction& branch = isa::instruction(items_[next].opcode);
        const bool conditional =
            (branch.flow == isa::Flow::jump || branch.flow == isa::Flow::ret) &&
            branch.conditional();
        const unsigned condition = items_[next].opcode >> 3 & 7U;  // NZ Z NC C PO PE P M
        if (!conditional || condition > 1 || !dead(next, kA | kFlags)) return;
        const bool is_zero = condition == 1;
        if (is_number(items_[at], 0x01)) {
            become(at, kRrc);
            ask(next, is_zero ? 2 : 3);
        } else if (is_number(items_[at], 0x40)) {
            become(at, kAddA);
            ask(next, is_zero ? 6 : 7);
        }
    }

    void ask(std::size_t branch, unsigned condition) {
        items_[branch].opcode =
            static_cast<uint8_t>((items_[branch].opcode & 0xC7U) | condition << 3);
    }

    std::vector<CodeItem>& items_;
    std::vector<Live> live_;
    std::vector<bool> dropped_;
};

}  // namespace

void take_short_forms(std::vector<CodeItem>& items, RegisterSet at_return) {
    if (can_be_followed(items)) ShortForms(items, at_return).run();
}

}  // namespace toolchain::codegen
