// recipes_call.cpp - calls, ports and the processor's own instructions.
// Depends on   recipes.hpp.
#include <algorithm>
#include <array>

#include "toolchain/codegen/recipes.hpp"

namespace toolchain::codegen {

namespace {

constexpr std::size_t kUnits = 4;  // HL, DE, BC, A

RegisterSet unit_registers(std::size_t unit) {
    return unit == 3 ? set_of(Register::a) : set_of(kPairs[unit]);
}

void lock_right_ones(Coder& coder, const Wanted& wanted) {
    for (const Register which : kRegisters) {
        const ByteId byte = wanted[static_cast<unsigned>(which)];
        if (byte != kNone && coder.content(which) == byte) coder.lock(which);
    }
}

void bring_unit(Coder& coder, const Wanted& wanted, std::size_t unit) {
    if (unit == 3) {
        const ByteId byte = wanted[static_cast<unsigned>(Register::a)];
        if (byte == kNone) return;
        coder.load(Register::a, byte);
        coder.lock(Register::a);
        return;
    }
    const Pair pair = kPairs[unit];
    const ByteId low = wanted[static_cast<unsigned>(low_of(pair))];
    const ByteId high = wanted[static_cast<unsigned>(high_of(pair))];
    if (low != kNone && high != kNone) {
        coder.load(pair, low, high);
        coder.lock(pair);
    } else if (low != kNone) {
        coder.load(low_of(pair), low);
        coder.lock(low_of(pair));
    } else if (high != kNone) {
        coder.load(high_of(pair), high);
        coder.lock(high_of(pair));
    }
}

bool all_there(const Coder& coder, const Wanted& wanted) {
    for (const Register which : kRegisters) {
        const ByteId byte = wanted[static_cast<unsigned>(which)];
        if (byte != kNone && !coder.holds(which, byte)) return false;
    }
    return true;
}

}  // namespace

// Every order in which the pairs can be filled, the cheapest wins.
bool bring(Coder& coder, const Wanted& wanted) {
    if (all_there(coder, wanted)) return !coder.failed;
    std::array<std::size_t, kUnits> order{};
    std::size_t count = 0;
    for (std::size_t unit = 0; unit < kUnits; ++unit) {
        for (const Register which : kRegisters) {
            const ByteId byte = wanted[static_cast<unsigned>(which)];
            if ((unit_registers(unit) & set_of(which)) != 0 && byte != kNone &&
                !coder.holds(which, byte)) {
                order[count++] = unit;
                break;
            }
        }
    }
    const Coder start = coder;
    bool found = false;
    do {
        for (const bool lock_first : {true, false}) {
            Coder way = start;
            if (lock_first) lock_right_ones(way, wanted);
            for (std::size_t i = 0; i < count && !way.failed; ++i) {
                bring_unit(way, wanted, order[i]);
            }
            if (way.failed || !all_there(way, wanted)) continue;
            way.locks = start.locks;
            if (!found || way.cost < coder.cost) coder = std::move(way);
            found = true;
        }
    } while (std::next_permutation(order.begin(), order.begin() + static_cast<long>(count)));
    return found;
}

namespace {

RegisterSet destroyed_by(const Operation& operation, const RecipeContext& context) {
    RegisterSet destroyed = operation.clobbers;
    if (operation.clobbers == kAllRegisters && operation.opcode == Opcode::call &&
        context.clobbers_of != nullptr) {
        destroyed = context.clobbers_of(context.clobbers_data, operation.symbol);
    }
    for (const Register which : operation.result_registers) {
        destroyed |= set_of(which);
    }
    return destroyed;
}

Wanted wanted_arguments(const Operation& operation) {
    Wanted wanted;
    wanted.fill(kNone);
    if (operation.arguments.empty()) return wanted;
    for (std::size_t i = 0; i < operation.arguments[0].size(); ++i) {
        wanted[static_cast<unsigned>(operation.argument_registers[i])] = operation.arguments[0][i];
    }
    return wanted;
}

void finish_call(Coder& coder, const Operation& operation, RegisterSet destroyed) {
    coder.forget(destroyed);
    for (std::size_t i = 0; i < operation.results.size(); ++i) {
        coder.set(operation.result_registers[i], operation.results[i]);
    }
}

CodeOperand symbol_operand(SymbolId symbol) {
    return {CodeOperand::Kind::symbol, CodeOperand::Part::word, symbol, 0};
}

void emit_call(Coder& coder, const Operation& operation, RegisterSet destroyed) {
    coder.emit(op::kCall, symbol_operand(operation.symbol));
    if (coder.only_cost) return;
    CodeItem& item = coder.items.back();
    for (const Register which : operation.argument_registers) item.reads |= set_of(which);
    item.writes = destroyed;
}

/// Pairs whose values live on behind the call and have no other place.
std::vector<Pair> pairs_at_risk(const Coder& coder, RegisterSet destroyed) {
    std::vector<Pair> result;
    for (const Pair pair : kPairs) {
        const bool low = (destroyed & set_of(low_of(pair))) != 0 &&
                         coder.only_copy(low_of(pair), true, destroyed);
        const bool high = (destroyed & set_of(high_of(pair))) != 0 &&
                          coder.only_copy(high_of(pair), true, destroyed);
        if (low || high) result.push_back(pair);
    }
    return result;
}

void lock_wanted(Coder& coder, const Operation& operation) {
    for (const Register which : operation.argument_registers) coder.lock(which);
}

void call_with_slots(Coder& coder, const Operation& operation, RegisterSet destroyed) {
    coder.save_from(destroyed);
    if (coder.failed || !bring(coder, wanted_arguments(operation))) {
        coder.failed = true;
        return;
    }
    // Bringing may have moved something to where the call destroys it.
    lock_wanted(coder, operation);
    coder.save_from(destroyed);
    for (const Register which : kRegisters) {
        if ((destroyed & set_of(which)) != 0 && coder.only_copy(which, true, destroyed)) {
            coder.failed = true;
        }
    }
    emit_call(coder, operation, destroyed);
    finish_call(coder, operation, destroyed);
}

// PUSH and POP around the call keep a pair that no result comes in.
void call_with_stack(Coder& coder, const Operation& operation, RegisterSet destroyed) {
    const std::vector<Pair> risky = pairs_at_risk(coder, destroyed);
    std::vector<std::pair<Pair, std::array<ByteId, 2>>> kept;
    for (const Pair pair : risky) {
        bool result_there = false;
        for (const Register which : operation.result_registers) {
            result_there = result_there || (set_of(pair) & set_of(which)) != 0;
        }
        if (result_there) continue;
        coder.emit(by_pair(op::kPush, pair));
        kept.push_back({pair, {coder.content(low_of(pair)), coder.content(high_of(pair))}});
    }
    if (kept.empty()) {
        coder.failed = true;
        return;
    }
    RegisterSet rest = destroyed;
    for (const auto& [pair, bytes] : kept) rest &= static_cast<RegisterSet>(~set_of(pair));
    coder.save_from(rest);
    if (coder.failed || !bring(coder, wanted_arguments(operation))) {
        coder.failed = true;
        return;
    }
    lock_wanted(coder, operation);
    coder.save_from(rest);
    // What was not pushed must not be where the call destroys it.
    for (const Register which : kRegisters) {
        if ((destroyed & set_of(which)) == 0 || !coder.only_copy(which, true, destroyed)) continue;
        bool pushed = false;
        for (const auto& [pair, bytes] : kept) {
            pushed = pushed || bytes[0] == coder.content(which) || bytes[1] == coder.content(which);
        }
        if (!pushed) coder.failed = true;
    }
    emit_call(coder, operation, destroyed);
    finish_call(coder, operation, destroyed);
    for (auto at = kept.rbegin(); at != kept.rend(); ++at) {
        coder.emit(by_pair(op::kPop, at->first));
        coder.set(at->first, at->second[0], at->second[1]);
    }
}

// A call that may come back here: what lives on is on the stack, not in the static frame.
void call_that_reenters(Coder& coder, const Operation& operation) {
    coder.save_from(kAllRegisters);
    std::vector<ByteId> saved;
    for (const ByteId byte : coder.block().relevant) {
        if (!coder.needed(byte, true) || occurs(operation.results, byte)) continue;
        if (!coder.in_slot(byte)) continue;  // not made yet
        saved.push_back(byte);
    }
    for (const Register which : kRegisters) {
        if (coder.only_copy(which, true, kAllRegisters)) coder.failed = true;
    }
    if (coder.failed) return;
    // A goes onto the stack with the flags; arguments are fetched again from slots or registers.
    if (!saved.empty()) {
        for (const Register which : kRegisters) {
            if (which == Register::a && coder.only_copy(which, false)) coder.spill(which);
        }
    }
    for (const ByteId byte : saved) {
        coder.emit(op::kLda, coder.slot(byte));
        coder.set(Register::a, byte);
        coder.emit(op::kPushPsw);
    }
    if (coder.failed || !bring(coder, wanted_arguments(operation))) {
        coder.failed = true;
        return;
    }
    emit_call(coder, operation, kAllRegisters);
    finish_call(coder, operation, kAllRegisters);
    coder.state.in_slot = Bits(coder.block().relevant.size());  // the frame was used again
    if (saved.empty()) return;
    const bool in_a = coder.content(Register::a) != kNone;
    if (in_a) {
        coder.emit(mov(Register::c, Register::a));
        coder.set(Register::c, coder.content(Register::a));
    }
    for (auto at = saved.rbegin(); at != saved.rend(); ++at) {
        coder.emit(op::kPopPsw);
        coder.set(Register::a, *at);
        coder.emit(op::kSta, coder.slot(*at));
        coder.mark_stored(*at);
    }
}

struct ProcessorCode {
    Opcode opcode;
    uint8_t code;
};
constexpr std::array<ProcessorCode, 6> kProcessorCodes = {{
    {Opcode::enable_interrupts, op::kEi},
    {Opcode::disable_interrupts, op::kDi},
    {Opcode::halt, op::kHlt},
    {Opcode::read_mask, op::kRim},
    {Opcode::set_mask, op::kSim},
    {Opcode::no_operation, op::kNop},
}};

void processor_code(Coder& coder, const Operation& operation) {
    const bool takes = operation.opcode == Opcode::port_out || operation.opcode == Opcode::set_mask;
    if (takes)
        coder.load(Register::a,
                   operation.right.empty() ? operation.left.at(0) : operation.right[0]);
    const bool gives = !operation.results.empty();
    const bool reads = operation.opcode == Opcode::port_in || operation.opcode == Opcode::read_mask;
    if (gives || reads) coder.vacate(Register::a, true);
    if (coder.failed) return;
    if (operation.opcode == Opcode::port_in) {
        coder.emit_number(op::kIn, operation.immediate);
    } else if (operation.opcode == Opcode::port_out) {
        coder.emit_number(op::kOut, operation.immediate);
    } else {
        for (const ProcessorCode& known : kProcessorCodes) {
            if (known.opcode == operation.opcode) coder.emit(known.code);
        }
    }
    if (gives || reads) coder.set(Register::a, gives ? operation.results[0] : kNone);
}

void stack_address(Coder& coder, const Operation& operation) {
    coder.vacate(Pair::hl, true);
    if (coder.failed) return;
    coder.emit_number(by_pair(op::kLxi, Pair::hl), static_cast<int32_t>(operation.immediate16));
    coder.emit(op::kDadSp);
    coder.set(Pair::hl, operation.results[0], operation.results[1]);
}

}  // namespace

void add_calls(Ways& ways, const Coder& start, const Operation& operation,
               const RecipeContext& context) {
    if (operation.opcode == Opcode::stack_address) {
        add_way(ways, start, [&](Coder& coder) { stack_address(coder, operation); });
        return;
    }
    if (operation.opcode != Opcode::call && operation.opcode != Opcode::call_indirect) {
        add_way(ways, start, [&](Coder& coder) { processor_code(coder, operation); });
        return;
    }
    if (operation.reenters) {
        add_way(ways, start, [&](Coder& coder) { call_that_reenters(coder, operation); });
        return;
    }
    const RegisterSet destroyed = destroyed_by(operation, context);
    add_way(ways, start, [&](Coder& coder) { call_with_slots(coder, operation, destroyed); });
    add_way(ways, start, [&](Coder& coder) { call_with_stack(coder, operation, destroyed); });
}

}  // namespace toolchain::codegen
