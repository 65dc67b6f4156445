// recipes_memory.cpp - loads and stores.
// Depends on   recipes.hpp.
// Volatile     every way reads or writes each byte exactly once, lowest address first.
#include "toolchain/codegen/recipes.hpp"

namespace toolchain::codegen {

namespace {

bool fixed_address(const Coder& coder, const Bytes& address) {
    return coder.constant(address[0]) && coder.constant(address[1]);
}

CodeOperand operand_of(const Coder& coder, const Bytes& address, std::size_t offset) {
    const Base base = coder.facts().base_of(address[0], address[1]);
    const auto delta = base.delta + static_cast<int32_t>(offset);
    if (base.high == Base::kSymbol) {
        return {CodeOperand::Kind::symbol, CodeOperand::Part::word, base.low, delta};
    }
    return {CodeOperand::Kind::number, CodeOperand::Part::word, 0, delta & 0xFFFF};
}

bool plain_address(const Coder& coder, const Bytes& address) {
    if (!fixed_address(coder, address)) return false;
    const Base base = coder.facts().base_of(address[0], address[1]);
    return base.high == Base::kSymbol || base.high == Base::kNumber;
}

Base moved(Base base, std::size_t offset) {
    if (base.known()) base.delta += static_cast<int32_t>(offset);
    return base;
}

// Puts the result in A where the place says.
void put(Coder& coder, ByteId result, Register place) {
    coder.set(Register::a, result);
    if (!coder.needed(result, true) || place == Register::a) return;
    coder.lock(Register::a);
    if (place == Register::flags) {
        coder.store(Register::a);
    } else {
        coder.vacate(place, true);
        if (!coder.failed) {
            coder.emit(mov(place, Register::a));
            coder.set(place, result);
            coder.lock(place);
        }
    }
    coder.unlock(set_of(Register::a));
}

// -- Loads from a fixed address ------------------------------------------------------------------

void load_fixed(Coder& coder, const Operation& operation, const Places& places) {
    const Bytes& results = operation.results;
    for (std::size_t i = 0; i < results.size() && !coder.failed;) {
        const bool word =
            i + 1 < results.size() && places[i] == Register::l && places[i + 1] == Register::h;
        if (word) {
            coder.vacate(Pair::hl, true);
            if (coder.failed) return;
            coder.emit(op::kLhld, operand_of(coder, operation.left, i));
            coder.set(Pair::hl, results[i], results[i + 1]);
            coder.lock(Pair::hl);
            i += 2;
            continue;
        }
        const bool through_hl =
            i + 1 < results.size() && (places[i] == Register::e || places[i] == Register::c) &&
            places[i + 1] == high_of(places[i] == Register::e ? Pair::de : Pair::bc);
        if (through_hl && (coder.locks & set_of(Pair::hl)) == 0) {
            const Pair to = places[i] == Register::e ? Pair::de : Pair::bc;
            coder.vacate(to, true);
            coder.lock(to);
            coder.vacate(Pair::hl, true);
            if (coder.failed) return;
            coder.emit(op::kLhld, operand_of(coder, operation.left, i));
            if (to == Pair::de) {
                coder.emit(op::kXchg);
            } else {
                coder.emit(mov(Register::c, Register::l));
                coder.emit(mov(Register::b, Register::h));
            }
            coder.set(Pair::hl, kNone, kNone);
            coder.set(to, results[i], results[i + 1]);
            i += 2;
            continue;
        }
        coder.vacate(Register::a, true);
        if (coder.failed) return;
        coder.emit(op::kLda, operand_of(coder, operation.left, i));
        put(coder, results[i], places[i]);
        ++i;
    }
}

// -- Loads through a pair ------------------------------------------------------------------------

/// The pair's own halves may be among the places only for the last bytes.
bool overlaps(const Places& places, Pair pair) {
    for (const Register place : places) {
        if (place != Register::flags && place != Register::a &&
            (set_of(place) & set_of(pair)) != 0) {
            return true;
        }
    }
    return false;
}

void load_through(Coder& coder, const Operation& operation, const Places& places, Pair pair) {
    const Bytes& address = operation.left;
    const Bytes& results = operation.results;
    const std::size_t size = results.size();
    const Base base = coder.facts().base_of(address[0], address[1]);
    coder.load(pair, address[0], address[1]);
    const bool over = overlaps(places, pair);
    if (size > 1 || over) {
        coder.copy_out(pair, true, true);
    }
    coder.lock(pair);
    for (std::size_t i = 0; i < size && !coder.failed; ++i) {
        if (i > 0) {
            coder.emit(by_pair(op::kInx, pair));
            coder.set_sum(pair, moved(base, i));
        }
        const Register place = places[i];
        const bool own = over && place != Register::flags && place != Register::a &&
                         (set_of(place) & set_of(pair)) != 0;
        const bool last = i + 1 == size;
        if (own && !last) {  // kept in A until the address is used up: the last two bytes only
            if (i + 2 != size) {
                coder.failed = true;
                return;
            }
            coder.vacate(Register::a, true);
            if (coder.failed) return;
            coder.emit(pair == Pair::hl ? mov_from_memory(Register::a) : by_pair(op::kLdax, pair));
            coder.emit(by_pair(op::kInx, pair));
            if (pair != Pair::hl) {
                coder.failed = true;  // two bytes cannot both go through A
                return;
            }
            coder.emit(mov_from_memory(Register::h));
            coder.emit(mov(Register::l, Register::a));
            coder.unlock(set_of(Pair::hl));
            coder.set(Pair::hl, results[i], results[i + 1]);
            coder.set(Register::a, results[i]);
            return;
        }
        const bool by_move = !own || size == 1;
        if (pair == Pair::hl && place != Register::flags && place != Register::a && by_move) {
            if (own) coder.unlock(set_of(pair));
            coder.vacate(place, true);
            if (coder.failed) return;
            coder.emit(mov_from_memory(place));
            coder.set(place, results[i]);
            coder.lock(place);
            continue;
        }
        coder.vacate(Register::a, true);
        if (coder.failed) return;
        coder.emit(pair == Pair::hl ? mov_from_memory(Register::a) : by_pair(op::kLdax, pair));
        if (own) coder.unlock(set_of(pair));
        put(coder, results[i], place);
    }
}

/// LHLX: one or two words from where DE points. @param low  where the lower of two goes; DE stands
/// for its slot
void load_by_lhlx(Coder& coder, const Operation& operation, Pair low) {
    const Bytes& address = operation.left;
    const Bytes& results = operation.results;
    const bool two = results.size() == 4;
    coder.load(Pair::de, address[0], address[1]);
    if (two) coder.copy_out(Pair::de, true, true);
    coder.lock(Pair::de);
    coder.vacate(Pair::hl, true);
    if (coder.failed) return;
    coder.emit(op::kLhlx);
    coder.set(Pair::hl, results[0], results[1]);
    if (!two) return;
    if (low == Pair::bc) {
        coder.lock(Pair::hl);
        coder.vacate(low, true);
        if (coder.failed) return;
        coder.emit(mov(Register::c, Register::l));
        coder.emit(mov(Register::b, Register::h));
        coder.set(low, results[0], results[1]);
        coder.lock(low);
    } else {
        coder.store(Pair::hl);
    }
    const Base base = coder.facts().base_of(address[0], address[1]);
    coder.emit(by_pair(op::kInx, Pair::de));
    coder.emit(by_pair(op::kInx, Pair::de));
    coder.set_sum(Pair::de, moved(base, 2));
    coder.emit(op::kLhlx);
    coder.set(Pair::hl, results[2], results[3]);
}

// -- Stores --------------------------------------------------------------------------------------

void store_fixed(Coder& coder, const Operation& operation, bool words) {
    const Bytes& value = operation.right;
    for (std::size_t i = 0; i < value.size() && !coder.failed;) {
        if (words && i + 1 < value.size()) {
            coder.load(Pair::hl, value[i], value[i + 1]);
            if (coder.failed) return;
            coder.emit(op::kShld, operand_of(coder, operation.left, i));
            i += 2;
            continue;
        }
        coder.load(Register::a, value[i]);
        if (coder.failed) return;
        coder.emit(op::kSta, operand_of(coder, operation.left, i));
        ++i;
    }
}

void store_byte(Coder& coder, ByteId byte, Pair pair) {
    const Register from = coder.find(byte);
    if (pair == Pair::hl && from != Register::flags) {
        coder.emit(mov_to_memory(from));
        return;
    }
    if (pair == Pair::hl && coder.facts().constant(byte)) {
        coder.emit_number(op::kMviM, coder.facts().function.bytes[byte].constant);
        return;
    }
    if (!coder.facts().undefined(byte)) coder.load(Register::a, byte);
    if (coder.failed) return;
    coder.emit(pair == Pair::hl ? mov_to_memory(Register::a) : by_pair(op::kStax, pair));
}

/// SHLX: one or two words to where DE points.
void store_by_shlx(Coder& coder, const Operation& operation, bool address_first) {
    const Bytes& address = operation.left;
    const Bytes& value = operation.right;
    if (address_first) {
        coder.load(Pair::de, address[0], address[1]);
        coder.lock(Pair::de);
    }
    coder.load(Pair::hl, value[0], value[1]);
    coder.lock(Pair::hl);
    if (!address_first) coder.load(Pair::de, address[0], address[1]);
    const bool two = value.size() == 4;
    coder.unlock(set_of(Pair::de));
    if (two) coder.copy_out(Pair::de, !occurs(value, address[0]), !occurs(value, address[1]));
    coder.lock(Pair::de);
    if (coder.failed) return;
    coder.emit(op::kShlx);
    if (!two) return;
    const Base base = coder.facts().base_of(address[0], address[1]);
    coder.emit(by_pair(op::kInx, Pair::de));
    coder.emit(by_pair(op::kInx, Pair::de));
    coder.set_sum(Pair::de, moved(base, 2));
    coder.unlock(set_of(Pair::hl));
    coder.load(Pair::hl, value[2], value[3]);
    if (coder.failed) return;
    coder.emit(op::kShlx);
}

void store_through(Coder& coder, const Operation& operation, Pair pair, Register preload) {
    const Bytes& address = operation.left;
    const Bytes& value = operation.right;
    const Base base = coder.facts().base_of(address[0], address[1]);
    if (preload != Register::flags) {
        if (preload == Register::a) {
            coder.load(Register::a, value[0]);
            coder.lock(Register::a);
        } else {
            const auto with = static_cast<Pair>(static_cast<unsigned>(preload) / 2);
            coder.load(with, value[0], value[1]);
            coder.lock(with);
        }
    }
    coder.load(pair, address[0], address[1]);
    if (value.size() > 1) {
        // The address may itself be stored: its bytes are read before they change, or kept.
        coder.copy_out(pair, !occurs(value, address[0]), !occurs(value, address[1]));
    }
    coder.lock(pair);
    for (std::size_t i = 0; i < value.size() && !coder.failed; ++i) {
        if (i > 0) {
            coder.emit(by_pair(op::kInx, pair));
            coder.set_sum(pair, moved(base, i));
        }
        store_byte(coder, value[i], pair);
    }
}

}  // namespace

void add_loads(Ways& ways, const Coder& start, const Operation& operation) {
    const std::size_t size = operation.results.size();
    std::vector<Places> choices = places_for(size);
    if (start.facts().steps.contains(Step::lhlx) && (size == 2 || size == 4)) {
        for (const Pair low : {Pair::bc, Pair::de}) {
            if (size == 2 && low == Pair::de) continue;
            add_way(ways, start, [&](Coder& coder) { load_by_lhlx(coder, operation, low); });
        }
    }
    if (size == 1) {
        for (const Register which : kRegisters) choices.push_back({which});
    }
    for (const Places& places : choices) {
        if (plain_address(start, operation.left)) {
            add_way(ways, start, [&](Coder& coder) { load_fixed(coder, operation, places); });
        }
        for (const Pair pair : kPairs) {
            add_way(ways, start,
                    [&](Coder& coder) { load_through(coder, operation, places, pair); });
        }
    }
}

void add_stores(Ways& ways, const Coder& start, const Operation& operation) {
    if (plain_address(start, operation.left)) {
        for (const bool words : {false, true}) {
            if (words && operation.right.size() == 1) continue;
            add_way(ways, start, [&](Coder& coder) { store_fixed(coder, operation, words); });
        }
    }
    const std::size_t size = operation.right.size();
    if (start.facts().steps.contains(Step::shlx) && (size == 2 || size == 4)) {
        for (const bool address_first : {false, true}) {
            add_way(ways, start,
                    [&](Coder& coder) { store_by_shlx(coder, operation, address_first); });
        }
    }
    for (const Pair pair : kPairs) {
        add_way(ways, start,
                [&](Coder& coder) { store_through(coder, operation, pair, Register::flags); });
        add_way(ways, start,
                [&](Coder& coder) { store_through(coder, operation, pair, Register::a); });
        for (const Register with : {Register::e, Register::c, Register::l}) {
            const bool own = (set_of(with) & set_of(pair)) != 0;
            if (own || operation.right.size() < 2) continue;
            add_way(ways, start,
                    [&](Coder& coder) { store_through(coder, operation, pair, with); });
        }
    }
}

}  // namespace toolchain::codegen
