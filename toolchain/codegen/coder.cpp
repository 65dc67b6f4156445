// coder.cpp - bookkeeping and single instructions; coder_moves.cpp has what moves values.
#include "toolchain/codegen/coder.hpp"

#include <algorithm>

#include "toolchain/isa/instruction_set.hpp"

namespace toolchain::codegen {

bool Contract::in_slot(ByteId byte) const {
    return !std::binary_search(not_in_slot.begin(), not_in_slot.end(), byte);
}

void Coder::emit(uint8_t opcode, CodeOperand operand) {
    const isa::Instruction& instruction = isa::instruction(opcode);
    cost += instruction.t_not_taken + byte_cost_ * instruction.bytes;
    if ((instruction.flags & (isa::flag::kZero | isa::flag::kSign)) != 0) state.tested = kNone;
    if ((instruction.flags & isa::flag::kCarry) != 0) {
        state.sign_in_carry = kNone;
        state.carry_of = kNone;
    }
    if ((instruction.flags & isa::flag::kK) != 0) state.zero_in_k = {kNone, kNone};
    ++emitted;
    if (only_cost) return;
    CodeItem item;
    item.opcode = opcode;
    item.operand = operand;
    items.push_back(item);
}

void Coder::emit_number(uint8_t opcode, int32_t number) {
    emit(opcode, {CodeOperand::Kind::number, CodeOperand::Part::word, 0, number});
}

void Coder::emit_jump(uint8_t opcode, uint32_t label, double taken) {
    const isa::Instruction& instruction = isa::instruction(opcode);
    emit(opcode, {CodeOperand::Kind::label, CodeOperand::Part::word, label, 0});
    jumps = true;
    cost += taken * (instruction.t_taken - instruction.t_not_taken);
}

void Coder::emit_label(uint32_t label) {
    if (only_cost) return;
    CodeItem item;
    item.kind = CodeItem::Kind::label;
    item.operand = {CodeOperand::Kind::label, CodeOperand::Part::word, label, 0};
    items.push_back(item);
}

bool Coder::holds(Register which, ByteId byte) const {
    return content(which) == byte || facts_->undefined(byte);
}

Register Coder::find(ByteId byte, RegisterSet among) const {
    if ((among & set_of(Register::a)) != 0 && content(Register::a) == byte) return Register::a;
    for (const Register which : kRegisters) {
        if ((among & set_of(which)) != 0 && content(which) == byte) return which;
    }
    return Register::flags;
}

bool Coder::in_slot(ByteId byte) const {
    if (!facts_->computed(byte)) return false;
    const uint32_t at = block_->local.find(byte);
    return at != kNone && state.in_slot.test(at);
}

uint32_t Coder::next_use(ByteId byte) const {
    const uint32_t at = block_->local.find(byte);
    if (at == kNone) return kNone;
    for (const uint32_t use : block_->uses[at]) {
        if (use >= position) return use;
    }
    return kNone;
}

bool Coder::needed(ByteId byte, bool after) const {
    if (byte == kNone || !facts_->computed(byte)) return false;
    const uint32_t at = block_->local.find(byte);
    if (at == kNone) return false;
    if (edge_needs != nullptr) return (*edge_needs)[at] != 0;
    const uint32_t last = block_->last_use[at];
    if (last == kNone) return false;
    return after ? last > position : last >= position;
}

bool Coder::only_copy(Register which, bool after, RegisterSet lost) const {
    const ByteId byte = content(which);
    if (!needed(byte, after) || in_slot(byte)) return false;
    return find(byte, static_cast<RegisterSet>(~(set_of(which) | lost | doomed))) ==
           Register::flags;
}

bool Coder::complete() const {
    for (uint32_t number = 0; number < block_->relevant.size(); ++number) {
        const uint32_t last = block_->last_use[number];
        if (last == kNone || last <= position || block_->made[number] > position + 1) continue;
        if (!state.in_slot.test(number) && find(block_->relevant[number]) == Register::flags) {
            return false;
        }
    }
    return true;
}

Base Coder::sum_in(Pair pair) const {
    const Base& base = state.sum[static_cast<unsigned>(pair)];
    if (base.known()) return base;
    const ByteId low = content(low_of(pair));
    const ByteId high = content(high_of(pair));
    if (low == kNone || high == kNone) return {};
    return facts_->base_of(low, high);
}

void Coder::set(Register which, ByteId byte) {
    if (byte != kNone && facts_->undefined(byte)) byte = kNone;
    state.content[static_cast<unsigned>(which)] = byte;
    doomed &= static_cast<RegisterSet>(~set_of(which));
    if (which != Register::a) state.sum[static_cast<unsigned>(which) / 2] = {};
}

void Coder::set_sum(Pair pair, const Base& base) {
    set(pair, kNone, kNone);
    state.sum[static_cast<unsigned>(pair)] = base;
}

void Coder::forget(RegisterSet which) {
    for (const Register one : kRegisters) {
        if ((which & set_of(one)) != 0) set(one, kNone);
    }
    if ((which & set_of(Register::flags)) == 0) return;
    state.tested = state.sign_in_carry = state.carry_of = kNone;
    state.zero_in_k = {kNone, kNone};
}

void Coder::leave_carry() {
    if (block_->carry_until[position] != 0) state.carry_of = position;
}

CodeOperand Coder::slot(ByteId byte) const {
    return {CodeOperand::Kind::frame, CodeOperand::Part::word, facts_->variable[byte],
            static_cast<int32_t>(facts_->index[byte])};
}

// What else was in that place is gone.
void Coder::mark_stored(ByteId byte) {
    const uint32_t at = block_->local.find(byte);
    if (at == kNone) return;
    for (const uint32_t other : block_->same_place[at]) state.in_slot.reset(other);
    state.in_slot.set(at);
}

void Coder::alu(unsigned operation, ByteId byte) {
    const auto opcode = static_cast<uint8_t>(0x80 | operation << 3);
    const Register from = find(byte);
    state.tested = kNone;
    if (facts_->undefined(byte)) {
        emit(static_cast<uint8_t>(opcode | static_cast<unsigned>(Register::a)));
    } else if (from != Register::flags) {
        emit(static_cast<uint8_t>(opcode | static_cast<unsigned>(from)));
    } else if (constant(byte)) {
        const ByteInfo& info = facts_->function.bytes[byte];
        CodeOperand operand{CodeOperand::Kind::number, CodeOperand::Part::word, 0, info.constant};
        if (info.kind != ByteInfo::Kind::constant) {
            operand = {CodeOperand::Kind::symbol,
                       info.kind == ByteInfo::Kind::address_low ? CodeOperand::Part::low
                                                                : CodeOperand::Part::high,
                       info.symbol, info.offset};
        }
        emit(static_cast<uint8_t>(op::kAluImmediate | operation << 3), operand);
    } else if (in_slot(byte)) {
        const bool usable = !locked(Pair::hl);
        if (usable) {
            point_to_slot(byte);
            emit(static_cast<uint8_t>(opcode | 6));
        } else {
            emit(by_pair(op::kPush, Pair::hl));
            emit(by_pair(op::kLxi, Pair::hl), slot(byte));
            emit(static_cast<uint8_t>(opcode | 6));
            emit(by_pair(op::kPop, Pair::hl));
        }
    } else {
        failed = true;
    }
}

}  // namespace toolchain::codegen
