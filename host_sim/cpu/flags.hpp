// flags.hpp - the eager flag arithmetic of the reference interpreter: operands in, flag byte out.
// Depends on   cpu_state.hpp.
// Source       Intel 8085AH data sheet; MCS-80/85 Family User's Manual, instruction set; K.
// Shirriff's
//              die analysis for V and K. Where published cores disagree on V or K the place is
//              marked "disputed" (docs/design/cpu.md lists the choices).
#pragma once

#include <array>
#include <bit>
#include <cstdint>

#include "host_sim/cpu/cpu_state.hpp"

namespace host_sim {

/// Sign, zero and parity of a result byte.
inline constexpr std::array<uint8_t, 256> kSignZeroParity = [] {
    std::array<uint8_t, 256> table{};
    for (unsigned value = 0; value < 256; ++value) {
        const bool even = std::popcount(value) % 2 == 0;
        table[value] = static_cast<uint8_t>((value & flag::kSign) | (value == 0 ? flag::kZero : 0) |
                                            (even ? flag::kParity : 0));
    }
    return table;
}();

/// A result and the flag byte that it leaves.
struct AluResult {
    uint8_t value;
    uint8_t flags;
};

/// V where `v` is set and K = V XOR S, from the sign in `flags`.
constexpr uint8_t with_overflow(uint8_t flags, bool v) {
    const bool k = v != ((flags & flag::kSign) != 0);
    return static_cast<uint8_t>(flags | (v ? flag::kV : 0) | (k ? flag::kK : 0));
}

/// left + right + carry_in. V is the carry into bit 7 XOR the carry out of it.
constexpr AluResult add_flags(uint8_t left, uint8_t right, uint8_t carry_in) {
    const unsigned sum = static_cast<unsigned>(left + right + carry_in);
    const unsigned carries = left ^ right ^ sum;  // bit n: carry into bit n
    const auto value = static_cast<uint8_t>(sum);
    const auto flags = static_cast<uint8_t>(kSignZeroParity[value] |
                                            (carries & flag::kAuxiliaryCarry) | (sum >> 8 & 1));
    return {value, with_overflow(flags, ((carries >> 7 ^ carries >> 8) & 1) != 0)};
}

/// left - right - borrow_in. CY is the borrow; AC is the carry of the addition of NOT right, that
/// is, set when no borrow leaves bit 3.
constexpr AluResult subtract_flags(uint8_t left, uint8_t right, uint8_t borrow_in) {
    const unsigned difference = static_cast<unsigned>(left - right - borrow_in) & 0x1FFU;
    const unsigned borrows = left ^ right ^ difference;  // bit n: borrow out of bit n - 1
    const auto value = static_cast<uint8_t>(difference);
    const auto flags = static_cast<uint8_t>(
        kSignZeroParity[value] | (~borrows & flag::kAuxiliaryCarry) | (difference >> 8 & 1));
    return {value, with_overflow(flags, ((borrows >> 7 ^ borrows >> 8) & 1) != 0)};
}

/// The flags of ANA, XRA and ORA: CY and V clear, AC as given (the 8085 sets it for ANA and ANI).
constexpr uint8_t logic_flags(uint8_t value, uint8_t auxiliary_carry) {
    return with_overflow(static_cast<uint8_t>(kSignZeroParity[value] | auxiliary_carry), false);
}

/// value + 1; CY stays.
constexpr AluResult increment_flags(uint8_t value, uint8_t old_flags) {
    AluResult result = add_flags(value, 1, 0);
    result.flags =
        static_cast<uint8_t>((result.flags & ~flag::kCarry) | (old_flags & flag::kCarry));
    return result;
}

/// value - 1; CY stays.
constexpr AluResult decrement_flags(uint8_t value, uint8_t old_flags) {
    AluResult result = subtract_flags(value, 1, 0);
    result.flags =
        static_cast<uint8_t>((result.flags & ~flag::kCarry) | (old_flags & flag::kCarry));
    return result;
}

/// DAA as on the 8080: only ever adds. V is the overflow of that addition.
constexpr AluResult decimal_adjust_flags(uint8_t value, uint8_t old_flags) {
    const bool low = (value & 0x0F) > 9 || (old_flags & flag::kAuxiliaryCarry) != 0;
    const bool high = value > 0x99 || (old_flags & flag::kCarry) != 0;
    AluResult result =
        add_flags(value, static_cast<uint8_t>((low ? 0x06 : 0) + (high ? 0x60 : 0)), 0);
    result.flags = static_cast<uint8_t>((result.flags & ~flag::kCarry) | (high ? flag::kCarry : 0));
    return result;
}

/// A 16-bit result and the flag byte that it leaves.
struct WideResult {
    uint16_t value;
    uint8_t flags;
};

/// INX and DCX: K is the carry or borrow of the count; no other flag changes.
constexpr WideResult count_flags(uint16_t value, bool up, uint8_t old_flags) {
    const bool k = up ? value == 0xFFFF : value == 0;
    return {static_cast<uint16_t>(up ? value + 1 : value - 1),
            static_cast<uint8_t>((old_flags & ~flag::kK) | (k ? flag::kK : 0))};
}

/// DAD: CY; V is the 16-bit signed overflow; K (disputed) = V XOR bit 15.
constexpr WideResult double_add_flags(uint16_t left, uint16_t right, uint8_t old_flags) {
    const unsigned sum = static_cast<unsigned>(left) + right;
    const unsigned carries = left ^ right ^ sum;
    const bool v = ((carries >> 15 ^ carries >> 16) & 1) != 0;
    const bool k = v != ((sum & 0x8000) != 0);
    const auto kept = static_cast<uint8_t>(old_flags & ~(flag::kCarry | flag::kV | flag::kK));
    return {static_cast<uint16_t>(sum),
            static_cast<uint8_t>(kept | (sum >> 16 & 1) | (v ? flag::kV : 0) | (k ? flag::kK : 0))};
}

/// DSUB: left - right. CY and V of the 16-bit subtraction. Disputed: S, P and AC are those of the
/// high byte, Z of all 16 bits, K = V XOR S.
constexpr WideResult double_subtract_flags(uint16_t left, uint16_t right) {
    const AluResult low =
        subtract_flags(static_cast<uint8_t>(left), static_cast<uint8_t>(right), 0);
    const AluResult high =
        subtract_flags(static_cast<uint8_t>(left >> 8), static_cast<uint8_t>(right >> 8),
                       low.flags & flag::kCarry);
    const auto value = static_cast<uint16_t>(high.value << 8 | low.value);
    const auto flags =
        static_cast<uint8_t>((high.flags & ~flag::kZero) | (value == 0 ? flag::kZero : 0));
    return {value, flags};
}

/// RLC RRC RAL RAR: CY; V and K (disputed): V as given, K = V XOR the S flag, which stays.
constexpr uint8_t rotate_flags(uint8_t old_flags, bool carry, bool v) {
    const auto kept = static_cast<uint8_t>(old_flags & ~(flag::kCarry | flag::kV | flag::kK));
    return with_overflow(static_cast<uint8_t>(kept | (carry ? flag::kCarry : 0)), v);
}

/// RDEL: CY and V only.
constexpr uint8_t rotate_wide_flags(uint8_t old_flags, bool carry, bool v) {
    const auto kept = static_cast<uint8_t>(old_flags & ~(flag::kCarry | flag::kV));
    return static_cast<uint8_t>(kept | (carry ? flag::kCarry : 0) | (v ? flag::kV : 0));
}

/// The eight conditions of Jcc, Ccc and Rcc in opcode order: NZ Z NC C PO PE P M.
constexpr bool condition_holds(unsigned condition, uint8_t flags) {
    constexpr std::array<uint8_t, 4> kTested = {flag::kZero, flag::kCarry, flag::kParity,
                                                flag::kSign};
    const bool set = (flags & kTested[condition >> 1]) != 0;
    return set == ((condition & 1) != 0);
}

}  // namespace host_sim
