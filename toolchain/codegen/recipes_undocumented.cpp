// recipes_undocumented.cpp - shifts of words and longer ones by ARHL and RDEL.
// Depends on   recipes.hpp.
#include "toolchain/codegen/recipes.hpp"

namespace toolchain::codegen {

namespace {

constexpr unsigned kByteBits = 8;

bool is_signed(const Operation& operation) {
    return operation.opcode == Opcode::shift_right_signed;
}

/// Four bytes in DE and HL, the low word in HL, for being destroyed.
void take_both(Coder& coder, const Bytes& left) {
    coder.load(Pair::de, left[2], left[3]);
    coder.copy_out(Pair::de, true, true);
    coder.lock(Pair::de);
    take_hl(coder, left[0], left[1]);
    coder.lock(Pair::hl);
    if (!coder.holds(Pair::de, left[2], left[3])) coder.failed = true;
}

// DAD H; RDEL: 20 T a bit.
void add_left_long(Ways& ways, const Coder& start, const Operation& operation) {
    add_way(ways, start, [&](Coder& coder) {
        take_both(coder, operation.left);
        if (coder.failed) return;
        for (unsigned i = 0; i < operation.immediate; ++i) {
            coder.emit(by_pair(op::kDad, Pair::hl));
            coder.emit(op::kRdel);
        }
        coder.set(Pair::hl, operation.results[0], operation.results[1]);
        coder.set(Pair::de, operation.results[2], operation.results[3]);
    });
}

// x >> k is the upper part of x << (8 - k), with A as a fifth byte if all of it is needed.
void add_right_by_left(Ways& ways, const Coder& start, const Operation& operation) {
    const Bytes& results = operation.results;
    const bool top_needed = start.needed(results.back(), true);
    add_way(ways, start, [&](Coder& coder) {
        take_both(coder, operation.left);
        coder.vacate(Register::a, true);
        if (coder.failed) return;
        if (top_needed && is_signed(operation)) {
            coder.emit(mov(Register::a, Register::d));
            coder.emit(op::kRal);
            coder.emit(0x9F);  // SBB A
        } else if (top_needed) {
            coder.emit_number(by_register(op::kMvi, Register::a), 0);
        }
        for (unsigned i = operation.immediate; i < kByteBits; ++i) {
            coder.emit(by_pair(op::kDad, Pair::hl));
            coder.emit(op::kRdel);
            if (top_needed) coder.emit(op::kRal);
        }
        coder.set(Register::a, kNone);
        coder.set(Pair::hl, kNone, results[0]);
        coder.set(Pair::de, results[1], results[2]);
        if (!top_needed) return;
        coder.emit(mov(Register::l, Register::h));
        coder.emit(mov(Register::h, Register::e));
        coder.emit(mov(Register::e, Register::d));
        coder.emit(mov(Register::d, Register::a));
        coder.set(Pair::hl, results[0], results[1]);
        coder.set(Pair::de, results[2], results[3]);
        coder.set(Register::a, results[3]);
    });
}

/// The upper bits of H, behind ARHL copies of the sign, become 0.
void clear_top(Coder& coder, ByteId top, unsigned count) {
    coder.emit(mov(Register::a, Register::h));
    coder.emit_number(op::kAluImmediate | alu::kAna << 3, 0xFF >> count);
    coder.emit(mov(Register::h, Register::a));
    coder.set(Register::a, top);
}

// ARHL keeps the sign: 7 T a bit; without a sign the upper bits are cut off behind.
void add_word_right(Ways& ways, const Coder& start, const Operation& operation) {
    add_way(ways, start, [&](Coder& coder) {
        take_hl(coder, operation.left[0], operation.left[1]);
        if (coder.failed) return;
        const bool top_needed = coder.needed(operation.results[1], true);
        const bool masks = !is_signed(operation) && top_needed;
        if (masks) {
            coder.lock(Pair::hl);
            coder.vacate(Register::a, true);
        }
        if (coder.failed) return;
        for (unsigned i = 0; i < operation.immediate; ++i) coder.emit(op::kArhl);
        if (masks) clear_top(coder, operation.results[1], operation.immediate);
        coder.set(Pair::hl, operation.results[0], top_needed ? operation.results[1] : kNone);
    });
}

// Four bytes: the high word by ARHL, the low one behind it through A.
void add_long_right(Ways& ways, const Coder& start, const Operation& operation) {
    const Bytes& left = operation.left;
    const Bytes& results = operation.results;
    for (const Pair low : {Pair::de, Pair::bc}) {
        add_way(ways, start, [&](Coder& coder) {
            coder.load(low, left[0], left[1]);
            coder.copy_out(low, true, true);
            coder.lock(low);
            take_hl(coder, left[2], left[3]);
            coder.lock(Pair::hl);
            coder.vacate(Register::a, true);
            if (!coder.holds(low, left[0], left[1])) coder.failed = true;
            if (coder.failed) return;
            for (unsigned i = 0; i < operation.immediate; ++i) {
                coder.emit(op::kArhl);
                for (const Register which : {high_of(low), low_of(low)}) {
                    coder.emit(mov(Register::a, which));
                    coder.emit(op::kRar);
                    coder.emit(mov(which, Register::a));
                }
            }
            coder.set(Register::a, results[0]);
            if (!is_signed(operation) && coder.needed(results[3], true)) {
                clear_top(coder, results[3], operation.immediate);
            }
            coder.set(low, results[0], results[1]);
            coder.set(Pair::hl, results[2], results[3]);
        });
    }
}

}  // namespace

void add_undocumented_shifts(Ways& ways, const Coder& start, const Operation& operation) {
    const std::size_t size = operation.results.size();
    const bool by_rdel = start.facts().steps.contains(Step::rdel);
    const bool by_arhl = start.facts().steps.contains(Step::arhl);
    if (operation.opcode == Opcode::shift_left) {
        if (size == 4 && by_rdel) add_left_long(ways, start, operation);
        return;
    }
    if (size == 2 && by_arhl) add_word_right(ways, start, operation);
    if (size == 4 && by_rdel) add_right_by_left(ways, start, operation);
    if (size == 4 && by_arhl) add_long_right(ways, start, operation);
}

}  // namespace toolchain::codegen
