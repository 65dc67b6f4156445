// recipes_add.cpp - sums, differences, bitwise operations.
// Depends on   recipes.hpp.
#include <algorithm>
#include <cstdlib>

#include "toolchain/codegen/recipes.hpp"

namespace toolchain::codegen {

bool occurs(const Bytes& bytes, ByteId byte, std::size_t from) {
    return from < bytes.size() && std::find(bytes.begin() + static_cast<std::ptrdiff_t>(from),
                                            bytes.end(), byte) != bytes.end();
}

void alu_on_a(Coder& coder, unsigned operation, ByteId byte) {
    coder.lock(Register::a);
    coder.alu(operation, byte);
    coder.unlock(set_of(Register::a));
}

std::vector<Places> places_for(std::size_t size) {
    using enum Register;
    if (size == 1) return {{a}, {flags}};
    if (size == 2) return {{l, h}, {e, d}, {c, b}, {flags, flags}};
    if (size == 3) {
        return {{l, h, a}, {e, d, a}, {c, b, a}, {l, h, c}, {l, h, e},
                {e, d, c}, {e, d, l}, {c, b, e}, {c, b, l}, {flags, flags, flags}};
    }
    if (size == 4) {
        return {{l, h, e, d},         {l, h, c, b},
                {e, d, l, h},         {e, d, c, b},
                {c, b, e, d},         {c, b, l, h},
                {flags, flags, e, d}, {flags, flags, l, h},
                {flags, flags, c, b}, {flags, flags, flags, flags}};
    }
    return {Places(size, flags)};
}

namespace {

/// Makes room in a register of results: operands not read yet are kept.
void make_room(Coder& coder, Register which, const Bytes& left, const Bytes& right,
               std::size_t from) {
    const ByteId there = coder.content(which);
    const bool unread = there != kNone && (occurs(left, there, from) || occurs(right, there, from));
    coder.vacate(which, !unread);
}

void make_room(Coder& coder, Pair pair, const Bytes& left, const Bytes& right, std::size_t from) {
    const auto unread = [&](Register which) {
        const ByteId there = coder.content(which);
        return there != kNone && (occurs(left, there, from) || occurs(right, there, from));
    };
    coder.copy_out(pair, !unread(low_of(pair)), !unread(high_of(pair)));
}

struct Chain {
    unsigned first;
    unsigned next;
    const Bytes& left;
    const Bytes& right;
    const Bytes& results;
};

// Byte by byte through A, the carry in the flags between them.
void run_chain(Coder& coder, const Chain& chain, const Places& places) {
    const std::size_t size = chain.results.size();
    for (std::size_t i = 0; i < size && !coder.failed; ++i) {
        coder.load(Register::a, chain.left[i]);
        make_room(coder, Register::a, chain.left, chain.right, i + 1);
        if (coder.failed) return;
        // Making room may not have moved A's value away: it stays there as a copy.
        alu_on_a(coder, i == 0 ? chain.first : chain.next, chain.right[i]);
        coder.set(Register::a, chain.results[i]);
        coder.lock(Register::a);
        place_result(coder, chain.results[i], places[i], chain.left, chain.right, i + 1);
        coder.unlock(set_of(Register::a));
    }
}

void add_chains(Ways& ways, const Coder& start, const Chain& chain) {
    for (const Places& places : places_for(chain.results.size())) {
        add_way(ways, start, [&](Coder& coder) {
            run_chain(coder, chain, places);
            if (chain.results.size() == 1) coder.state.tested = chain.results[0];
            if (chain.first == alu::kAdd || chain.first == alu::kSub) coder.leave_carry();
        });
    }
}

// -- Small numbers -------------------------------------------------------------------------------

void add_steps_of_byte(Ways& ways, const Coder& start, const Operation& operation, int step) {
    const ByteId left = operation.left[0];
    for (const Register which : kRegisters) {
        if (which != Register::a && start.content(which) != left) continue;
        add_way(ways, start, [&](Coder& coder) {
            coder.load(which, left);
            coder.vacate(which, true);
            if (coder.failed) return;
            for (int i = 0; i < std::abs(step); ++i) {
                coder.emit(by_register(step > 0 ? op::kInr : op::kDcr, which));
            }
            coder.set(which, operation.results[0]);
            coder.state.tested = operation.results[0];
        });
    }
}

void step_pair(Coder& coder, Pair pair, const Bytes& results, int step) {
    for (int i = 0; i < std::abs(step); ++i) {
        coder.emit(by_pair(step > 0 ? op::kInx : op::kDcx, pair));
    }
    coder.set(pair, results[0], results[1]);
    // INX from FFFFH sets K.
    if (step > 0 && coder.facts().steps.contains(Step::zero_by_k)) {
        coder.state.zero_in_k = {results[0], results[1]};
    }
}

// LDHI: a word up to 255 more than one in HL goes to DE.
void add_word_by_ldhi(Ways& ways, const Coder& start, const Operation& operation, int step) {
    const Base wanted = start.facts().base_of(operation.results[0], operation.results[1]);
    const Base have = start.sum_in(Pair::hl);
    const int distance = static_cast<int16_t>(wanted.delta - have.delta);
    const bool near = have.same_base(wanted);
    if (!start.facts().steps.contains(Step::ldhi) || (near ? distance : step) < 0 ||
        (near ? distance : step) > UINT8_MAX) {
        return;
    }
    add_way(ways, start, [&](Coder& coder) {
        if (!near) coder.load(Pair::hl, operation.left[0], operation.left[1]);
        coder.lock(Pair::hl);
        coder.vacate(Pair::de, true);
        if (coder.failed) return;
        coder.emit_number(op::kLdhi, near ? distance : step);
        coder.set(Pair::de, operation.results[0], operation.results[1]);
    });
}

// INX and DCX, from the operand or from anything near it.
void add_steps_of_word(Ways& ways, const Coder& start, const Operation& operation, int step) {
    constexpr int kMost = 4;
    const Base wanted = start.facts().base_of(operation.results[0], operation.results[1]);
    for (const Pair pair : kPairs) {
        const Base have = start.sum_in(pair);
        const int distance = static_cast<int16_t>(wanted.delta - have.delta);
        if (have.same_base(wanted) && std::abs(distance) <= kMost) {
            add_way(ways, start, [&](Coder& coder) {
                coder.copy_out(pair, true, true);
                if (coder.failed) return;
                step_pair(coder, pair, operation.results, distance);
            });
        } else if (std::abs(step) <= kMost) {
            add_way(ways, start, [&](Coder& coder) {
                coder.load(pair, operation.left[0], operation.left[1]);
                coder.copy_out(pair, true, true);
                if (coder.failed) return;
                step_pair(coder, pair, operation.results, step);
            });
        }
    }
}

// -- Words by DAD --------------------------------------------------------------------------------

bool word_in(const Bytes& bytes, std::size_t at, const Coder& coder, Pair pair) {
    return coder.holds(pair, bytes[at], bytes[at + 1]);
}

// HL = left + right of the words at `at`; operands of words above are kept.
void dad_word(Coder& coder, const Bytes& left, const Bytes& right, std::size_t at, Pair other,
              bool other_first) {
    const bool same = left[at] == right[at] && left[at + 1] == right[at + 1];
    if (same) {
        coder.load(Pair::hl, left[at], left[at + 1]);
    } else if (other_first) {
        coder.load(other, right[at], right[at + 1]);
        coder.lock(other);
        coder.load(Pair::hl, left[at], left[at + 1]);
    } else {
        coder.load(Pair::hl, left[at], left[at + 1]);
        coder.lock(Pair::hl);
        coder.load(other, right[at], right[at + 1]);
        coder.unlock(set_of(Pair::hl));
        coder.lock(other);
    }
    make_room(coder, Pair::hl, left, right, at + 2);
    coder.unlock(set_of(other));
    if (coder.failed || !word_in(left, at, coder, Pair::hl) ||
        (!same && !word_in(right, at, coder, other))) {
        coder.failed = true;
    }
}

void add_dads(Ways& ways, const Coder& start, const Operation& operation) {
    const Bytes& results = operation.results;
    for (const bool swapped : {false, true}) {
        const Bytes& left = swapped ? operation.right : operation.left;
        const Bytes& right = swapped ? operation.left : operation.right;
        const bool same = left == right;
        for (const Pair other : {Pair::de, Pair::bc}) {
            for (const bool other_first : {false, true}) {
                if (same && (swapped || other == Pair::bc || other_first)) continue;
                add_way(ways, start, [&](Coder& coder) {
                    dad_word(coder, left, right, 0, other, other_first);
                    if (coder.failed) return;
                    coder.emit(by_pair(op::kDad, same ? Pair::hl : other));
                    coder.set(Pair::hl, results[0], results[1]);
                    coder.leave_carry();
                });
            }
        }
    }
}

// A byte onto a word in place: the carry skips an INR.
void add_byte_to_word(Ways& ways, const Coder& start, const Operation& operation,
                      const RecipeContext& context) {
    const auto zero = [&](ByteId byte) {
        return start.facts().constant(byte) && start.facts().function.bytes[byte].constant == 0;
    };
    for (const bool swapped : {false, true}) {
        const Bytes& word = swapped ? operation.right : operation.left;
        const Bytes& byte = swapped ? operation.left : operation.right;
        if (!zero(byte[1]) || start.facts().constant(byte[0])) continue;
        for (const Pair pair : kPairs) {
            add_way(ways, start, [&](Coder& coder) {
                coder.load(pair, word[0], word[1]);
                coder.lock(pair);
                coder.load(Register::a, byte[0]);
                coder.vacate(Register::a, true);
                if (coder.failed) return;
                alu_on_a(coder, alu::kAdd, word[0]);
                coder.lock(Register::a);
                coder.set(Register::a, operation.results[0]);
                coder.unlock(set_of(pair));
                coder.copy_out(pair, true, true);
                if (coder.failed || coder.content(high_of(pair)) != word[1]) {
                    coder.failed = true;
                    return;
                }
                coder.emit(mov(low_of(pair), Register::a));
                const uint32_t label = context.label();
                coder.emit_jump(op::kJnc, label, 0.5);
                coder.emit(by_register(op::kInr, high_of(pair)));
                coder.emit_label(label);
                coder.state.tested = kNone;
                coder.set(pair, operation.results[0], operation.results[1]);
            });
        }
    }
}

// Two words: the carry of the first DAD goes into the second by INX.
void add_long_dads(Ways& ways, const Coder& start, const Operation& operation,
                   const RecipeContext& context) {
    const Bytes& results = operation.results;
    const auto run = [&](Coder& coder, const Bytes& left, const Bytes& right, Pair other,
                         unsigned keep) {
        dad_word(coder, left, right, 0, other, false);
        if (coder.failed) return;
        const bool same = left[0] == right[0] && left[1] == right[1];
        coder.emit(by_pair(op::kDad, same ? Pair::hl : other));
        coder.set(Pair::hl, results[0], results[1]);
        RegisterSet kept = 0;
        if (keep == 0) {
            coder.store(Pair::hl);
        } else {
            const Pair pair = keep == 1 ? Pair::de : Pair::bc;
            kept = set_of(pair);
            coder.lock(Pair::hl);
            make_room(coder, pair, left, right, 2);
            coder.unlock(set_of(Pair::hl));
            if (coder.failed) return;
            coder.emit(mov(low_of(pair), Register::l));
            coder.emit(mov(high_of(pair), Register::h));
            coder.set(pair, results[0], results[1]);
        }
        coder.locks |= kept;
        const ByteId top = right[3];
        const bool nothing = coder.facts().constant(right[2]) && coder.facts().constant(top) &&
                             coder.facts().base_of(right[2], top).delta == 0;
        const Pair second = kept == set_of(Pair::de) ? Pair::bc : Pair::de;
        if (nothing) {
            coder.load(Pair::hl, left[2], left[3]);
            coder.copy_out(Pair::hl, true, true);
            if (!word_in(left, 2, coder, Pair::hl)) coder.failed = true;
        } else {
            dad_word(coder, left, right, 2, second, false);
        }
        // DAD H behind INX H would count the carry twice.
        const bool twice = left[2] == right[2] && left[3] == right[3];
        if (twice && !nothing) {
            coder.lock(Pair::hl);
            coder.load(second, right[2], right[3]);
        }
        if (coder.failed) return;
        const uint32_t label = context.label();
        coder.emit_jump(op::kJnc, label, 0.5);
        coder.emit(by_pair(op::kInx, Pair::hl));
        coder.emit_label(label);
        if (!nothing) coder.emit(by_pair(op::kDad, second));
        coder.set(Pair::hl, results[2], results[3]);
    };
    for (const bool swapped : {false, true}) {
        for (const Pair other : {Pair::de, Pair::bc}) {
            for (unsigned keep = 0; keep < 3; ++keep) {
                add_way(ways, start, [&](Coder& coder) {
                    run(coder, swapped ? operation.right : operation.left,
                        swapped ? operation.left : operation.right, other, keep);
                });
            }
        }
    }
}

// The lowest word by DAD or DSUB, the bytes above by A with the carry that it leaves.
void run_word_chain(Coder& coder, const Chain& chain, Pair other, Pair low, const Places& upper) {
    if (other == Pair::hl) {
        if (!load_for_dsub(coder, chain.left, chain.right, 0)) return;
        coder.emit(op::kDsub);
    } else {
        dad_word(coder, chain.left, chain.right, 0, other, false);
        if (coder.failed) return;
        const bool same = chain.left[0] == chain.right[0] && chain.left[1] == chain.right[1];
        coder.emit(by_pair(op::kDad, same ? Pair::hl : other));
    }
    coder.set(Pair::hl, chain.results[0], chain.results[1]);
    if (low == Pair::hl) {
        coder.lock(Pair::hl);
    } else if (low == Pair::bc) {
        coder.lock(Pair::hl);
        make_room(coder, low, chain.left, chain.right, 2);
        if (coder.failed) return;
        coder.emit(mov(Register::c, Register::l));
        coder.emit(mov(Register::b, Register::h));
        coder.set(low, chain.results[0], chain.results[1]);
        coder.lock(low);
        coder.unlock(set_of(Pair::hl));
    } else {
        coder.store(Pair::hl);
    }
    for (std::size_t i = 2; i < chain.results.size() && !coder.failed; ++i) {
        coder.load(Register::a, chain.left[i]);
        make_room(coder, Register::a, chain.left, chain.right, i + 1);
        if (coder.failed) return;
        alu_on_a(coder, chain.next, chain.right[i]);
        coder.set(Register::a, chain.results[i]);
        coder.lock(Register::a);
        place_result(coder, chain.results[i], upper[i - 2], chain.left, chain.right, i + 1);
        coder.unlock(set_of(Register::a));
    }
    coder.leave_carry();
}

/// `low`: where the word goes; DE stands for its slot.
void add_word_chain(Ways& ways, const Coder& start, const Chain& chain, Pair other) {
    using enum Register;
    const bool byte = chain.results.size() == 3;
    const std::vector<Places> uppers =
        byte ? std::vector<Places>{{a}} : std::vector<Places>{{e, d}, {l, h}, {c, b}};
    for (const Pair low : {Pair::hl, Pair::bc, Pair::de}) {
        for (const Places& upper : uppers) {
            const bool taken = upper[0] == low_of(low) && low != Pair::de;
            if (taken) continue;
            add_way(ways, start,
                    [&](Coder& coder) { run_word_chain(coder, chain, other, low, upper); });
        }
    }
}

void add_word_chains(Ways& ways, const Coder& start, const Operation& operation) {
    if (operation.results.size() > 4) return;
    if (operation.opcode == Opcode::subtract) {
        if (!start.facts().steps.contains(Step::dsub)) return;
        const Chain chain{alu::kSub, alu::kSbb, operation.left, operation.right, operation.results};
        return add_word_chain(ways, start, chain, Pair::hl);
    }
    for (const bool swapped : {false, true}) {
        const Chain chain{alu::kAdd, alu::kAdc, swapped ? operation.right : operation.left,
                          swapped ? operation.left : operation.right, operation.results};
        for (const Pair other : {Pair::de, Pair::bc}) add_word_chain(ways, start, chain, other);
    }
}

/// The number if the operand is one.
bool small_number(const FunctionFacts& facts, const Bytes& bytes, int& number) {
    uint32_t value = 0;
    for (std::size_t i = 0; i < bytes.size(); ++i) {
        if (!facts.constant(bytes[i])) return false;
        value |= uint32_t{facts.function.bytes[bytes[i]].constant} << 8 * i;
    }
    number = bytes.size() == 1 ? static_cast<int8_t>(value) : static_cast<int16_t>(value);
    return true;
}

}  // namespace

void place_result(Coder& coder, ByteId result, Register place, const Bytes& left,
                  const Bytes& right, std::size_t from) {
    if (!coder.needed(result, true) || place == Register::a) return;
    if (place == Register::flags) {
        coder.store(Register::a);
        return;
    }
    make_room(coder, place, left, right, from);
    if (coder.failed) return;
    coder.emit(mov(place, Register::a));
    coder.set(place, result);
    coder.lock(place);
}

bool load_for_dsub(Coder& coder, const Bytes& left, const Bytes& right, std::size_t at) {
    coder.load(Pair::bc, right[at], right[at + 1]);
    coder.lock(Pair::bc);
    coder.load(Pair::hl, left[at], left[at + 1]);
    make_room(coder, Pair::hl, left, right, at + 2);
    coder.unlock(set_of(Pair::bc));
    if (!word_in(left, at, coder, Pair::hl) || !word_in(right, at, coder, Pair::bc)) {
        coder.failed = true;
    }
    return !coder.failed;
}

void add_sums(Ways& ways, const Coder& start, const Operation& operation,
              const RecipeContext& context) {
    const bool sum = operation.opcode == Opcode::add;
    const std::size_t size = operation.results.size();
    int number = 0;
    if (sum && size <= 2 && small_number(start.facts(), operation.right, number)) {
        if (size == 1 && std::abs(number) <= 2) {
            add_steps_of_byte(ways, start, operation, number);
        }
        if (size == 2) add_steps_of_word(ways, start, operation, number);
        if (size == 2) add_word_by_ldhi(ways, start, operation, number);
    }
    if (sum && size == 2) {
        add_dads(ways, start, operation);
        add_byte_to_word(ways, start, operation, context);
    }
    if (sum && size == 4) add_long_dads(ways, start, operation, context);
    if (size > 2 && start.facts().steps.contains(Step::word_chains)) {
        add_word_chains(ways, start, operation);
    }
    if (!sum && size == 2 && start.facts().steps.contains(Step::dsub)) {
        add_way(ways, start, [&](Coder& coder) {
            if (!load_for_dsub(coder, operation.left, operation.right, 0)) return;
            coder.emit(op::kDsub);
            coder.set(Pair::hl, operation.results[0], operation.results[1]);
            coder.leave_carry();
        });
    }
    const unsigned first = sum ? alu::kAdd : alu::kSub;
    const unsigned next = sum ? alu::kAdc : alu::kSbb;
    add_chains(ways, start, {first, next, operation.left, operation.right, operation.results});
    if (sum) {
        add_chains(ways, start, {first, next, operation.right, operation.left, operation.results});
    }
}

void add_logic(Ways& ways, const Coder& start, const Operation& operation) {
    const unsigned which = operation.opcode == Opcode::bit_and  ? alu::kAna
                           : operation.opcode == Opcode::bit_or ? alu::kOra
                                                                : alu::kXra;
    add_chains(ways, start, {which, which, operation.left, operation.right, operation.results});
    add_chains(ways, start, {which, which, operation.right, operation.left, operation.results});
}

}  // namespace toolchain::codegen
