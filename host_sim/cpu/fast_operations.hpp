// fast_operations.hpp - the fast interpreter's memory accesses, stack, arithmetic and conditions.
// Depends on   fast_registers.hpp, flat_memory.hpp.
#pragma once

#include <cstdint>

#include "host_sim/cpu/fast_registers.hpp"
#include "host_sim/cpu/flat_memory.hpp"

namespace host_sim::fast {

/// Register pairs in opcode order, of LXI, INX, DAD and so on.
enum class Pair : uint8_t { bc, de, hl, sp };

/// Registers in opcode order; 6 is the byte that HL points to.
inline constexpr unsigned kMemory = 6;

template <unsigned kRegister>
[[gnu::always_inline]] inline uint32_t& reg(Registers& r) {
    static_assert(kRegister < 8 && kRegister != kMemory);
    if constexpr (kRegister == 0) return r.b;
    if constexpr (kRegister == 1) return r.c;
    if constexpr (kRegister == 2) return r.d;
    if constexpr (kRegister == 3) return r.e;
    if constexpr (kRegister == 4) return r.h;
    if constexpr (kRegister == 5) return r.l;
    return r.a;
}

template <Pair kPair>
[[gnu::always_inline]] inline uint32_t pair(const Registers& r) {
    if constexpr (kPair == Pair::bc) return r.b << 8 | r.c;
    if constexpr (kPair == Pair::de) return r.d << 8 | r.e;
    if constexpr (kPair == Pair::hl) return r.h << 8 | r.l;
    return r.sp;
}

template <Pair kPair>
[[gnu::always_inline]] inline void set_pair(Registers& r, uint32_t value) {
    if constexpr (kPair == Pair::bc) r.b = value >> 8, r.c = value & 0xFF;
    if constexpr (kPair == Pair::de) r.d = value >> 8, r.e = value & 0xFF;
    if constexpr (kPair == Pair::hl) r.h = value >> 8, r.l = value & 0xFF;
    if constexpr (kPair == Pair::sp) r.sp = value;
}

constexpr uint32_t word(uint32_t value) {
    return static_cast<uint16_t>(value);
}

[[gnu::always_inline]] inline uint32_t load(const FlatMemory& memory, uint32_t address) {
    return memory.bytes[address];
}
[[gnu::always_inline]] inline uint32_t load_word(const FlatMemory& memory, uint32_t address) {
    return load(memory, address) | load(memory, word(address + 1)) << 8;
}
[[gnu::always_inline]] inline bool writable(const FlatMemory& memory, uint32_t address) {
    return __builtin_expect(memory.page_writable[address / kPageSize], true);
}
[[gnu::always_inline]] inline void put(FlatMemory& memory, uint32_t address, uint32_t value) {
    memory.bytes[address] = static_cast<uint8_t>(value);
}
[[gnu::always_inline]] inline bool store(FlatMemory& memory, uint32_t address, uint32_t value) {
    if (!writable(memory, address)) return false;
    put(memory, address, value);
    return true;
}
[[gnu::always_inline]] inline bool store_word(FlatMemory& memory, uint32_t address,
                                              uint32_t value) {
    const uint32_t next = word(address + 1);
    if (!writable(memory, address) || !writable(memory, next)) return false;
    put(memory, address, value);
    put(memory, next, value >> 8);
    return true;
}
[[gnu::always_inline]] inline bool push(Registers& r, FlatMemory& memory, uint32_t value) {
    const uint32_t address = word(r.sp - 2);
    if (!store_word(memory, address, value)) return false;
    r.sp = address;
    return true;
}
[[gnu::always_inline]] inline uint32_t pop(Registers& r, const FlatMemory& memory) {
    const uint32_t value = load_word(memory, r.sp);
    r.sp = word(r.sp + 2);
    return value;
}
[[gnu::always_inline]] inline bool call(Registers& r, FlatMemory& memory, uint32_t address,
                                        uint32_t return_address) {
    if (!push(r, memory, return_address)) return false;
    r.pc = address;
    return true;
}

// -- Arithmetic
// ------------------------------------------------------------------------------------

[[gnu::always_inline]] inline void add(Registers& r, uint32_t value, uint32_t carry) {
    const uint32_t sum = r.a + value + carry;
    r.carries = r.a ^ value ^ sum;
    r.carry = sum >> 8;
    r.a = r.result = sum & 0xFF;
    r.k_source = kKIsVXorS;
}
// Leaves the difference in `result` only.
[[gnu::always_inline]] inline void compare(Registers& r, uint32_t value, uint32_t borrow) {
    const uint32_t difference = r.a - value - borrow;
    r.carries = r.a ^ value ^ difference ^ flag::kAuxiliaryCarry;
    r.carry = difference >> 8 & 1;
    r.result = difference & 0xFF;
    r.k_source = kKIsVXorS;
}
[[gnu::always_inline]] inline void logic(Registers& r, uint32_t value, uint32_t auxiliary_carry) {
    r.a = r.result = value;
    r.carries = auxiliary_carry;
    r.carry = 0;
    r.k_source = kKIsVXorS;
}

/// ADD ADC SUB SBB ANA XRA ORA CMP in opcode order.
template <unsigned kOperation>
[[gnu::always_inline]] inline void arithmetic(Registers& r, uint32_t value) {
    if constexpr (kOperation == 0) add(r, value, 0);
    if constexpr (kOperation == 1) add(r, value, r.carry);
    if constexpr (kOperation == 2) compare(r, value, 0), r.a = r.result;
    if constexpr (kOperation == 3) compare(r, value, r.carry), r.a = r.result;
    if constexpr (kOperation == 4) logic(r, r.a & value, flag::kAuxiliaryCarry);
    if constexpr (kOperation == 5) logic(r, r.a ^ value, 0);
    if constexpr (kOperation == 6) logic(r, r.a | value, 0);
    if constexpr (kOperation == 7) compare(r, value, 0);
}

/// value + 1 or - 1 with the flags of INR or DCR.
template <bool kUp>
[[gnu::always_inline]] inline uint32_t step(Registers& r, uint32_t value) {
    const uint32_t changed = kUp ? value + 1 : value - 1;
    r.carries = value ^ 1 ^ changed ^ (kUp ? 0 : flag::kAuxiliaryCarry);
    r.result = changed & 0xFF;
    r.k_source = kKIsVXorS;
    return r.result;
}

/// V as given by bits 7 and 8 of `carries`; AC stays.
[[gnu::always_inline]] inline void set_overflow(Registers& r, uint32_t carries) {
    r.carries = (r.carries & flag::kAuxiliaryCarry) | (carries & 0x180);
}
[[gnu::always_inline]] inline void double_add(Registers& r, uint32_t value) {
    const uint32_t left = pair<Pair::hl>(r);
    const uint32_t sum = left + value;
    const uint32_t carries = left ^ value ^ sum;
    set_overflow(r, carries >> 8);
    r.k_source = ((carries >> 15 ^ carries >> 16 ^ sum >> 15) & 1) ^ 1;
    r.carry = sum >> 16;
    set_pair<Pair::hl>(r, word(sum));
}

/// DSUB; which flags it leaves is decided in one place.
inline void double_subtract(Registers& r) {
    const WideResult result = double_subtract_flags(static_cast<uint16_t>(pair<Pair::hl>(r)),
                                                    static_cast<uint16_t>(pair<Pair::bc>(r)));
    set_pair<Pair::hl>(r, result.value);
    r.set_flags(result.flags);
}

/// RDEL: K stays although V may change.
[[gnu::always_inline]] inline void rotate_de(Registers& r) {
    const uint32_t old = pair<Pair::de>(r);
    r.k_source = r.k() ? 0 : 1;
    set_overflow(r, old >> 7);
    set_pair<Pair::de>(r, word(old << 1 | r.carry));
    r.carry = old >> 15;
}

/// RLC RRC RAL RAR in opcode order.
template <unsigned kOperation>
[[gnu::always_inline]] inline void rotate(Registers& r) {
    constexpr bool kLeft = kOperation % 2 == 0;
    const uint32_t old = r.a;
    const uint32_t out = kLeft ? old >> 7 : old & 1;
    const uint32_t in = kOperation < 2 ? out : r.carry;
    set_overflow(r, kLeft ? old << 1 : 0);
    r.k_source = kKIsVXorS;
    r.a = kLeft ? (old << 1 & 0xFF) | in : old >> 1 | in << 7;
    r.carry = out;
}

/// NZ Z NC C PO PE P M in opcode order.
template <unsigned kCondition>
[[gnu::always_inline]] inline bool holds(const Registers& r) {
    constexpr bool kWanted = kCondition % 2 == 1;
    if constexpr (kCondition / 2 == 0) return ((r.result & 0xFF) == 0) == kWanted;
    if constexpr (kCondition / 2 == 1) return (r.carry != 0) == kWanted;
    if constexpr (kCondition / 2 == 2) {
        return ((kResultFlags[r.result] & flag::kParity) != 0) == kWanted;
    }
    return ((r.result & kSignBits) != 0) == kWanted;
}

}  // namespace host_sim::fast
