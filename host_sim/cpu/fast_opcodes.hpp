// fast_opcodes.hpp - every opcode of the fast interpreter, decoded from its bits at compile time.
// Depends on   fast_operations.hpp.
// Rule         execute<opcode>() returns its T-states, or kLeftToHost with nothing changed. It is
//              entered with PC behind the opcode.
#pragma once

#include <cstdint>

#include "host_sim/cpu/fast_operations.hpp"

namespace host_sim::fast {

/// The instruction has not been executed: the host must.
inline constexpr int kLeftToHost = -1;

/// The second instruction byte.
[[gnu::always_inline]] inline uint32_t immediate(const Registers& r, const FlatMemory& memory) {
    return load(memory, r.pc);
}
/// The second and third.
[[gnu::always_inline]] inline uint32_t immediate_word(const Registers& r,
                                                      const FlatMemory& memory) {
    return load_word(memory, r.pc);
}
/// Steps over the operand bytes and tells the instruction's T-states.
template <unsigned kOperandBytes>
[[gnu::always_inline]] inline int done(Registers& r, int t_states) {
    r.pc = word(r.pc + kOperandBytes);
    return t_states;
}

/// 40-7F: MOV and HLT.
template <uint8_t kOpcode>
[[gnu::always_inline]] inline int execute_move(Registers& r, FlatMemory& memory) {
    constexpr unsigned kTo = kOpcode >> 3 & 7;
    constexpr unsigned kFrom = kOpcode & 7;
    if constexpr (kTo == kMemory && kFrom == kMemory) {
        return kLeftToHost;  // HLT
    } else if constexpr (kFrom == kMemory) {
        reg<kTo>(r) = load(memory, pair<Pair::hl>(r));
        return 7;
    } else if constexpr (kTo == kMemory) {
        return store(memory, pair<Pair::hl>(r), reg<kFrom>(r)) ? 7 : kLeftToHost;
    } else {
        reg<kTo>(r) = reg<kFrom>(r);
        return 4;
    }
}

/// 80-BF: arithmetic and logic with a register or memory.
template <uint8_t kOpcode>
[[gnu::always_inline]] inline int execute_arithmetic(Registers& r, FlatMemory& memory) {
    constexpr unsigned kFrom = kOpcode & 7;
    if constexpr (kFrom == kMemory) {
        arithmetic<(kOpcode >> 3 & 7)>(r, load(memory, pair<Pair::hl>(r)));
        return 7;
    } else {
        arithmetic<(kOpcode >> 3 & 7)>(r, reg<kFrom>(r));
        return 4;
    }
}

/// INR and DCR.
template <unsigned kRegister, bool kUp>
[[gnu::always_inline]] inline int execute_step(Registers& r, FlatMemory& memory) {
    if constexpr (kRegister == kMemory) {
        const uint32_t address = pair<Pair::hl>(r);
        if (!writable(memory, address)) return kLeftToHost;
        put(memory, address, step<kUp>(r, load(memory, address)));
        return 10;
    } else {
        reg<kRegister>(r) = step<kUp>(r, reg<kRegister>(r));
        return 4;
    }
}

/// MVI.
template <unsigned kRegister>
[[gnu::always_inline]] inline int execute_move_immediate(Registers& r, FlatMemory& memory) {
    const uint32_t value = immediate(r, memory);
    if constexpr (kRegister == kMemory) {
        if (!store(memory, pair<Pair::hl>(r), value)) return kLeftToHost;
        return done<1>(r, 10);
    } else {
        reg<kRegister>(r) = value;
        return done<1>(r, 7);
    }
}

/// INX and DCX; K is the carry or borrow of the count.
template <Pair kPair, bool kUp>
[[gnu::always_inline]] inline int execute_count(Registers& r) {
    const uint32_t old = pair<kPair>(r);
    const uint32_t counted = word(kUp ? old + 1 : old - 1);
    r.k_source = kUp ? counted : old;
    set_pair<kPair>(r, counted);
    return 6;
}

/// 02-3A, column 2 and A: STAX, LDAX, SHLD, LHLD, STA, LDA.
template <uint8_t kOpcode>
[[gnu::always_inline]] inline int execute_transfer(Registers& r, FlatMemory& memory) {
    constexpr auto kPair = static_cast<Pair>(kOpcode >> 4);
    if constexpr (kOpcode == 0x02 || kOpcode == 0x12) {
        return store(memory, pair<kPair>(r), r.a) ? 7 : kLeftToHost;
    } else if constexpr (kOpcode == 0x0A || kOpcode == 0x1A) {
        r.a = load(memory, pair<kPair>(r));
        return 7;
    } else if constexpr (kOpcode == 0x22) {
        const uint32_t address = immediate_word(r, memory);
        if (!store_word(memory, address, pair<Pair::hl>(r))) return kLeftToHost;
        return done<2>(r, 16);
    } else if constexpr (kOpcode == 0x2A) {
        set_pair<Pair::hl>(r, load_word(memory, immediate_word(r, memory)));
        return done<2>(r, 16);
    } else if constexpr (kOpcode == 0x32) {
        if (!store(memory, immediate_word(r, memory), r.a)) return kLeftToHost;
        return done<2>(r, 13);
    } else {
        r.a = load(memory, immediate_word(r, memory));
        return done<2>(r, 13);
    }
}

/// 00-38, column 0 and 8: NOP and undocumented instructions; RIM and SIM are the host's.
template <uint8_t kOpcode>
[[gnu::always_inline]] inline int execute_column_0(Registers& r, FlatMemory& memory) {
    if constexpr (kOpcode == 0x00) return 4;
    if constexpr (kOpcode == 0x08) {
        double_subtract(r);
        return 10;
    }
    if constexpr (kOpcode == 0x10) {
        const uint32_t old = pair<Pair::hl>(r);
        r.carry = old & 1;
        set_pair<Pair::hl>(r, old >> 1 | (old & 0x8000));
        return 7;
    }
    if constexpr (kOpcode == 0x18) {
        rotate_de(r);
        return 10;
    }
    if constexpr (kOpcode == 0x28 || kOpcode == 0x38) {
        constexpr Pair kBase = kOpcode == 0x28 ? Pair::hl : Pair::sp;
        set_pair<Pair::de>(r, word(pair<kBase>(r) + immediate(r, memory)));
        return done<1>(r, 10);
    }
    return kLeftToHost;
}

/// 07-3F, column 7 and F: rotates, CMA, STC, CMC; DAA is the host's.
template <unsigned kOperation>
[[gnu::always_inline]] inline int execute_accumulator(Registers& r) {
    if constexpr (kOperation < 4) rotate<kOperation>(r);
    if constexpr (kOperation == 4) return kLeftToHost;
    if constexpr (kOperation == 5) r.a ^= 0xFF;
    if constexpr (kOperation == 6) r.carry = 1;
    if constexpr (kOperation == 7) r.carry ^= 1;
    return 4;
}

/// 00-3F.
template <uint8_t kOpcode>
[[gnu::always_inline]] inline int execute_first_quarter(Registers& r, FlatMemory& memory) {
    constexpr unsigned kRow = kOpcode >> 3;
    constexpr unsigned kColumn = kOpcode & 7;
    constexpr auto kPair = static_cast<Pair>(kRow >> 1);
    if constexpr (kColumn == 0) return execute_column_0<kOpcode>(r, memory);
    if constexpr (kColumn == 1 && kRow % 2 == 0) {
        set_pair<kPair>(r, immediate_word(r, memory));
        return done<2>(r, 10);
    }
    if constexpr (kColumn == 1) {
        double_add(r, pair<kPair>(r));
        return 10;
    }
    if constexpr (kColumn == 2) return execute_transfer<kOpcode>(r, memory);
    if constexpr (kColumn == 3) return execute_count < kPair, kRow % 2 == 0 > (r);
    if constexpr (kColumn == 4) return execute_step<kRow, true>(r, memory);
    if constexpr (kColumn == 5) return execute_step<kRow, false>(r, memory);
    if constexpr (kColumn == 6) return execute_move_immediate<kRow>(r, memory);
    if constexpr (kColumn == 7) return execute_accumulator<kRow>(r);
}

[[gnu::always_inline]] inline int return_if(Registers& r, const FlatMemory& memory, bool taken) {
    if (!taken) return 6;
    r.pc = pop(r, memory);
    return 12;
}
[[gnu::always_inline]] inline int jump_if(Registers& r, const FlatMemory& memory, bool taken) {
    if (!taken) return done<2>(r, 7);
    r.pc = immediate_word(r, memory);
    return 10;
}
[[gnu::always_inline]] inline int call_if(Registers& r, FlatMemory& memory, bool taken) {
    if (!taken) return done<2>(r, 9);
    return call(r, memory, immediate_word(r, memory), word(r.pc + 2)) ? 18 : kLeftToHost;
}

/// C1-F1 and C5-F5: POP and PUSH.
template <uint8_t kOpcode>
[[gnu::always_inline]] inline int execute_stack(Registers& r, FlatMemory& memory) {
    constexpr auto kPair = static_cast<Pair>(kOpcode >> 4 & 3);
    constexpr bool kPush = (kOpcode & 4) != 0;
    if constexpr (kPush) {
        const uint32_t value = kPair == Pair::sp ? r.a << 8 | r.flags() : pair<kPair>(r);
        return push(r, memory, value) ? 12 : kLeftToHost;
    } else if constexpr (kPair == Pair::sp) {
        const uint32_t value = pop(r, memory);
        r.a = value >> 8;
        r.set_flags(value & 0xFF);
        return 10;
    } else {
        set_pair<kPair>(r, pop(r, memory));
        return 10;
    }
}

/// Opcodes of C0-FF that share no column with others.
template <uint8_t kOpcode>
[[gnu::always_inline]] inline int execute_single(Registers& r, FlatMemory& memory) {
    if constexpr (kOpcode == 0xC3) return jump_if(r, memory, true);
    if constexpr (kOpcode == 0xC9) return return_if(r, memory, true) - 2;  // RET: 10 T-states
    if constexpr (kOpcode == 0xCD) return call_if(r, memory, true);
    if constexpr (kOpcode == 0xDD) return jump_if(r, memory, !r.k());
    if constexpr (kOpcode == 0xFD) return jump_if(r, memory, r.k());
    if constexpr (kOpcode == 0xCB) {
        if (!r.v()) return 6;
        return call(r, memory, 0x0040, r.pc) ? 12 : kLeftToHost;
    }
    if constexpr (kOpcode == 0xD9) {
        return store_word(memory, pair<Pair::de>(r), pair<Pair::hl>(r)) ? 10 : kLeftToHost;
    }
    if constexpr (kOpcode == 0xED) {
        set_pair<Pair::hl>(r, load_word(memory, pair<Pair::de>(r)));
        return 10;
    }
    if constexpr (kOpcode == 0xE3) {
        const uint32_t top = load_word(memory, r.sp);
        if (!store_word(memory, r.sp, pair<Pair::hl>(r))) return kLeftToHost;
        set_pair<Pair::hl>(r, top);
        return 16;
    }
    if constexpr (kOpcode == 0xE9) {
        r.pc = pair<Pair::hl>(r);
        return 6;
    }
    if constexpr (kOpcode == 0xEB) {
        const uint32_t old = pair<Pair::hl>(r);
        set_pair<Pair::hl>(r, pair<Pair::de>(r));
        set_pair<Pair::de>(r, old);
        return 4;
    }
    if constexpr (kOpcode == 0xF9) {
        r.sp = pair<Pair::hl>(r);
        return 6;
    }
    return kLeftToHost;  // IN, OUT, EI, DI
}

/// C0-FF.
template <uint8_t kOpcode>
[[gnu::always_inline]] inline int execute_last_quarter(Registers& r, FlatMemory& memory) {
    constexpr unsigned kRow = kOpcode >> 3 & 7;
    constexpr unsigned kColumn = kOpcode & 7;
    if constexpr (kColumn == 0) return return_if(r, memory, holds<kRow>(r));
    if constexpr (kColumn == 2) return jump_if(r, memory, holds<kRow>(r));
    if constexpr (kColumn == 4) return call_if(r, memory, holds<kRow>(r));
    if constexpr (kColumn == 6) {
        arithmetic<kRow>(r, immediate(r, memory));
        return done<1>(r, 7);
    }
    if constexpr (kColumn == 7) return call(r, memory, kRow * 8, r.pc) ? 12 : kLeftToHost;
    if constexpr ((kColumn == 1 || kColumn == 5) && kRow % 2 == 0) {
        return execute_stack<kOpcode>(r, memory);
    }
    return execute_single<kOpcode>(r, memory);
}

template <uint8_t kOpcode>
[[gnu::always_inline]] inline int execute(Registers& r, FlatMemory& memory) {
    if constexpr (kOpcode < 0x40) return execute_first_quarter<kOpcode>(r, memory);
    if constexpr (kOpcode >= 0x40 && kOpcode < 0x80) return execute_move<kOpcode>(r, memory);
    if constexpr (kOpcode >= 0x80 && kOpcode < 0xC0) return execute_arithmetic<kOpcode>(r, memory);
    if constexpr (kOpcode >= 0xC0) return execute_last_quarter<kOpcode>(r, memory);
}

}  // namespace host_sim::fast
