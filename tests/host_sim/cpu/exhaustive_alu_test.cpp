// exhaustive_alu_test.cpp - every accumulator, operand and carry of the 8-bit arithmetic, on both
// interpreters, against a model that adds bit by bit.
// Source       Intel 8085AH data sheet and MCS-80/85 Family User's Manual, instruction set: what
//              each instruction computes, which flags it affects, "the contents of the second
//              operand are subtracted" in two's complement, DAA's two steps. V and K: K. Shirriff's
//              die analysis (V is the carry into bit 7 XOR the carry out of it; K = V XOR S).
//              AC of ANA: always set on the 8085.
// Independent  nothing of flags.hpp is used here.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstdint>

#include "host_sim/cpu/flat_machine.hpp"

namespace {

using host_sim::CpuState;
using host_sim::FlatMachine;

// The flag byte, bit by bit, as PUSH PSW stores it.
constexpr unsigned kS = 7, kZ = 6, kK = 5, kAc = 4, kP = 2, kV = 1, kCy = 0;

struct Outcome {
    unsigned a = 0;
    unsigned f = 0;
};

unsigned bit(unsigned value, unsigned n) {
    return value >> n & 1;
}

void set(unsigned& flags, unsigned n, bool on) {
    flags = (flags & ~(1U << n)) | (on ? 1U << n : 0);
}

void set_sign_zero_parity(Outcome& out) {
    unsigned ones = 0;
    for (unsigned n = 0; n < 8; ++n) ones += bit(out.a, n);
    set(out.f, kS, bit(out.a, 7) != 0);
    set(out.f, kZ, ones == 0);
    set(out.f, kP, ones % 2 == 0);
}

/// Eight full adders in a row.
struct Adder {
    unsigned sum = 0;
    bool carry_from_bit_3 = false;
    bool carry_from_bit_6 = false;
    bool carry_from_bit_7 = false;
};

Adder add_bits(unsigned left, unsigned right, unsigned carry) {
    Adder adder;
    for (unsigned n = 0; n < 8; ++n) {
        const unsigned ones = bit(left, n) + bit(right, n) + carry;
        adder.sum |= (ones % 2) << n;
        carry = ones / 2;
        if (n == 3) adder.carry_from_bit_3 = carry != 0;
        if (n == 6) adder.carry_from_bit_6 = carry != 0;
        if (n == 7) adder.carry_from_bit_7 = carry != 0;
    }
    return adder;
}

Outcome outcome_of(const Adder& adder, bool carry_flag) {
    Outcome out{adder.sum, 0};
    const bool v = adder.carry_from_bit_6 != adder.carry_from_bit_7;
    set_sign_zero_parity(out);
    set(out.f, kAc, adder.carry_from_bit_3);
    set(out.f, kCy, carry_flag);
    set(out.f, kV, v);
    set(out.f, kK, v != (bit(out.a, 7) != 0));
    return out;
}

Outcome added(unsigned left, unsigned right, unsigned carry) {
    const Adder adder = add_bits(left, right, carry);
    return outcome_of(adder, adder.carry_from_bit_7);
}

/// Adds the complement; the carry flag is the borrow, the opposite of the adder's carry.
Outcome subtracted(unsigned left, unsigned right, unsigned borrow) {
    const Adder adder = add_bits(left, ~right & 0xFF, 1 - borrow);
    return outcome_of(adder, !adder.carry_from_bit_7);
}

Outcome logical(unsigned value, bool auxiliary_carry) {
    Outcome out{value, 0};
    set_sign_zero_parity(out);
    set(out.f, kAc, auxiliary_carry);
    set(out.f, kK, bit(value, 7) != 0);
    return out;
}

/// ADD ADC SUB SBB ANA XRA ORA CMP in opcode order.
Outcome arithmetic(unsigned operation, unsigned a, unsigned operand, unsigned carry) {
    switch (operation) {
        case 0:
            return added(a, operand, 0);
        case 1:
            return added(a, operand, carry);
        case 2:
            return subtracted(a, operand, 0);
        case 3:
            return subtracted(a, operand, carry);
        case 4:
            return logical(a & operand, true);
        case 5:
            return logical(a ^ operand, false);
        case 6:
            return logical(a | operand, false);
        default:
            return {a, subtracted(a, operand, 0).f};
    }
}

/// If the low digit is above 9 or AC is set, 6 is added; if the high digit is now above 9 or CY is
/// set, 6 is added to it. CY is set by either, never cleared.
Outcome adjusted(unsigned a, unsigned flags) {
    const unsigned low_digit = a & 0x0F;
    const bool low = low_digit > 9 || bit(flags, kAc) != 0;
    const unsigned high_digit = (a + (low ? 6 : 0)) >> 4;  // of nine bits: a carry counts as 16
    const bool high = high_digit > 9 || bit(flags, kCy) != 0;
    const Adder adder = add_bits(a, (low ? 0x06U : 0) + (high ? 0x60U : 0), 0);
    return outcome_of(adder, high);
}

/// RLC RRC RAL RAR in opcode order. Only CY is settled; `f` holds it alone.
Outcome rotated(unsigned operation, unsigned a, unsigned carry) {
    const bool left = operation % 2 == 0;
    const unsigned out = left ? bit(a, 7) : bit(a, 0);
    const unsigned in = operation < 2 ? out : carry;
    Outcome result{0, out};
    for (unsigned n = 0; n < 8; ++n) {
        const bool end = left ? n == 0 : n == 7;
        result.a |= (end ? in : bit(a, left ? n - 1 : n + 1)) << n;
    }
    return result;
}

constexpr unsigned kAllFlags = 0xF7;  // bit 3 reads 0

class ExhaustiveAlu : public testing::TestWithParam<bool> {
protected:
    /// Executes `opcode` alone with `a`, B = `operand` and flags `f`.
    void execute(unsigned opcode, unsigned a, unsigned operand, unsigned f) {
        machine_.memory.bytes[0x100] = static_cast<uint8_t>(opcode);
        machine_.cpu = CpuState{};
        machine_.cpu.pc = 0x100;
        machine_.cpu.t = 1000;
        machine_.cpu.a = static_cast<uint8_t>(a);
        machine_.cpu.b = static_cast<uint8_t>(operand);
        machine_.cpu.f = static_cast<uint8_t>(f);
        if (GetParam()) {
            machine_.run(1001);
        } else {
            machine_.run_reference(1001);
        }
    }
    void expect(unsigned left, unsigned right, unsigned opcode, unsigned a, unsigned operand,
                unsigned f) {
        if (left == right || ++failures_ > 20) return;
        ADD_FAILURE() << fmt::format(
            "opcode {:02X} with A {:02X} operand {:02X} F {:02X} leaves {:02X}, expected {:02X}",
            opcode, a, operand, f, left, right);
    }

    FlatMachine machine_;
    int failures_ = 0;
};

// 8 x 256 x 256 x 2, each from all other flags clear and all set.
TEST_P(ExhaustiveAlu, ArithmeticAndLogicOfAllOperands) {
    for (unsigned operation = 0; operation < 8; ++operation) {
        const unsigned opcode = 0x80 | operation << 3;  // operand in B
        for (unsigned inputs = 0; inputs < 0x40000; ++inputs) {
            const unsigned a = inputs & 0xFF;
            const unsigned operand = inputs >> 8 & 0xFF;
            const unsigned carry = inputs >> 16 & 1;
            const unsigned f = carry | (inputs >> 17 != 0 ? kAllFlags & ~1U : 0);
            const Outcome out = arithmetic(operation, a, operand, carry);
            execute(opcode, a, operand, f);
            expect(machine_.cpu.a, out.a, opcode, a, operand, f);
            expect(machine_.cpu.f, out.f, opcode, a, operand, f);
        }
    }
}

// All flags but CY are affected.
TEST_P(ExhaustiveAlu, IncrementAndDecrementOfAllValues) {
    for (unsigned inputs = 0; inputs < 0x400; ++inputs) {
        const unsigned value = inputs & 0xFF;
        const unsigned f = (inputs >> 8 & 1) | (inputs >> 9 != 0 ? kAllFlags & ~1U : 0);
        for (const unsigned opcode : {0x04U, 0x05U}) {  // INR B, DCR B
            Outcome out = opcode == 0x04 ? added(value, 1, 0) : subtracted(value, 1, 0);
            set(out.f, kCy, bit(f, kCy) != 0);
            execute(opcode, 0x5A, value, f);
            expect(machine_.cpu.b, out.a, opcode, 0x5A, value, f);
            expect(machine_.cpu.f, out.f, opcode, 0x5A, value, f);
            expect(machine_.cpu.a, 0x5A, opcode, 0x5A, value, f);
        }
    }
}

TEST_P(ExhaustiveAlu, DecimalAdjustOfAllAccumulatorsAndFlags) {
    for (unsigned inputs = 0; inputs < 0x10000; ++inputs) {
        const unsigned a = inputs & 0xFF;
        const unsigned f = inputs >> 8 & kAllFlags;
        const Outcome out = adjusted(a, f);
        execute(0x27, a, 0, f);
        expect(machine_.cpu.a, out.a, 0x27, a, 0, f);
        expect(machine_.cpu.f, out.f, 0x27, a, 0, f);
    }
}

// V and K of a rotate are unsettled; all other flags but CY stay.
TEST_P(ExhaustiveAlu, RotatesOfAllAccumulators) {
    constexpr unsigned kSettled = kAllFlags & ~(1U << kV | 1U << kK);
    for (unsigned inputs = 0; inputs < 0x10000; ++inputs) {
        const unsigned a = inputs & 0xFF;
        const unsigned f = inputs >> 8 & kAllFlags;
        for (unsigned operation = 0; operation < 4; ++operation) {
            const unsigned opcode = 0x07 | operation << 3;
            const Outcome out = rotated(operation, a, f & 1);
            execute(opcode, a, 0, f);
            expect(machine_.cpu.a, out.a, opcode, a, 0, f);
            expect(machine_.cpu.f & kSettled, (f & kSettled & ~1U) | out.f, opcode, a, 0, f);
        }
    }
}

// Decimal addition as the manual motivates it: ADD or ADC of two packed numbers, then DAA.
TEST_P(ExhaustiveAlu, DecimalAdjustAddsPackedNumbers) {
    for (unsigned left = 0; left < 100; ++left) {
        for (unsigned right = 0; right < 100; ++right) {
            for (const unsigned carry : {0U, 1U}) {
                const unsigned packed_left = left / 10 << 4 | left % 10;
                const unsigned packed_right = right / 10 << 4 | right % 10;
                const unsigned sum = left + right + carry;
                execute(0x88, packed_left, packed_right, carry);  // ADC B
                execute(0x27, machine_.cpu.a, 0, machine_.cpu.f);
                expect(machine_.cpu.a, sum / 10 % 10 << 4 | sum % 10, 0x27, packed_left,
                       packed_right, carry);
                expect(machine_.cpu.f & 1U, sum / 100, 0x27, packed_left, packed_right, carry);
            }
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Interpreters, ExhaustiveAlu, testing::Bool(),
                         [](const auto& which) { return which.param ? "Fast" : "Reference"; });

}  // namespace
