// known_values.cpp - see known_values.hpp.
#include "toolchain/codegen/known_values.hpp"

#include "toolchain/codegen/coder.hpp"
#include "toolchain/isa/instruction_set.hpp"

namespace toolchain::codegen {

namespace {

using Kind = ValueInfo::Kind;
constexpr unsigned kMemory = 6, kAccumulator = 7;

unsigned high_number(unsigned pair) {
    return 2 * pair;
}
unsigned low_number(unsigned pair) {
    return 2 * pair + 1;
}

}  // namespace

KnownValues::KnownValues(const std::vector<CodeItem>& items, const std::vector<Exits>& exits,
                         uint32_t frame_bytes)
    : infos_(1), frame_bytes_(frame_bytes) {
    for (std::size_t i = 0; i < items.size(); ++i) {
        for (const uint32_t label : exits[i].labels) ++expected_[label];
    }
    forget_all();
}

void KnownValues::forget_all() {
    for (ValueNumber& value : state.registers) value = fresh();
    state.slots.resize(frame_bytes_);
    for (ValueNumber& value : state.slots) value = fresh();
    state.tested = 0;
    state.pushed.clear();
}

ValueNumber KnownValues::fresh() {
    infos_.push_back({});
    return static_cast<ValueNumber>(infos_.size() - 1);
}

ValueNumber KnownValues::number_of(const ValueInfo& info) {
    const auto [at, added] = numbers_.try_emplace(info, static_cast<ValueNumber>(infos_.size()));
    if (added) infos_.push_back(info);
    return at->second;
}

ValueNumber KnownValues::loaded(const CodeOperand& operand, CodeOperand::Part part) {
    const bool high = part == CodeOperand::Part::high;
    switch (operand.kind) {
        case CodeOperand::Kind::number:
            return number_of({Kind::constant, 0, operand.offset >> (high ? 8 : 0) & 0xFF});
        case CodeOperand::Kind::symbol:
            return number_of(
                {high ? Kind::symbol_high : Kind::symbol_low, operand.id, operand.offset});
        case CodeOperand::Kind::frame:
            return number_of({high ? Kind::slot_high : Kind::slot_low, 0, operand.offset});
        default:
            return fresh();
    }
}

std::optional<int32_t> KnownValues::constant_in(Register which) const {
    const ValueInfo& known = info(in(which));
    if (known.kind != Kind::constant) return std::nullopt;
    return known.number;
}

std::optional<uint32_t> KnownValues::slot_at(unsigned pair) const {
    const ValueInfo& high = info(state.registers[high_number(pair)]);
    const ValueInfo& low = info(state.registers[low_number(pair)]);
    const bool slot = high.kind == Kind::slot_high && low.kind == Kind::slot_low;
    if (!slot || high.number != low.number || low.number < 0) return std::nullopt;
    return static_cast<uint32_t>(low.number);
}

SlotAccess KnownValues::access(const CodeItem& item, ResourceSet pointers) const {
    SlotAccess access;
    if (!is_instruction(item)) return access;
    const Effects effects = effects_of(item);
    if (effects.memory == MemoryAccess::none) return access;
    access.reads = effects.memory != MemoryAccess::write;
    access.writes = effects.memory != MemoryAccess::read;
    access.size = effects.size;
    if (effects.pointer == 0xFF) {
        if (item.operand.kind == CodeOperand::Kind::frame) {
            access.first = static_cast<uint32_t>(item.operand.offset);
        }
    } else if (const auto slot = slot_at(effects.pointer)) {
        access.first = *slot;
    } else if ((pointers & 3U << 2 * effects.pointer) != 0) {
        access.first = SlotAccess::kAnywhere;
    }
    if (access.known() && access.first + access.size > frame_bytes_) {
        access.first = SlotAccess::kAnywhere;
    }
    if (access.first == SlotAccess::kNowhere) access.reads = access.writes = false;
    return access;
}

std::optional<Register> KnownValues::find(ValueNumber value, ResourceSet but) const {
    for (const Register which : kRegisters) {
        if ((but & set_of(which)) == 0 && in(which) == value) return which;
    }
    return std::nullopt;
}

void KnownValues::set(unsigned which, ValueNumber value) {
    state.registers[which] = value;
}

// -- Labels --------------------------------------------------------------------------------------

void KnownValues::arrive(uint32_t label) {
    --expected_[label];
    const auto [known, first] = arrived_.try_emplace(label, state);
    if (first) return;
    State& met = known->second;
    const auto meet = [&](ValueNumber& one, ValueNumber other) {
        if (one != other) one = fresh();
    };
    for (unsigned i = 0; i < met.registers.size(); ++i) {
        meet(met.registers[i], state.registers[i]);
    }
    for (std::size_t i = 0; i < met.slots.size(); ++i) meet(met.slots[i], state.slots[i]);
    if (met.tested != state.tested) met.tested = 0;
    if (met.pushed != state.pushed) met.pushed.clear();
}

void KnownValues::enter(uint32_t label) {
    const auto expected = expected_.find(label);
    if (expected == expected_.end()) {
        if (!reached_) forget_all();  // of a table
        return;
    }
    if (reached_) {
        ++expected->second;
        arrive(label);
    }
    reached_ = true;
    if (expected->second != 0) return forget_all();  // a loop
    state = arrived_.at(label);
}

void KnownValues::step(const CodeItem& item, const Exits& exits, const SlotAccess& access) {
    if (item.kind == CodeItem::Kind::label) return enter(item.operand.id);
    if (!is_instruction(item)) return;
    step_instruction(item, access);
    for (const uint32_t label : exits.labels) arrive(label);
    if (!exits.falls) reached_ = false;
}

// -- Instructions --------------------------------------------------------------------------------

ValueNumber KnownValues::moved(ValueNumber low, ValueNumber high, int32_t by, bool of_high) {
    const ValueInfo first = info(low);
    const ValueInfo second = info(high);
    if (first.kind == Kind::constant && second.kind == Kind::constant) {
        const int32_t sum = first.number + 256 * second.number + by;
        return number_of({Kind::constant, 0, sum >> (of_high ? 8 : 0) & 0xFF});
    }
    const bool slot = first.kind == Kind::slot_low && second.kind == Kind::slot_high;
    const bool symbol = first.kind == Kind::symbol_low && second.kind == Kind::symbol_high;
    const bool same = first.symbol == second.symbol && first.number == second.number;
    if ((slot || symbol) && same) {
        const Kind kind = of_high ? second.kind : first.kind;
        return number_of({kind, first.symbol, first.number + by});
    }
    return fresh();
}

// INX, DCX, INR, DCR.
bool KnownValues::step_count(const CodeItem& item) {
    const unsigned pair = item.opcode >> 4 & 3U;
    const unsigned low_four = item.opcode & 0x0FU;
    if (item.opcode >= 0x40) return false;
    if (low_four == 3 || low_four == 0x0B) {
        const ValueNumber low = state.registers[low_number(pair)];
        const ValueNumber high = state.registers[high_number(pair)];
        const int32_t by = low_four == 3 ? 1 : -1;
        set(low_number(pair), moved(low, high, by, false));
        set(high_number(pair), moved(low, high, by, true));
        return true;
    }
    const unsigned which = item.opcode >> 3 & 7U;
    const bool counts = (item.opcode & 7U) == 4 || (item.opcode & 7U) == 5;
    if (!counts || which == kMemory) return false;
    const auto before = constant_in(static_cast<Register>(which));
    const int32_t by = (item.opcode & 7U) == 4 ? 1 : -1;
    set(which, before ? number_of({Kind::constant, 0, (*before + by) & 0xFF}) : fresh());
    state.tested = state.registers[which];
    return true;
}

// What copies bytes without computing.
bool KnownValues::step_move(const CodeItem& item, const SlotAccess& access) {
    const uint8_t opcode = item.opcode;
    const unsigned to = opcode >> 3 & 7U;
    const unsigned from = opcode & 7U;
    const auto slot = [&](uint32_t i) -> ValueNumber& { return state.slots[access.first + i]; };
    if (opcode >= 0x40 && opcode < 0x80 && opcode != op::kHlt) {
        if (from == kMemory) {
            set(to, access.known() ? slot(0) : fresh());
        } else if (to == kMemory) {
            if (access.known()) slot(0) = state.registers[from];
        } else {
            set(to, state.registers[from]);
        }
        return true;
    }
    if ((opcode & 0xCF) == op::kLxi) {
        const unsigned pair = opcode >> 4 & 3U;
        if (pair == 3) return false;
        set(low_number(pair), loaded(item.operand, CodeOperand::Part::low));
        set(high_number(pair), loaded(item.operand, CodeOperand::Part::high));
        return true;
    }
    if ((opcode & 0xC7) == op::kMvi) {
        const ValueNumber value = loaded(item.operand, item.operand.part);
        if (to != kMemory) {
            set(to, value);
        } else if (access.known()) {
            slot(0) = value;
        }
        return true;
    }
    switch (opcode) {
        case op::kLda:
            set(kAccumulator, access.known() ? slot(0) : fresh());
            return true;
        case op::kSta:
            if (access.known()) slot(0) = state.registers[kAccumulator];
            return true;
        case op::kLhld:
            set(low_number(2), access.known() ? slot(0) : fresh());
            set(high_number(2), access.known() ? slot(1) : fresh());
            return true;
        case op::kShld:
            if (!access.known()) return true;
            slot(0) = state.registers[low_number(2)];
            slot(1) = state.registers[high_number(2)];
            return true;
        case op::kXchg:
            std::swap(state.registers[2], state.registers[4]);
            std::swap(state.registers[3], state.registers[5]);
            return true;
        default:
            return false;
    }
}

void KnownValues::step_instruction(const CodeItem& item, const SlotAccess& access) {
    if (access.writes && !access.known()) {
        for (ValueNumber& value : state.slots) value = fresh();
    }
    if (step_move(item, access) || step_count(item)) return;
    const Effects effects = effects_of(item);
    if (access.writes && access.known()) {  // INR M, STAX
        for (uint32_t i = 0; i < access.size; ++i) state.slots[access.first + i] = fresh();
    }
    const unsigned pair = item.opcode >> 4 & 3U;
    const auto tested = state.tested;
    if ((item.opcode & 0xCF) == op::kPush) {
        const std::array<ValueNumber, 2> values =
            pair == 3
                ? std::array{state.registers[kAccumulator], tested}
                : std::array{state.registers[high_number(pair)], state.registers[low_number(pair)]};
        state.pushed.push_back(values);
        return;
    }
    if ((item.opcode & 0xCF) == op::kPop) {
        std::array<ValueNumber, 2> values{fresh(), pair == 3 ? 0 : fresh()};
        if (!state.pushed.empty()) {
            values = state.pushed.back();
            state.pushed.pop_back();
        }
        set(pair == 3 ? kAccumulator : high_number(pair), values[0]);
        if (pair == 3) {
            state.tested = values[1];
        } else {
            set(low_number(pair), values[1]);
        }
        return;
    }
    for (const Register which : kRegisters) {
        if ((effects.writes & set_of(which)) != 0) set(static_cast<unsigned>(which), fresh());
    }
    if ((effects.writes & resource::kSign) == 0) return;
    state.tested = 0;
    const bool arithmetic = (item.opcode & 0xC0) == 0x80 || (item.opcode & 0xC7) == 0xC6;
    const unsigned operation = item.opcode >> 3 & 7U;
    if (!arithmetic || operation == alu::kCmp) return;
    const bool zero = item.opcode == 0xAF || item.opcode == 0x97;  // XRA A, SUB A
    if (zero) set(kAccumulator, number_of({Kind::constant, 0, 0}));
    state.tested = state.registers[kAccumulator];
}

}  // namespace toolchain::codegen
