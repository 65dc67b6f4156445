// reference_operations.hpp - what the plain interpreter's instructions are made of: machine cycles,
// registers, eager arithmetic, control.
// Depends on   cpu_state.hpp, flags.hpp.
// Source       Intel 8085AH data sheet; MCS-80/85 Family User's Manual, machine cycles.
#pragma once

#include <concepts>
#include <cstdint>

#include "host_sim/cpu/cpu_state.hpp"
#include "host_sim/cpu/flags.hpp"

namespace host_sim {

/// What the processor is wired to. `t` is the T-state at whose end the transfer is complete (T3 of
/// the machine cycle).
template <class B>
concept Bus =
    requires(B bus, uint16_t address, uint8_t port, uint8_t value, uint64_t t, CpuState& cpu) {
        { bus.fetch(address, t) } -> std::same_as<uint8_t>;  ///< opcode
        {
            bus.operand(address, t)
        } -> std::same_as<uint8_t>;  ///< second and third instruction byte
        { bus.read(address, t) } -> std::same_as<uint8_t>;
        bus.write(address, value, t);
        { bus.in(port, t) } -> std::same_as<uint8_t>;
        bus.out(port, value, t);
        { bus.acknowledge(t) } -> std::same_as<uint8_t>;  ///< INTA: a byte of the INTR instruction
        bus.update_pins(t);         ///< RIM is about to look at the input pins
        bus.serial_out(bool{}, t);  ///< SIM has loaded SOD
    };

namespace reference {

/// State, bus and the time inside an instruction. Internal to reference.hpp.
template <Bus B>
struct Operations {
    CpuState& s;
    B& bus;
    uint64_t t;  ///< T-states up to here

    // -- Machine cycles of three T-states
    // ----------------------------------------------------------
    uint8_t operand() {
        t += 3;
        return bus.operand(s.pc++, t);
    }
    uint16_t operand_word() {
        const uint8_t low = operand();
        return static_cast<uint16_t>(operand() << 8 | low);
    }
    uint8_t load(uint16_t address) {
        t += 3;
        return bus.read(address, t);
    }
    void store(uint16_t address, uint8_t value) {
        t += 3;
        bus.write(address, value, t);
    }
    uint16_t load_word(uint16_t address) {
        const uint8_t low = load(address);
        return static_cast<uint16_t>(load(static_cast<uint16_t>(address + 1)) << 8 | low);
    }
    void store_word(uint16_t address, uint8_t low, uint8_t high) {
        store(address, low);
        store(static_cast<uint16_t>(address + 1), high);
    }
    void push(uint8_t high, uint8_t low) {
        store(--s.sp, high);
        store(--s.sp, low);
    }
    uint16_t pop() {
        const uint8_t low = load(s.sp++);
        return static_cast<uint16_t>(load(s.sp++) << 8 | low);
    }
    void in(uint8_t port) {
        t += 3;
        s.a = bus.in(port, t);
    }
    void out(uint8_t port) {
        t += 3;
        bus.out(port, s.a, t);
    }

    // -- Registers
    // ---------------------------------------------------------------------------------
    void set_bc(uint16_t value) {
        s.b = static_cast<uint8_t>(value >> 8);
        s.c = static_cast<uint8_t>(value);
    }
    void set_de(uint16_t value) {
        s.d = static_cast<uint8_t>(value >> 8);
        s.e = static_cast<uint8_t>(value);
    }
    void set_hl(uint16_t value) {
        s.h = static_cast<uint8_t>(value >> 8);
        s.l = static_cast<uint8_t>(value);
    }
    void set_sp(uint16_t value) { s.sp = value; }
    void set_psw(uint16_t value) {
        s.a = static_cast<uint8_t>(value >> 8);
        s.f = static_cast<uint8_t>(value & ~flag::kUnused);
    }
    void set_result(AluResult result) {
        s.a = result.value;
        s.f = result.flags;
    }

    // -- Arithmetic
    // --------------------------------------------------------------------------------
    [[nodiscard]] uint8_t carry() const { return s.f & flag::kCarry; }
    void add(uint8_t value) { set_result(add_flags(s.a, value, 0)); }
    void adc(uint8_t value) { set_result(add_flags(s.a, value, carry())); }
    void sub(uint8_t value) { set_result(subtract_flags(s.a, value, 0)); }
    void sbb(uint8_t value) { set_result(subtract_flags(s.a, value, carry())); }
    void cmp(uint8_t value) { s.f = subtract_flags(s.a, value, 0).flags; }
    void ana(uint8_t value) {
        s.a &= value;
        s.f = logic_flags(s.a, flag::kAuxiliaryCarry);
    }
    void xra(uint8_t value) {
        s.a ^= value;
        s.f = logic_flags(s.a, 0);
    }
    void ora(uint8_t value) {
        s.a |= value;
        s.f = logic_flags(s.a, 0);
    }
    void inr(uint8_t& value) {
        const AluResult result = increment_flags(value, s.f);
        value = result.value;
        s.f = result.flags;
    }
    void dcr(uint8_t& value) {
        const AluResult result = decrement_flags(value, s.f);
        value = result.value;
        s.f = result.flags;
    }
    void inr_memory() {
        uint8_t value = load(s.hl());
        inr(value);
        store(s.hl(), value);
    }
    void dcr_memory() {
        uint8_t value = load(s.hl());
        dcr(value);
        store(s.hl(), value);
    }
    void daa() { set_result(decimal_adjust_flags(s.a, s.f)); }
    uint16_t count(uint16_t value, bool up) {
        const WideResult result = count_flags(value, up, s.f);
        s.f = result.flags;
        return result.value;
    }
    void dad(uint16_t value) {
        t += 6;  // two bus-idle cycles
        const WideResult result = double_add_flags(s.hl(), value, s.f);
        set_hl(result.value);
        s.f = result.flags;
    }
    // V of a rotate (disputed): the overflow of A + A to the left, 0 to the right.
    void rlc() {
        const bool out = (s.a & 0x80) != 0;
        s.f = rotate_flags(s.f, out, ((s.a ^ s.a << 1) & 0x80) != 0);
        s.a = static_cast<uint8_t>(s.a << 1 | (out ? 1 : 0));
    }
    void ral() {
        const bool out = (s.a & 0x80) != 0;
        const auto shifted = static_cast<uint8_t>(s.a << 1 | carry());
        s.f = rotate_flags(s.f, out, ((s.a ^ s.a << 1) & 0x80) != 0);
        s.a = shifted;
    }
    void rrc() {
        const bool out = (s.a & 1) != 0;
        s.f = rotate_flags(s.f, out, false);
        s.a = static_cast<uint8_t>(s.a >> 1 | (out ? 0x80 : 0));
    }
    void rar() {
        const bool out = (s.a & 1) != 0;
        const auto shifted = static_cast<uint8_t>(s.a >> 1 | carry() << 7);
        s.f = rotate_flags(s.f, out, false);
        s.a = shifted;
    }
    void dsub() {
        t += 6;
        const WideResult result = double_subtract_flags(s.hl(), s.bc());
        set_hl(result.value);
        s.f = result.flags;
    }
    // LDHI and LDSI.
    void load_de_offset(uint16_t base) {
        const uint8_t offset = operand();
        t += 3;  // bus idle
        set_de(static_cast<uint16_t>(base + offset));
    }
    void arhl() {
        t += 3;
        s.f = static_cast<uint8_t>((s.f & ~flag::kCarry) | (s.l & 1));
        set_hl(static_cast<uint16_t>(s.hl() >> 1 | (s.hl() & 0x8000)));
    }
    // Rotated left through CY; V tells that the sign has changed.
    void rdel() {
        t += 6;
        const uint16_t old = s.de();
        set_de(static_cast<uint16_t>(old << 1 | carry()));
        s.f = rotate_wide_flags(s.f, (old & 0x8000) != 0, ((old ^ old << 1) & 0x8000) != 0);
    }

    // -- Control
    // -----------------------------------------------------------------------------------
    [[nodiscard]] bool holds(unsigned condition) const { return condition_holds(condition, s.f); }
    void call(uint16_t address) {
        push(static_cast<uint8_t>(s.pc >> 8), static_cast<uint8_t>(s.pc));
        s.pc = address;
    }
    // A branch not taken reads the low address byte only.
    void jump_if(bool taken) {
        if (taken) {
            s.pc = operand_word();
        } else {
            operand();
            ++s.pc;
        }
    }
    void call_if(bool taken) {
        t += 2;
        if (taken) {
            call(operand_word());
        } else {
            operand();
            ++s.pc;
        }
    }
    void return_if(bool taken) {
        t += 2;
        if (taken) s.pc = pop();
    }
    void restart_on_overflow() {
        t += 2;
        if ((s.f & flag::kV) != 0) call(0x0040);
    }
    void xchg() {
        const uint16_t old = s.hl();
        set_hl(s.de());
        set_de(old);
    }
    void xthl() {
        const uint8_t low = load(s.sp);
        const uint8_t high = load(static_cast<uint16_t>(s.sp + 1));
        store(static_cast<uint16_t>(s.sp + 1), s.h);
        store(s.sp, s.l);
        s.h = high;
        s.l = low;
    }

    // -- Interrupt masks and the serial line
    // ---------------------------------------------------------
    void rim() {
        bus.update_pins(t - 1);  // T3 of the only cycle
        const bool enable = s.trap_saved_valid ? s.trap_saved_enable : s.interrupt_enable;
        s.trap_saved_valid = false;
        s.a = static_cast<uint8_t>((s.pin(Pin::sid).level ? 0x80 : 0) | (s.rst75_latch ? 0x40 : 0) |
                                   (s.pin(Pin::rst65).level ? 0x20 : 0) |
                                   (s.pin(Pin::rst55).level ? 0x10 : 0) | (enable ? 0x08 : 0) |
                                   s.masks);
    }
    void sim() {
        bus.update_pins(t - 1);  // an edge that came before is cleared, too
        if ((s.a & 0x08) != 0) s.masks = s.a & mask::kAll;
        if ((s.a & 0x10) != 0) s.rst75_latch = false;
        if ((s.a & 0x40) != 0) {
            s.sod = (s.a & 0x80) != 0;
            bus.serial_out(s.sod, t);
        }
    }
};

}  // namespace reference
}  // namespace host_sim
