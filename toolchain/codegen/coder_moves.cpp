// coder_moves.cpp - brings values into registers and slots; see coder.hpp.
#include <algorithm>
#include <cstdlib>

#include "toolchain/codegen/coder.hpp"

namespace toolchain::codegen {

namespace {

constexpr int32_t kNear = 3;  ///< INX and DCX instead of LXI or a new addition

Register partner(Register which) {
    return static_cast<Register>(static_cast<unsigned>(which) ^ 1U);
}

CodeOperand operand_of(const ByteInfo& info) {
    if (info.kind == ByteInfo::Kind::constant) {
        return {CodeOperand::Kind::number, CodeOperand::Part::word, 0, info.constant};
    }
    return {
        CodeOperand::Kind::symbol,
        info.kind == ByteInfo::Kind::address_low ? CodeOperand::Part::low : CodeOperand::Part::high,
        info.symbol, info.offset};
}

}  // namespace

bool Coder::free_now(Register which) const {
    return !locked(which) && (doomed & set_of(which)) == 0 && !needed(content(which), false);
}

Register Coder::free_register(ByteId byte, RegisterSet avoid) const {
    Register best = Register::flags;
    int best_score = -1;
    const uint32_t at = block_->local.find(byte);
    const RegisterSet wished = at == kNone ? RegisterSet{0} : wishes_->registers[at];
    for (const Register which : kRegisters) {
        if ((avoid & set_of(which)) != 0 || !free_now(which)) continue;
        int score = 0;
        if ((wished & set_of(which)) != 0) score += 8;
        if (which != Register::a) {
            score += 2;
            // A pair whose other half is in use already stays one of few.
            if (needed(content(partner(which)), false)) score += 2;
            if (which != Register::h && which != Register::l) score += 1;
        }
        if (score > best_score) {
            best = which;
            best_score = score;
        }
    }
    return best;
}

void Coder::vacate(Register which, bool after) {
    if (locked(which)) {
        failed = true;
        return;
    }
    doomed |= set_of(which);
    if (!only_copy(which, after)) return;
    const Register to = free_register(content(which), 0);
    if (to == Register::flags) {
        spill(which);
        return;
    }
    emit(mov(to, which));
    set(to, content(which));
}

void Coder::vacate(Pair pair, bool after) {
    const Register low = low_of(pair);
    const Register high = high_of(pair);
    if (locked(pair)) {
        failed = true;
        return;
    }
    const bool both = only_copy(low, after, set_of(pair)) && only_copy(high, after, set_of(pair));
    if (both && pair != Pair::bc) {
        const Pair other = pair == Pair::hl ? Pair::de : Pair::hl;
        if (free_now(low_of(other)) && free_now(high_of(other))) {
            emit(op::kXchg);
            std::swap(state.sum[1], state.sum[2]);
            std::swap(state.content[2], state.content[4]);
            std::swap(state.content[3], state.content[5]);
            doomed |= set_of(pair);
            return;
        }
        const bool room = free_now(Register::b) && free_now(Register::c);
        if (!room && edge_needs == nullptr && pair == Pair::hl &&
            facts_->adjacent(content(low), content(high))) {
            store(pair);
            doomed |= set_of(pair);
            return;
        }
    }
    copy_out(pair, after, after);
}

// Neither half may move into the other, and what the other half holds is no copy.
void Coder::copy_out(Pair pair, bool after_low, bool after_high) {
    doomed |= set_of(pair);
    vacate(low_of(pair), after_low);
    if (!failed) vacate(high_of(pair), after_high);
}

void Coder::save_from(RegisterSet destroyed) {
    const RegisterSet before = locks;
    locks |= destroyed;
    for (const Register which : kRegisters) {
        if ((destroyed & set_of(which)) == 0 || !only_copy(which, true, destroyed)) continue;
        const Register to = free_register(content(which), destroyed);
        if (to != Register::flags) {
            emit(mov(to, which));
            set(to, content(which));
            continue;
        }
        unlock(set_of(which));
        spill(which);
        locks |= set_of(which);
    }
    locks = before;
}

// -- Slots ---------------------------------------------------------------------------------------

void Coder::store(Register which) {
    const ByteId byte = content(which);
    if (which != Register::a) {
        failed = true;
        return;
    }
    emit(op::kSta, slot(byte));
    mark_stored(byte);
}

void Coder::store(Pair pair) {
    const ByteId low = content(low_of(pair));
    const ByteId high = content(high_of(pair));
    if (pair != Pair::hl || !facts_->adjacent(low, high)) {
        failed = true;
        return;
    }
    emit(op::kShld, slot(low));
    mark_stored(low);
    mark_stored(high);
}

// Whatever the registers are, there is a way: PUSH PSW keeps A and the flags.
void Coder::spill(Register which) {
    const ByteId byte = content(which);
    if (edge_needs != nullptr) {
        failed = true;  // the places belong to the target's values by now
        return;
    }
    if (which == Register::a) return store(Register::a);
    const auto pair = static_cast<Pair>(static_cast<unsigned>(which) / 2);
    const ByteId low = content(low_of(pair));
    const ByteId high = content(high_of(pair));
    const bool whole = low != kNone && high != kNone && facts_->adjacent(low, high) &&
                       needed(low, false) && needed(high, false);
    if (pair == Pair::hl && whole) return store(Pair::hl);
    if (pair == Pair::de && whole) {
        emit(op::kXchg);
        emit(op::kShld, slot(low));
        emit(op::kXchg);
        mark_stored(low);
        mark_stored(high);
        return;
    }
    if (free_now(Register::a) && !locked(Register::a)) {
        emit(mov(Register::a, which));
        set(Register::a, byte);
        store(Register::a);
        return;
    }
    emit(op::kPushPsw);
    emit(mov(Register::a, which));
    emit(op::kSta, slot(byte));
    emit(op::kPopPsw);
    mark_stored(byte);
}

void Coder::point_to_slot(ByteId byte) {
    const Base wanted{facts_->variable[byte], Base::kSlot,
                      static_cast<int32_t>(facts_->index[byte])};
    if (load_near(Pair::hl, wanted)) return;
    vacate(Pair::hl);
    emit(by_pair(op::kLxi, Pair::hl), slot(byte));
    set_sum(Pair::hl, wanted);
}

void Coder::store_wanted(const Bytes& results) {
    const auto wanted = [&](ByteId byte) {
        const uint32_t at = block_->local.find(byte);
        return at != kNone && facts_->computed(byte) && needed(byte, true) &&
               wishes_->slot[at] != 0 && !state.in_slot.test(at);
    };
    for (std::size_t i = 0; i < results.size(); ++i) {
        if (!wanted(results[i])) continue;
        const Register which = find(results[i]);
        if (which == Register::flags) {
            failed = true;
            return;
        }
        if (which == Register::l && i + 1 < results.size() &&
            content(Register::h) == results[i + 1] &&
            facts_->adjacent(results[i], results[i + 1])) {
            store(Pair::hl);
            continue;
        }
        spill(which);
    }
}

// -- Loading -------------------------------------------------------------------------------------

void Coder::load_from_slot(Register which, ByteId byte) {
    if (which == Register::a) {
        emit(op::kLda, slot(byte));
    } else if (which == Register::l && free_now(Register::h) && !free_now(Register::a)) {
        emit(op::kLhld, slot(byte));
        set(Register::h, kNone);
    } else if (free_now(Register::a)) {
        emit(op::kLda, slot(byte));
        set(Register::a, byte);
        emit(mov(which, Register::a));
    } else if (free_now(Register::h) && free_now(Register::l) && which != Register::h &&
               which != Register::l) {
        point_to_slot(byte);
        emit(mov_from_memory(which));
    } else if (!locked(Register::a)) {
        locks |= set_of(which);
        vacate(Register::a);
        unlock(set_of(which));
        emit(op::kLda, slot(byte));
        set(Register::a, byte);
        emit(mov(which, Register::a));
    } else {
        emit(op::kPushPsw);
        emit(op::kLda, slot(byte));
        emit(mov(which, Register::a));
        emit(op::kPopPsw);
    }
}

void Coder::load(Register which, ByteId byte) {
    if (failed || holds(which, byte)) return;
    vacate(which);
    if (failed) return;
    const Register from = find(byte);
    if (from != Register::flags) {
        emit(mov(which, from));
    } else if (constant(byte)) {
        emit(by_register(op::kMvi, which), operand_of(facts_->function.bytes[byte]));
    } else if (in_slot(byte)) {
        load_from_slot(which, byte);
    } else {
        failed = true;
        return;
    }
    set(which, byte);
}

// INX or DCX from what a pair holds already.
bool Coder::load_near(Pair pair, const Base& wanted) {
    const Base have = sum_in(pair);
    if (!have.same_base(wanted) || locked(pair)) return false;
    int32_t distance = static_cast<int16_t>(wanted.delta - have.delta);
    if (std::abs(distance) > kNear) return false;
    if (distance == 0 && state.sum[static_cast<unsigned>(pair)].known()) return true;
    vacate(pair);
    if (failed) return true;
    // Vacating may have exchanged it for something else, even for another step from the same base.
    const Base now = sum_in(pair);
    if (!now.same_base(wanted)) return false;
    distance = static_cast<int16_t>(wanted.delta - now.delta);
    if (std::abs(distance) > kNear) return false;
    for (int32_t i = 0; i < std::abs(distance); ++i) {
        emit(by_pair(distance > 0 ? op::kInx : op::kDcx, pair));
    }
    set_sum(pair, wanted);
    return true;
}

// DE from a word in HL that is 1 to 255 less.
bool Coder::load_by_ldhi(const Base& wanted) {
    const Base have = sum_in(Pair::hl);
    const int32_t distance = static_cast<int16_t>(wanted.delta - have.delta);
    const bool near = have.same_base(wanted) && distance > 0 && distance <= UINT8_MAX;
    if (!facts_->steps.contains(Step::ldhi) || !near) return false;
    const RegisterSet before = locks;
    lock(Pair::hl);
    vacate(Pair::de);
    locks = before;
    if (!failed) emit_number(op::kLdhi, distance);
    return true;
}

void Coder::load_word_from_slot(Pair pair, ByteId low, ByteId high) {
    if (pair != Pair::bc || (free_now(Register::h) && free_now(Register::l))) vacate(pair);
    if (failed) return;
    const bool hl_free = free_now(Register::h) && free_now(Register::l);
    if (pair == Pair::hl) {
        emit(op::kLhld, slot(low));
    } else if (pair == Pair::de) {
        if (!hl_free) emit(op::kXchg);
        emit(op::kLhld, slot(low));
        emit(op::kXchg);
        if (hl_free) set(Pair::hl, kNone, kNone);
    } else if (hl_free) {
        emit(op::kLhld, slot(low));
        set(Pair::hl, low, high);
        emit(mov(Register::c, Register::l));
        emit(mov(Register::b, Register::h));
    } else {
        return load_bytes(pair, low, high);
    }
    set(pair, low, high);
}

// All registers are needed: A waits on the stack.
void Coder::exchange_halves(Pair pair) {
    const ByteId low = content(high_of(pair));
    const ByteId high = content(low_of(pair));
    if (locked(pair)) {
        failed = true;
        return;
    }
    emit(op::kPushPsw);
    emit(mov(Register::a, low_of(pair)));
    emit(mov(low_of(pair), high_of(pair)));
    emit(mov(high_of(pair), Register::a));
    emit(op::kPopPsw);
    set(pair, low, high);
}

void Coder::load_bytes(Pair pair, ByteId low, ByteId high) {
    const Register first = low_of(pair);
    const Register second = high_of(pair);
    const bool low_done = holds(first, low);
    const bool high_done = holds(second, high);
    if (low_done && high_done) return;
    // Another word that is in the way moves as a whole: where words are moved by LHLX and SHLX it
    // is needed as one again.
    const auto is_wanted = [&](ByteId byte) { return byte == low || byte == high; };
    const bool by_words = facts_->steps.contains(Step::lhlx) || facts_->steps.contains(Step::shlx);
    if (by_words && !is_wanted(content(first)) && !is_wanted(content(second)) && !locked(pair)) {
        vacate(pair);
    }
    if (failed) return;
    const bool low_in_second =
        content(second) == low &&
        find(low, static_cast<RegisterSet>(~set_of(second))) == Register::flags;
    const bool high_in_first =
        content(first) == high &&
        find(high, static_cast<RegisterSet>(~set_of(first))) == Register::flags;
    if (low_in_second && high_in_first) {  // exchanged: through a third register
        const Register between = free_register(low, set_of(pair));
        if (between == Register::flags) return exchange_halves(pair);
        emit(mov(between, second));
        set(between, low);
    }
    const RegisterSet before = locks;
    if (high_in_first || (high_done && !low_in_second)) {
        load(second, high);
        lock(second);
        load(first, low);
    } else {
        load(first, low);
        lock(first);
        load(second, high);
    }
    locks = before;
}

void Coder::load(Pair pair, ByteId low, ByteId high) {
    if (failed || holds(pair, low, high)) return;
    if (locked(pair)) {
        // One half may be there and locked for that reason.
        return load_bytes(pair, low, high);
    }
    const Pair other = pair == Pair::hl ? Pair::de : Pair::hl;
    if (pair != Pair::bc && holds(other, low, high) && !locked(other)) {
        emit(op::kXchg);
        std::swap(state.sum[1], state.sum[2]);
        std::swap(state.content[2], state.content[4]);
        std::swap(state.content[3], state.content[5]);
        return;
    }
    const Base wanted = facts_->base_of(low, high);
    if (load_near(pair, wanted)) {
        set(pair, low, high);
        return;
    }
    if (pair == Pair::de && load_by_ldhi(wanted)) {
        set(pair, low, high);
        return;
    }
    const bool in_registers = find(low) != Register::flags && find(high) != Register::flags;
    if (constant(low) && constant(high) && !in_registers) {
        vacate(pair);
        CodeOperand operand{CodeOperand::Kind::number, CodeOperand::Part::word, 0, 0};
        if (wanted.high == Base::kSymbol) {
            operand = {CodeOperand::Kind::symbol, CodeOperand::Part::word, wanted.low,
                       wanted.delta};
        } else if (wanted.high == Base::kNumber) {
            operand.offset = wanted.delta & 0xFFFF;
        } else {
            return load_bytes(pair, low, high);
        }
        emit(by_pair(op::kLxi, pair), operand);
        set(pair, low, high);
        return;
    }
    if (!in_registers && facts_->adjacent(low, high) && in_slot(low) && in_slot(high)) {
        return load_word_from_slot(pair, low, high);
    }
    load_bytes(pair, low, high);
}

}  // namespace toolchain::codegen
