// recipes_compare.cpp - comparisons as flags, and as a byte that is 0 or 1.
// Depends on   recipes.hpp.
#include "toolchain/codegen/recipes.hpp"

namespace toolchain::codegen {

namespace {

bool is_number(const Coder& coder, ByteId byte, uint8_t value) {
    return coder.facts().constant(byte) && coder.facts().function.bytes[byte].constant == value;
}

bool all(const Coder& coder, const Bytes& bytes, uint8_t value) {
    for (const ByteId byte : bytes) {
        if (!is_number(coder, byte, value)) return false;
    }
    return true;
}

template <typename Action>
void add_decision(std::vector<Decision>& ways, const Coder& start, Condition condition,
                  Action action) {
    Decision way{start, condition};
    way.coder.items.clear();
    way.coder.jumps = false;
    action(way.coder);
    way.coder.release();
    if (!way.coder.failed) ways.push_back(std::move(way));
}

/// Loads a byte of the left operand into A for being destroyed.
void take(Coder& coder, const Bytes& left, const Bytes& right, std::size_t at) {
    coder.load(Register::a, left[at]);
    const bool unread = occurs(left, left[at], at + 1) || occurs(right, left[at], at + 1);
    coder.vacate(Register::a, !unread);
}

// -- Equality ------------------------------------------------------------------------------------

/// Z and S of one byte.
void add_tests(std::vector<Decision>& ways, const Coder& start, ByteId byte, Condition condition) {
    if (start.state.tested == byte) {
        add_decision(ways, start, condition, [](Coder&) {});
        return;
    }
    add_decision(ways, start, condition, [&](Coder& coder) {
        coder.load(Register::a, byte);
        if (coder.failed) return;
        coder.emit(0xB7);  // ORA A
        coder.state.tested = byte;
    });
    const Register which = start.find(byte, 0x7F);
    if (which == Register::flags) return;
    add_decision(ways, start, condition, [&](Coder& coder) {
        coder.emit(by_register(op::kInr, which));
        coder.emit(by_register(op::kDcr, which));
        coder.state.tested = byte;
    });
}

/// The carry may hold the top bit already: of a value that was doubled.
void add_sign_tests(std::vector<Decision>& ways, const Coder& start, ByteId byte, bool set) {
    if (start.state.sign_in_carry == byte && start.facts().steps.contains(Step::carry_signs)) {
        add_decision(ways, start, set ? Condition::c : Condition::nc, [](Coder&) {});
    }
    add_tests(ways, start, byte, set ? Condition::m : Condition::p);
}

void add_zero_test(std::vector<Decision>& ways, const Coder& start, const Bytes& value) {
    if (value.size() == 1) return add_tests(ways, start, value[0], Condition::z);
    const auto& counted = start.state.zero_in_k;
    if (value.size() == 2 && counted[0] == value[0] && counted[1] == value[1]) {
        add_decision(ways, start, Condition::k, [](Coder&) {});
    }
    // Begin with what is in A, or else with any byte.
    for (std::size_t first = 0; first < value.size(); ++first) {
        if (first > 0 && start.content(Register::a) != value[first]) continue;
        add_decision(ways, start, Condition::z, [&](Coder& coder) {
            coder.load(Register::a, value[first]);
            coder.vacate(Register::a, value.size() == 1 || !occurs(value, value[first], first + 1));
            for (std::size_t i = 0; i < value.size() && !coder.failed; ++i) {
                if (i != first) alu_on_a(coder, alu::kOra, value[i]);
            }
            coder.set(Register::a, kNone);
        });
    }
}

/// How a comparison byte by byte treats registers between its bytes.
enum class Keeping : uint8_t { any, all_but_a, all_but_a_saved };

// A = left[i], compared with right[i], or the other way round. What A held is no operand any more,
// or it is somewhere else too.
void compare_step(Coder& coder, const Bytes& left, const Bytes& right, std::size_t i) {
    const ByteId there = coder.content(Register::a);
    if (i > 0 && there == right[i] && !coder.facts().undefined(there)) {
        return alu_on_a(coder, alu::kCmp, left[i]);
    }
    if (i > 0 && there != left[i] && !occurs(left, there, i) && !occurs(right, there, i)) {
        coder.set(Register::a, kNone);
    }
    coder.load(Register::a, left[i]);
    if (!coder.failed) alu_on_a(coder, alu::kCmp, right[i]);
}

// Byte by byte, leaving at the first difference. Nothing but A may be different at the last one.
void add_stepwise_equal(std::vector<Decision>& ways, const Coder& start, const Bytes& left,
                        const Bytes& right, const Targets& targets) {
    constexpr double kDiffers = 0.7;
    for (const Keeping keeping : {Keeping::any, Keeping::all_but_a, Keeping::all_but_a_saved}) {
        if (keeping == Keeping::all_but_a_saved && left.size() == 1) continue;
        add_decision(ways, start, Condition::z, [&](Coder& coder) {
            if (left.size() > 1) coder.vacate(Register::a, true);
            if (keeping == Keeping::all_but_a_saved && !coder.failed) {
                coder.vacate(Register::a);  // an operand that is in A only
                coder.set(Register::a, kNone);
            }
            State first;
            for (std::size_t i = 0; i < left.size() && !coder.failed; ++i) {
                if (keeping != Keeping::any && i > 0) coder.locks = 0x3F;
                compare_step(coder, left, right, i);
                if (coder.failed || i + 1 == left.size()) break;
                if (i == 0) first = coder.state;
                coder.emit_jump(op::kJnz, targets.label_false, kDiffers);
            }
            if (left.size() == 1 || coder.failed) return;
            coder.set(Register::a, kNone);
            coder.state.sum = {};
            for (const Register which : kRegisters) {
                if (which == Register::a) continue;
                const ByteId now = coder.content(which);
                if (now != first.content[static_cast<unsigned>(which)]) coder.failed = true;
            }
            if (!(coder.state.in_slot == first.in_slot)) coder.failed = true;
        });
    }
}

// -- Order ---------------------------------------------------------------------------------------

/// The sum or difference that says it was the last to change the carry.
void add_carry_answer(std::vector<Decision>& ways, const Coder& start) {
    const CarryAnswer& answer = start.block().carry_answers[start.position];
    if (answer.from == kNone || start.state.carry_of != answer.from) return;
    add_decision(ways, start, answer.inverted ? Condition::nc : Condition::c, [](Coder&) {});
}

/// @param condition  behind the subtraction: the borrow, or K for numbers with signs
void add_below(std::vector<Decision>& ways, const Coder& start, const Bytes& left,
               const Bytes& right, Condition condition) {
    std::size_t first = 0;
    while (first + 1 < right.size() && is_number(start, right[first], 0)) ++first;
    add_decision(ways, start, condition, [&](Coder& coder) {
        const bool single = first + 1 == left.size();
        for (std::size_t i = first; i < left.size() && !coder.failed; ++i) {
            if (single) {
                coder.load(Register::a, left[i]);
                if (!coder.failed) alu_on_a(coder, alu::kCmp, right[i]);
                return;
            }
            take(coder, left, right, i);
            if (coder.failed) return;
            alu_on_a(coder, i == first ? alu::kSub : alu::kSbb, right[i]);
            coder.set(Register::a, kNone);
        }
    });
}

/// DSUB of the lowest words, the bytes above by A: CY is the borrow, and K says "less".
void add_order_by_dsub(std::vector<Decision>& ways, const Coder& start, const Bytes& left,
                       const Bytes& right, Condition condition) {
    if (!start.facts().steps.contains(Step::dsub) || left.size() < 2) return;
    add_decision(ways, start, condition, [&](Coder& coder) {
        if (!load_for_dsub(coder, left, right, 0)) return;
        coder.emit(op::kDsub);
        coder.set(Pair::hl, kNone, kNone);
        for (std::size_t i = 2; i < left.size() && !coder.failed; ++i) {
            take(coder, left, right, i);
            if (coder.failed) return;
            alu_on_a(coder, alu::kSbb, right[i]);
            coder.set(Register::a, kNone);
        }
    });
}

/// Behind a subtraction K says "less".
void add_less_by_k(std::vector<Decision>& ways, const Coder& start, const Bytes& left,
                   const Bytes& right) {
    if (!start.facts().steps.contains(Step::less_by_k)) return;
    add_below(ways, start, left, right, Condition::k);
    add_order_by_dsub(ways, start, left, right, Condition::k);
}

// Less if borrow, sign of left and sign of right differ in an odd number: RAR brings the borrow
// to bit 7, XRA sets S.
void add_less(std::vector<Decision>& ways, const Coder& start, const Bytes& left,
              const Bytes& right) {
    const std::size_t top = left.size() - 1;
    const auto sign_of_constant = [&](ByteId byte) {
        return start.facts().constant(byte)
                   ? static_cast<int>(start.facts().function.bytes[byte].constant >> 7)
                   : -1;
    };
    const int right_sign = sign_of_constant(right[top]);
    const int left_sign = sign_of_constant(left[top]);
    const bool flip = right_sign == 1 || (right_sign < 0 && left_sign == 1);
    std::size_t first = 0;
    while (first < top && is_number(start, right[first], 0)) ++first;
    add_decision(ways, start, flip ? Condition::p : Condition::m, [&](Coder& coder) {
        for (std::size_t i = first; i < left.size() && !coder.failed; ++i) {
            coder.load(Register::a, left[i]);
            // The top bytes are read once more, for their signs.
            const bool unread =
                i == top || occurs(left, left[i], i + 1) || occurs(right, left[i], i + 1);
            coder.vacate(Register::a, !unread);
            if (coder.failed) return;
            alu_on_a(coder, i == first ? alu::kSub : alu::kSbb, right[i]);
            coder.set(Register::a, kNone);
        }
        if (coder.failed) return;
        coder.emit(op::kRar);
        if (left_sign < 0 || right_sign >= 0) alu_on_a(coder, alu::kXra, left[top]);
        if (right_sign < 0) alu_on_a(coder, alu::kXra, right[top]);
        coder.set(Register::a, kNone);
    });
}

}  // namespace

std::vector<Decision> decide(const Coder& start, Predicate predicate, const Bytes& left,
                             const Bytes& right, const Targets& targets) {
    std::vector<Decision> ways;
    const bool negated = (static_cast<uint8_t>(predicate) & 1U) != 0;
    const Targets ordered = negated ? Targets{targets.label_false, targets.label_true} : targets;
    switch (negated ? inverse(predicate) : predicate) {
        case Predicate::equal:
            if (all(start, right, 0)) {
                add_zero_test(ways, start, left);
            } else if (all(start, left, 0)) {
                add_zero_test(ways, start, right);
            } else {
                add_stepwise_equal(ways, start, left, right, ordered);
                add_stepwise_equal(ways, start, right, left, ordered);
            }
            break;
        case Predicate::below:
            add_carry_answer(ways, start);
            add_below(ways, start, left, right, Condition::c);
            add_order_by_dsub(ways, start, left, right, Condition::c);
            break;
        default:
            if (all(start, right, 0)) {
                add_sign_tests(ways, start, left.back(), true);
            } else if (all(start, left, 0xFF)) {
                add_sign_tests(ways, start, right.back(), false);
            } else {
                add_less(ways, start, left, right);
                add_less_by_k(ways, start, left, right);
            }
            break;
    }
    if (negated) {
        for (Decision& way : ways) way.condition = inverse(way.condition);
    }
    return ways;
}

namespace {

/// 0 or 1 out of bit 7 of A.
void emit_top_bit(Coder& coder, bool inverted) {
    if (inverted) coder.emit(0x2F);  // CMA
    coder.emit(op::kRlc);
    coder.emit_number(op::kAluImmediate | alu::kAna << 3, 1);
}

/// 1 where A is 0, else 0; or the other way round: 0 - 1 borrows alone.
void emit_zero_as_byte(Coder& coder, bool inverted) {
    coder.emit_number(op::kAluImmediate | alu::kSub << 3, 1);
    coder.emit(0x9F);  // SBB A
    if (inverted) {
        coder.emit(by_register(op::kInr, Register::a));
    } else {
        coder.emit_number(op::kAluImmediate | alu::kAna << 3, 1);
    }
}

/// A becomes 0 where two values are equal, if they are bytes or one of them is 0. Else it fails.
void load_difference(Coder& coder, const Bytes& left, const Bytes& right) {
    const bool zero = all(coder, right, 0);
    if (!zero && left.size() > 1) coder.failed = true;
    for (std::size_t i = 0; i < left.size() && !coder.failed; ++i) {
        if (i == 0) {
            take(coder, left, right, 0);
            if (!zero && !coder.failed) alu_on_a(coder, alu::kXra, right[0]);
        } else {
            alu_on_a(coder, alu::kOra, left[i]);
        }
        coder.set(Register::a, kNone);
    }
}

/// Does decide() leave the answer in bit 7 of A: a signed comparison that is not one with 0?
bool leaves_less_in_a(const Coder& start, const Operation& operation) {
    const bool negated = (static_cast<uint8_t>(operation.predicate) & 1U) != 0;
    const Predicate predicate = negated ? inverse(operation.predicate) : operation.predicate;
    return predicate == Predicate::less && !all(start, operation.right, 0) &&
           !all(start, operation.left, 0xFF);
}

/// Comparisons for equality and with 0 that need no jump.
void add_compare_without_jump(Ways& ways, const Coder& start, const Operation& operation) {
    const bool negated = (static_cast<uint8_t>(operation.predicate) & 1U) != 0;
    const Predicate predicate = negated ? inverse(operation.predicate) : operation.predicate;
    if (predicate == Predicate::equal) {
        add_way(ways, start, [&](Coder& coder) {
            load_difference(coder, operation.left, operation.right);
            if (coder.failed) return;
            emit_zero_as_byte(coder, negated);
            coder.set(Register::a, operation.results[0]);
            coder.state.tested = operation.results[0];
        });
    } else if (predicate == Predicate::less && all(start, operation.right, 0)) {
        add_way(ways, start, [&](Coder& coder) {
            coder.load(Register::a, operation.left.back());
            coder.vacate(Register::a, true);
            if (coder.failed) return;
            emit_top_bit(coder, negated);
            coder.set(Register::a, operation.results[0]);
            coder.state.tested = operation.results[0];
        });
    }
}

}  // namespace

void add_compare(Ways& ways, const Coder& start, const Operation& operation,
                 const RecipeContext& context) {
    add_compare_without_jump(ways, start, operation);
    const Targets targets{context.label(), context.label()};
    const bool ends_with_less = leaves_less_in_a(start, operation);
    for (Decision& way :
         decide(start, operation.predicate, operation.left, operation.right, targets)) {
        Coder coder = std::move(way.coder);
        const bool jumps = coder.jumps;
        coder.vacate(Register::a, true);
        if (coder.failed) continue;
        if (!jumps && (way.condition == Condition::c || way.condition == Condition::nc)) {
            coder.emit(0x9F);  // SBB A
            if (way.condition == Condition::c) {
                coder.emit_number(op::kAluImmediate | alu::kAna << 3, 1);
            } else {
                coder.emit(by_register(op::kInr, Register::a));
            }
        } else if (ends_with_less &&
                   (way.condition == Condition::m || way.condition == Condition::p)) {
            emit_top_bit(coder, way.condition == Condition::p);
            coder.state.tested = kNone;
        } else {
            const uint32_t end = context.label();
            constexpr double kHalf = 0.5;
            coder.emit_jump(jump_if(inverse(way.condition)), targets.label_false, kHalf);
            coder.emit_label(targets.label_true);
            coder.emit_number(by_register(op::kMvi, Register::a), 1);
            coder.emit_jump(op::kJmp, end, 0);
            coder.emit_label(targets.label_false);
            coder.emit_number(by_register(op::kMvi, Register::a), 0);
            coder.emit_label(end);
        }
        coder.set(Register::a, operation.results[0]);
        coder.release();
        ways.push_back(std::move(coder));
    }
}

}  // namespace toolchain::codegen
