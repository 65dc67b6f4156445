// instruction_model.hpp - what single 8085 instructions do to A, HL and the flags, bit by bit.
// Source       Intel 8085AH data sheet and MCS-80/85 Family User's Manual (S, Z, AC, P, CY);
//              K. Shirriff's die analysis of the 8085 (V: overflow; K: V xor S, and the carry of
//              INX and DCX; after logic V = 0, K = S).
// Independent  of the simulator: adders are made of single-bit full adders, parity of a loop.
#pragma once

#include <cstdint>

namespace i85run_test {

/// The part of the processor that the exerciser looks at.
struct ModelState {
    uint8_t a = 0;
    uint8_t b = 0;
    uint8_t c = 0;
    uint8_t h = 0;
    uint8_t l = 0;
    bool s = false, z = false, k = false, ac = false, p = false, v = false, cy = false;
};

inline void set_flag_byte(ModelState& state, uint8_t f) {
    state.s = (f & 0x80) != 0;
    state.z = (f & 0x40) != 0;
    state.k = (f & 0x20) != 0;
    state.ac = (f & 0x10) != 0;
    state.p = (f & 0x04) != 0;
    state.v = (f & 0x02) != 0;
    state.cy = (f & 0x01) != 0;
}

inline uint8_t flag_byte(const ModelState& state) {
    return static_cast<uint8_t>(state.s << 7 | state.z << 6 | state.k << 5 | state.ac << 4 |
                                state.p << 2 | state.v << 1 | state.cy);
}

/// A ripple adder of `width` bits and the carry out of each of them.
struct Sum {
    unsigned value = 0;
    bool carry[16] = {};
};

inline Sum ripple_add(unsigned x, unsigned y, bool carry, unsigned width) {
    Sum sum;
    for (unsigned bit = 0; bit < width; ++bit) {
        const bool p = ((x >> bit) & 1U) != 0, q = ((y >> bit) & 1U) != 0;
        if (p != (q != carry)) sum.value |= 1U << bit;
        carry = (p && q) || (p && carry) || (q && carry);
        sum.carry[bit] = carry;
    }
    return sum;
}

inline bool even_parity(uint8_t value) {
    bool even = true;
    for (unsigned bit = 0; bit < 8; ++bit) even = even != (((unsigned{value} >> bit) & 1U) != 0);
    return even;
}

inline void set_result_flags(ModelState& state, unsigned value) {
    const auto byte = static_cast<uint8_t>(value);
    state.s = byte >= 0x80;
    state.z = byte == 0;
    state.p = even_parity(byte);
}

/// ADD, ADC and, through the complement, SUB, SBB, CMP: borrow is the carry turned round.
/// @return  the result; A is left alone
inline uint8_t arithmetic(ModelState& state, uint8_t x, uint8_t y, bool carry, bool subtract) {
    const Sum sum = subtract ? ripple_add(x, y ^ 0xFFU, !carry, 8) : ripple_add(x, y, carry, 8);
    set_result_flags(state, sum.value);
    state.cy = sum.carry[7] != subtract;
    state.ac = sum.carry[3];
    state.v = sum.carry[6] != sum.carry[7];
    state.k = state.v != state.s;
    return static_cast<uint8_t>(sum.value);
}

/// ANA sets AC on the 8085 (on the 8080 it does not); XRA and ORA clear it. All clear CY.
inline void logic(ModelState& state, unsigned value, bool auxiliary_carry) {
    state.a = static_cast<uint8_t>(value);
    set_result_flags(state, value);
    state.cy = false;
    state.ac = auxiliary_carry;
    state.v = false;
    state.k = state.s;
}

/// Adds 6 to each decimal digit above 9 or with a carry; CY is only ever set.
inline void decimal_adjust(ModelState& state) {
    const bool low = (state.a & 0x0FU) > 9 || state.ac;
    const bool high = state.a > 0x99 || state.cy;
    const bool carry = state.cy;
    state.a = arithmetic(state, state.a, static_cast<uint8_t>((low ? 6 : 0) + (high ? 0x60 : 0)),
                         false, false);
    state.cy = carry || high;
}

/// INX and DCX of HL: K is the carry or borrow out of bit 15, nothing else changes.
inline void count(ModelState& state, bool up) {
    const unsigned hl = static_cast<unsigned>(state.h) << 8 | state.l;
    const Sum sum = ripple_add(hl, up ? 1 : 0xFFFF, false, 16);
    state.k = sum.carry[15] == up;
    state.h = static_cast<uint8_t>(sum.value >> 8);
    state.l = static_cast<uint8_t>(sum.value);
}

/// DAD B: of the documented flags only CY.
inline void double_add(ModelState& state) {
    const Sum sum = ripple_add(static_cast<unsigned>(state.h) << 8 | state.l,
                               static_cast<unsigned>(state.b) << 8 | state.c, false, 16);
    state.cy = sum.carry[15];
    state.h = static_cast<uint8_t>(sum.value >> 8);
    state.l = static_cast<uint8_t>(sum.value);
}

/// INR and DCR leave CY alone.
inline void step_a(ModelState& state, bool up) {
    const bool carry = state.cy;
    state.a = arithmetic(state, state.a, 1, false, !up);
    state.cy = carry;
}

/// RLC, RRC, RAL, RAR: of the documented flags only CY.
inline void rotate(ModelState& state, bool left, bool through_carry) {
    const unsigned a = state.a;
    const bool out = (left ? a >> 7 & 1U : a & 1U) != 0;
    const unsigned in = (through_carry ? state.cy : out) ? 1 : 0;
    state.a = static_cast<uint8_t>(left ? a << 1 | in : a >> 1 | in << 7);
    state.cy = out;
}

/// Executes one of the exerciser's instructions.
/// @return  false when the model does not know it
inline bool execute(ModelState& s, uint8_t opcode) {
    switch (opcode) {
        case 0x80:
            s.a = arithmetic(s, s.a, s.b, false, false);
            return true;
        case 0x88:
            s.a = arithmetic(s, s.a, s.b, s.cy, false);
            return true;
        case 0x90:
            s.a = arithmetic(s, s.a, s.b, false, true);
            return true;
        case 0x98:
            s.a = arithmetic(s, s.a, s.b, s.cy, true);
            return true;
        case 0xA0:
            logic(s, s.a & s.b, true);
            return true;
        case 0xA8:
            logic(s, s.a ^ s.b, false);
            return true;
        case 0xB0:
            logic(s, s.a | s.b, false);
            return true;
        case 0xB8:
            arithmetic(s, s.a, s.b, false, true);
            return true;
        case 0x09:
            double_add(s);
            return true;
        case 0x23:
            count(s, true);
            return true;
        case 0x2B:
            count(s, false);
            return true;
        case 0x3C:
            step_a(s, true);
            return true;
        case 0x3D:
            step_a(s, false);
            return true;
        case 0x27:
            decimal_adjust(s);
            return true;
        case 0x07:
            rotate(s, true, false);
            return true;
        case 0x0F:
            rotate(s, false, false);
            return true;
        case 0x17:
            rotate(s, true, true);
            return true;
        case 0x1F:
            rotate(s, false, true);
            return true;
        case 0x2F:
            s.a = static_cast<uint8_t>(~s.a);
            return true;
        case 0x3F:
            s.cy = !s.cy;
            return true;
        default:
            return false;
    }
}

}  // namespace i85run_test
