// recipes_shift.cpp - shifts by 1 to 7 bits, copies of the sign.
// Depends on   recipes.hpp.
#include "toolchain/codegen/recipes.hpp"

namespace toolchain::codegen {

namespace {

constexpr unsigned kByteBits = 8;

void repeat(Coder& coder, uint8_t opcode, unsigned count) {
    for (unsigned i = 0; i < count; ++i) coder.emit(opcode);
}

void add_byte_shifts(Ways& ways, const Coder& start, const Operation& operation) {
    const unsigned count = operation.immediate;
    const ByteId result = operation.results[0];
    const bool left = operation.opcode == Opcode::shift_left;
    const bool is_signed = operation.opcode == Opcode::shift_right_signed;
    const auto finish = [&](Coder& coder) { coder.set(Register::a, result); };
    add_way(ways, start, [&](Coder& coder) {
        take_a(coder, operation.left[0]);
        if (coder.failed) return;
        for (unsigned i = 0; i < count; ++i) {
            if (left) {
                coder.emit(0x87);  // ADD A
            } else if (is_signed) {
                repeat(coder, op::kRlc, 1);  // the sign into the carry, A as it was
                repeat(coder, op::kRar, 2);
            } else {
                coder.emit(0xB7);  // ORA A
                coder.emit(op::kRar);
            }
        }
        finish(coder);
        if (left && count == 1) coder.state.sign_in_carry = operation.left[0];
    });
    if (is_signed) return;
    add_way(ways, start, [&](Coder& coder) {
        take_a(coder, operation.left[0]);
        if (coder.failed) return;
        const bool by_rrc = left == (count > kByteBits / 2);
        const unsigned turns = count > kByteBits / 2 ? kByteBits - count : count;
        repeat(coder, by_rrc ? op::kRrc : op::kRlc, turns);
        const auto mask = static_cast<uint8_t>(left ? 0xFFU << count : 0xFFU >> count);
        coder.emit_number(op::kAluImmediate | alu::kAna << 3, mask);
        coder.state.tested = kNone;
        finish(coder);
    });
}

// -- To the left ---------------------------------------------------------------------------------

void add_left_word(Ways& ways, const Coder& start, const Operation& operation) {
    const Bytes& left = operation.left;
    add_way(ways, start, [&](Coder& coder) {
        take_hl(coder, left[0], left[1]);
        if (coder.failed) return;
        repeat(coder, by_pair(op::kDad, Pair::hl), operation.immediate);
        coder.set(Pair::hl, operation.results[0], operation.results[1]);
        if (operation.immediate == 1) coder.state.sign_in_carry = left[1];
    });
}

void add_left_three(Ways& ways, const Coder& start, const Operation& operation) {
    add_way(ways, start, [&](Coder& coder) {
        take_hl(coder, operation.left[0], operation.left[1]);
        coder.lock(Pair::hl);
        take_a(coder, operation.left[2]);
        if (coder.failed) return;
        for (unsigned i = 0; i < operation.immediate; ++i) {
            coder.emit(by_pair(op::kDad, Pair::hl));
            coder.emit(op::kRal);
        }
        coder.set(Pair::hl, operation.results[0], operation.results[1]);
        coder.set(Register::a, operation.results[2]);
    });
}

void add_left_long(Ways& ways, const Coder& start, const Operation& operation) {
    const Bytes& left = operation.left;
    for (const Pair top : {Pair::de, Pair::bc}) {
        add_way(ways, start, [&](Coder& coder) {
            coder.load(top, left[2], left[3]);
            coder.copy_out(top, true, true);
            coder.lock(top);
            take_hl(coder, left[0], left[1]);
            coder.lock(Pair::hl);
            coder.vacate(Register::a, true);
            if (coder.failed || !coder.holds(top, left[2], left[3])) {
                coder.failed = true;
                return;
            }
            for (unsigned i = 0; i < operation.immediate; ++i) {
                coder.emit(by_pair(op::kDad, Pair::hl));
                for (const Register which : {low_of(top), high_of(top)}) {
                    coder.emit(mov(Register::a, which));
                    coder.emit(op::kRal);
                    coder.emit(mov(which, Register::a));
                }
            }
            coder.set(Pair::hl, operation.results[0], operation.results[1]);
            coder.set(top, operation.results[2], operation.results[3]);
            coder.set(Register::a, operation.results[3]);
        });
    }
}

// -- To the right --------------------------------------------------------------------------------

// Bit by bit from the top byte down, in registers or in the result's slots.
void step_right(Coder& coder, const Operation& operation, const Places& places) {
    const Bytes& left = operation.left;
    const Bytes& results = operation.results;
    const bool is_signed = operation.opcode == Opcode::shift_right_signed;
    for (unsigned bit = 0; bit < operation.immediate && !coder.failed; ++bit) {
        for (std::size_t i = results.size(); i-- > 0 && !coder.failed;) {
            const bool top = i + 1 == results.size();
            const bool in_register = places[i] != Register::flags;
            if (bit == 0) {
                coder.load(Register::a, left[i]);
                const Bytes rest(left.begin(), left.begin() + static_cast<std::ptrdiff_t>(i));
                coder.vacate(Register::a, !occurs(rest, left[i]));
            } else if (in_register) {
                coder.emit(mov(Register::a, places[i]));
            } else {
                coder.emit(op::kLda, coder.slot(results[i]));
            }
            if (top && is_signed) {
                repeat(coder, op::kRlc, 1);
                repeat(coder, op::kRar, 1);
            } else if (top) {
                coder.emit(0xB7);  // ORA A
            }
            coder.emit(op::kRar);
            coder.set(Register::a, results[i]);
            coder.lock(Register::a);
            if (in_register && bit == 0) {
                const ByteId there = coder.content(places[i]);
                const Bytes rest(left.begin(), left.begin() + static_cast<std::ptrdiff_t>(i));
                coder.vacate(places[i], there == kNone || !occurs(rest, there));
                if (coder.failed) return;
            }
            if (in_register) {
                coder.emit(mov(places[i], Register::a));
                coder.set(places[i], results[i]);
                coder.lock(places[i]);
            } else {
                coder.store(Register::a);
            }
            coder.unlock(set_of(Register::a));
        }
    }
}

void add_steps_right(Ways& ways, const Coder& start, const Operation& operation) {
    for (const Places& places : places_for(operation.results.size())) {
        bool uses_a = false;
        for (const Register place : places) uses_a = uses_a || place == Register::a;
        if (uses_a) continue;
        add_way(ways, start, [&](Coder& coder) { step_right(coder, operation, places); });
    }
}

void take_fill(Coder& coder, ByteId top, bool is_signed) {
    if (is_signed) {
        coder.load(Register::a, top);
        coder.lock(Register::a);
    }
    coder.unlock(set_of(Register::a));
    coder.vacate(Register::a, !is_signed || coder.find(top, 0x7F) != Register::flags);
    if (coder.failed) return;
    if (is_signed) {
        coder.emit(op::kRal);
        coder.emit(0x9F);  // SBB A
    } else {
        coder.emit(0xAF);  // XRA A
    }
    coder.set(Register::a, kNone);
}

// x >> k is the upper part of x << (8 - k): DAD H; RAL takes 14 a bit where the right needs 28.
void add_right_by_left(Ways& ways, const Coder& start, const Operation& operation) {
    const Bytes& left = operation.left;
    const Bytes& results = operation.results;
    const unsigned count = kByteBits - operation.immediate;
    const bool is_signed = operation.opcode == Opcode::shift_right_signed;
    const bool top_needed = start.needed(results.back(), true);
    if (results.size() == 2) {
        for (const Pair to : kPairs) {
            add_way(ways, start, [&](Coder& coder) {
                coder.load(Pair::hl, left[0], left[1]);
                coder.lock(Pair::hl);
                if (top_needed) take_fill(coder, left[1], is_signed);
                coder.unlock(set_of(Pair::hl));
                coder.lock(Register::a);
                take_hl(coder, left[0], left[1]);
                if (coder.failed) return;
                for (unsigned i = 0; i < count; ++i) {
                    coder.emit(by_pair(op::kDad, Pair::hl));
                    if (top_needed) coder.emit(op::kRal);
                }
                coder.set(Pair::hl, kNone, results[0]);
                if (!top_needed) return;
                coder.set(Register::a, results[1]);
                if (to == Pair::hl) {
                    coder.emit(mov(Register::l, Register::h));
                    coder.emit(mov(Register::h, Register::a));
                } else {
                    coder.lock(Pair::hl);
                    coder.vacate(to, true);
                    if (coder.failed) return;
                    coder.emit(mov(low_of(to), Register::h));
                    coder.emit(mov(high_of(to), Register::a));
                }
                coder.set(to, results[0], results[1]);
            });
        }
    }
}

// The same of three bytes with all of the result: the bits go from HL through A into a fourth
// register.
void add_three_right_by_left(Ways& ways, const Coder& start, const Operation& operation) {
    const Bytes& left = operation.left;
    const Bytes& results = operation.results;
    const unsigned count = kByteBits - operation.immediate;
    const bool is_signed = operation.opcode == Opcode::shift_right_signed;
    if (results.size() != 3 || count > 3 || !start.needed(results.back(), true)) return;
    for (const Pair top : {Pair::bc, Pair::de}) {
        add_way(ways, start, [&](Coder& coder) {
            const Register upper = high_of(top);
            const Register kept = low_of(top);
            take_hl(coder, left[0], left[1]);
            coder.lock(Pair::hl);
            take_a(coder, left[2]);
            coder.lock(Register::a);
            coder.vacate(top, true);
            if (coder.failed) return;
            coder.set(top, kNone, kNone);
            if (is_signed) {
                coder.emit(mov(kept, Register::a));
                coder.emit(op::kRal);
                coder.emit(0x9F);  // SBB A
                coder.emit(mov(upper, Register::a));
                coder.emit(mov(Register::a, kept));
            } else {
                coder.emit_number(by_register(op::kMvi, upper), 0);
            }
            for (unsigned i = 0; i < count; ++i) {
                coder.emit(by_pair(op::kDad, Pair::hl));
                coder.emit(op::kRal);
                coder.emit(mov(kept, Register::a));
                coder.emit(mov(Register::a, upper));
                coder.emit(op::kRal);
                coder.emit(mov(upper, Register::a));
                if (i + 1 < count) coder.emit(mov(Register::a, kept));
            }
            coder.set(Pair::hl, kNone, results[0]);
            coder.set(top, results[1], results[2]);
            coder.set(Register::a, results[2]);
        });
    }
}

// The same of four bytes with all of the result: from HL through DE into a fifth register.
void add_four_right_by_left(Ways& ways, const Coder& start, const Operation& operation) {
    const Bytes& left = operation.left;
    const Bytes& results = operation.results;
    const unsigned count = kByteBits - operation.immediate;
    const bool is_signed = operation.opcode == Opcode::shift_right_signed;
    if (results.size() != 4 || count > 3 || !start.needed(results.back(), true)) return;
    add_way(ways, start, [&](Coder& coder) {
        coder.load(Pair::de, left[2], left[3]);
        coder.copy_out(Pair::de, true, true);
        coder.lock(Pair::de);
        take_hl(coder, left[0], left[1]);
        coder.lock(Pair::hl);
        coder.vacate(Register::a, true);
        coder.vacate(Pair::bc, true);
        if (coder.failed || !coder.holds(Pair::de, left[2], left[3])) {
            coder.failed = true;
            return;
        }
        if (is_signed) {
            coder.emit(mov(Register::a, Register::d));
            coder.emit(op::kRal);
            coder.emit(0x9F);  // SBB A
        } else {
            coder.emit(0xAF);  // XRA A
        }
        for (unsigned i = 0; i < count; ++i) {
            coder.emit(mov(Register::b, Register::a));
            coder.emit(by_pair(op::kDad, Pair::hl));
            for (const Register which : {Register::e, Register::d}) {
                coder.emit(mov(Register::a, which));
                coder.emit(op::kRal);
                coder.emit(mov(which, Register::a));
            }
            coder.emit(mov(Register::a, Register::b));
            coder.emit(op::kRal);
        }
        // A, D, E, H hold the result from the top: as words in HL and DE.
        coder.emit(mov(Register::l, Register::h));
        coder.emit(mov(Register::h, Register::e));
        coder.emit(mov(Register::e, Register::d));
        coder.emit(mov(Register::d, Register::a));
        coder.set(Pair::bc, kNone, kNone);
        coder.set(Pair::hl, results[0], results[1]);
        coder.set(Pair::de, results[2], results[3]);
        coder.set(Register::a, results[3]);
    });
}

// The same of three or four bytes, where the highest of the result is not needed.
void add_long_right_by_left(Ways& ways, const Coder& start, const Operation& operation) {
    const Bytes& left = operation.left;
    const Bytes& results = operation.results;
    const unsigned count = kByteBits - operation.immediate;
    if (start.needed(results.back(), true)) return;
    if (results.size() == 3) {
        add_way(ways, start, [&](Coder& coder) {
            take_hl(coder, left[0], left[1]);
            coder.lock(Pair::hl);
            take_a(coder, left[2]);
            if (coder.failed) return;
            for (unsigned i = 0; i < count; ++i) {
                coder.emit(by_pair(op::kDad, Pair::hl));
                coder.emit(op::kRal);
            }
            coder.set(Pair::hl, kNone, results[0]);
            coder.set(Register::a, results[1]);
        });
    }
    if (results.size() == 4) {
        add_way(ways, start, [&](Coder& coder) {
            coder.load(Pair::de, left[2], left[3]);
            coder.copy_out(Pair::de, true, true);
            coder.lock(Pair::de);
            take_hl(coder, left[0], left[1]);
            coder.lock(Pair::hl);
            coder.vacate(Register::a, true);
            if (coder.failed || !coder.holds(Pair::de, left[2], left[3])) {
                coder.failed = true;
                return;
            }
            for (unsigned i = 0; i < count; ++i) {
                coder.emit(by_pair(op::kDad, Pair::hl));
                for (const Register which : {Register::e, Register::d}) {
                    coder.emit(mov(Register::a, which));
                    coder.emit(op::kRal);
                    coder.emit(mov(which, Register::a));
                }
            }
            coder.set(Pair::hl, kNone, results[0]);
            coder.set(Pair::de, results[1], results[2]);
            coder.set(Register::a, results[2]);
        });
    }
}

// -- Any size, in the result's slots -------------------------------------------------------------

void add_in_slots(Ways& ways, const Coder& start, const Operation& operation) {
    add_way(ways, start, [&](Coder& coder) {
        const Bytes& left = operation.left;
        const Bytes& results = operation.results;
        for (unsigned bit = 0; bit < operation.immediate && !coder.failed; ++bit) {
            for (std::size_t i = 0; i < results.size() && !coder.failed; ++i) {
                if (bit == 0) {
                    coder.load(Register::a, left[i]);
                    coder.vacate(Register::a, !occurs(left, left[i], i + 1));
                } else {
                    coder.emit(op::kLda, coder.slot(results[i]));
                }
                coder.emit(i == 0 ? uint8_t{0x87} : op::kRal);  // ADD A
                coder.set(Register::a, results[i]);
                coder.lock(Register::a);
                coder.store(Register::a);
                coder.unlock(set_of(Register::a));
            }
        }
    });
}

}  // namespace

void take_a(Coder& coder, ByteId byte) {
    coder.load(Register::a, byte);
    coder.vacate(Register::a, true);
}

void take_hl(Coder& coder, ByteId low, ByteId high) {
    coder.load(Pair::hl, low, high);
    coder.copy_out(Pair::hl, true, true);
    if (!coder.holds(Pair::hl, low, high)) coder.failed = true;
}

void add_shifts(Ways& ways, const Coder& start, const Operation& operation) {
    const std::size_t size = operation.results.size();
    if (operation.opcode == Opcode::sign_fill) {
        add_way(ways, start, [&](Coder& coder) {
            take_a(coder, operation.left[0]);
            if (coder.failed) return;
            coder.emit(op::kRal);
            coder.emit(0x9F);  // SBB A
            coder.set(Register::a, operation.results[0]);
        });
        return;
    }
    if (size == 1) return add_byte_shifts(ways, start, operation);
    add_undocumented_shifts(ways, start, operation);
    if (operation.opcode == Opcode::shift_left) {
        if (size == 2) add_left_word(ways, start, operation);
        if (size == 3) add_left_three(ways, start, operation);
        if (size == 4) add_left_long(ways, start, operation);
        add_in_slots(ways, start, operation);
        return;
    }
    add_steps_right(ways, start, operation);
    add_right_by_left(ways, start, operation);
    add_three_right_by_left(ways, start, operation);
    add_four_right_by_left(ways, start, operation);
    add_long_right_by_left(ways, start, operation);
}

}  // namespace toolchain::codegen
