// reference.hpp - the plain 8085 interpreter: one switch, eager flags, every bus cycle in its
// place. Depends on   cpu_state.hpp, flags.hpp, interrupts.hpp. Source       Intel 8085AH data
// sheet; MCS-80/85 Family User's Manual, instruction set and machine
//              cycles (docs/design/cpu.md).
// Use          the definition of what is correct: the fast interpreter is compared with it in lock
//              step, and everything that observes single bus cycles runs on it.
#pragma once

#include <concepts>
#include <cstdint>

#include "host_sim/cpu/cpu_state.hpp"
#include "host_sim/cpu/flags.hpp"
#include "host_sim/cpu/interrupts.hpp"

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

/// One processor on one bus. Holds references only; all state is in CpuState.
template <Bus B>
class Reference {
public:
    Reference(CpuState& state, B& bus, InstructionSet set = InstructionSet::all)
        : s_(state), bus_(bus), t_(state.t), all_(set == InstructionSet::all) {}

    /// Executes the instruction at PC, without looking at interrupts or HALT.
    /// @return false, with the state unchanged, when it is not in the instruction set
    bool execute() {
        t_ = s_.t;
        const bool ei_shadow = s_.ei_shadow;
        s_.ei_shadow = false;
        const uint8_t opcode = bus_.fetch(s_.pc, t_ + 3);
        ++s_.pc;
        t_ += 4;
        if (!dispatch(opcode)) {
            --s_.pc;
            s_.ei_shadow = ei_shadow;
            return false;
        }
        s_.t = t_;
        ++s_.instructions;
        return true;
    }

    /// Takes `interrupt`: INTA or idle cycle, then the push. Any acceptance clears IE.
    void accept(Interrupt interrupt) {
        t_ = s_.t;
        s_.halted = false;
        s_.ei_shadow = false;  // the handler's first instruction does not stand behind EI
        if (interrupt == Interrupt::trap) {
            s_.trap_latch = false;
            s_.trap_saved_valid = true;
            s_.trap_saved_enable = s_.interrupt_enable;
        }
        if (interrupt == Interrupt::rst75) s_.rst75_latch = false;
        s_.interrupt_enable = false;
        if (interrupt == Interrupt::intr) {
            acknowledge();
        } else {
            t_ += 6;
            call(interrupt_vector(interrupt));
        }
        s_.t = t_;
    }

private:
    // INTA reads the instruction instead of memory and leaves PC alone; so do the second and third
    // byte of a CALL. The data sheet knows RST and CALL; any other byte is executed as it stands,
    // its operands from memory.
    void acknowledge() {
        const uint8_t opcode = bus_.acknowledge(t_ + 3);
        t_ += 4;
        if (opcode == 0xCD) {
            t_ += 2;
            const uint8_t low = bus_.acknowledge(t_ + 3);
            const uint8_t high = bus_.acknowledge(t_ + 6);
            t_ += 6;
            call(static_cast<uint16_t>(high << 8 | low));
        } else {
            dispatch(opcode);
        }
    }

    // tidy-allow(function-length): one line per opcode is the table that it is
    bool dispatch(uint8_t opcode) {
        // clang-format off
        switch (opcode) {
        // NOP and MOV r,r to itself
        case 0x00: case 0x40: case 0x49: case 0x52:
        case 0x5B: case 0x64: case 0x6D: case 0x7F: break;
        case 0x01: set_bc(operand_word()); break; case 0x02: store(s_.bc(), s_.a); break;
        case 0x03: t_ += 2; set_bc(count(s_.bc(), true)); break; case 0x04: inr(s_.b); break;
        case 0x05: dcr(s_.b); break; case 0x06: s_.b = operand(); break; case 0x07: rlc(); break;
        case 0x08: if (!all_) return false;
            dsub(); break;
        case 0x09: dad(s_.bc()); break;
        case 0x0A: s_.a = load(s_.bc()); break;
        case 0x0B: t_ += 2; set_bc(count(s_.bc(), false)); break; case 0x0C: inr(s_.c); break;
        case 0x0D: dcr(s_.c); break; case 0x0E: s_.c = operand(); break; case 0x0F: rrc(); break;
        case 0x10: if (!all_) return false;
            arhl(); break;
        case 0x11: set_de(operand_word()); break;
        case 0x12: store(s_.de(), s_.a); break;
        case 0x13: t_ += 2; set_de(count(s_.de(), true)); break; case 0x14: inr(s_.d); break;
        case 0x15: dcr(s_.d); break; case 0x16: s_.d = operand(); break; case 0x17: ral(); break;
        case 0x18: if (!all_) return false;
            rdel(); break;
        case 0x19: dad(s_.de()); break;
        case 0x1A: s_.a = load(s_.de()); break;
        case 0x1B: t_ += 2; set_de(count(s_.de(), false)); break; case 0x1C: inr(s_.e); break;
        case 0x1D: dcr(s_.e); break; case 0x1E: s_.e = operand(); break; case 0x1F: rar(); break;
        case 0x20: rim(); break; case 0x21: set_hl(operand_word()); break;
        case 0x22: store_word(operand_word(), s_.l, s_.h); break;
        case 0x23: t_ += 2; set_hl(count(s_.hl(), true)); break; case 0x24: inr(s_.h); break;
        case 0x25: dcr(s_.h); break; case 0x26: s_.h = operand(); break; case 0x27: daa(); break;
        case 0x28: if (!all_) return false;
            set_de(static_cast<uint16_t>(s_.hl() + operand())); t_ += 3; break;
        case 0x29: dad(s_.hl()); break; case 0x2A: set_hl(load_word(operand_word())); break;
        case 0x2B: t_ += 2; set_hl(count(s_.hl(), false)); break; case 0x2C: inr(s_.l); break;
        case 0x2D: dcr(s_.l); break; case 0x2E: s_.l = operand(); break;
        case 0x2F: s_.a = static_cast<uint8_t>(~s_.a); break;
        case 0x30: sim(); break; case 0x31: set_sp(operand_word()); break;
        case 0x32: store(operand_word(), s_.a); break;
        case 0x33: t_ += 2; set_sp(count(s_.sp, true)); break; case 0x34: inr_memory(); break;
        case 0x35: dcr_memory(); break; case 0x36: store(s_.hl(), operand()); break;
        case 0x37: s_.f |= flag::kCarry; break;
        case 0x38: if (!all_) return false;
            set_de(static_cast<uint16_t>(s_.sp + operand())); t_ += 3; break;
        case 0x39: dad(s_.sp); break; case 0x3A: s_.a = load(operand_word()); break;
        case 0x3B: t_ += 2; set_sp(count(s_.sp, false)); break; case 0x3C: inr(s_.a); break;
        case 0x3D: dcr(s_.a); break; case 0x3E: s_.a = operand(); break;
        case 0x3F: s_.f ^= flag::kCarry; break; case 0x41: s_.b = s_.c; break;
        case 0x42: s_.b = s_.d; break; case 0x43: s_.b = s_.e; break; case 0x44: s_.b = s_.h; break;
        case 0x45: s_.b = s_.l; break; case 0x46: s_.b = load(s_.hl()); break;
        case 0x47: s_.b = s_.a; break; case 0x48: s_.c = s_.b; break; case 0x4A: s_.c = s_.d; break;
        case 0x4B: s_.c = s_.e; break; case 0x4C: s_.c = s_.h; break; case 0x4D: s_.c = s_.l; break;
        case 0x4E: s_.c = load(s_.hl()); break; case 0x4F: s_.c = s_.a; break;
        case 0x50: s_.d = s_.b; break; case 0x51: s_.d = s_.c; break; case 0x53: s_.d = s_.e; break;
        case 0x54: s_.d = s_.h; break; case 0x55: s_.d = s_.l; break;
        case 0x56: s_.d = load(s_.hl()); break; case 0x57: s_.d = s_.a; break;
        case 0x58: s_.e = s_.b; break; case 0x59: s_.e = s_.c; break; case 0x5A: s_.e = s_.d; break;
        case 0x5C: s_.e = s_.h; break; case 0x5D: s_.e = s_.l; break;
        case 0x5E: s_.e = load(s_.hl()); break; case 0x5F: s_.e = s_.a; break;
        case 0x60: s_.h = s_.b; break; case 0x61: s_.h = s_.c; break; case 0x62: s_.h = s_.d; break;
        case 0x63: s_.h = s_.e; break; case 0x65: s_.h = s_.l; break;
        case 0x66: s_.h = load(s_.hl()); break; case 0x67: s_.h = s_.a; break;
        case 0x68: s_.l = s_.b; break; case 0x69: s_.l = s_.c; break; case 0x6A: s_.l = s_.d; break;
        case 0x6B: s_.l = s_.e; break; case 0x6C: s_.l = s_.h; break;
        case 0x6E: s_.l = load(s_.hl()); break; case 0x6F: s_.l = s_.a; break;
        case 0x70: store(s_.hl(), s_.b); break; case 0x71: store(s_.hl(), s_.c); break;
        case 0x72: store(s_.hl(), s_.d); break; case 0x73: store(s_.hl(), s_.e); break;
        case 0x74: store(s_.hl(), s_.h); break; case 0x75: store(s_.hl(), s_.l); break;
        case 0x76: s_.halted = true; t_ += 1; break; case 0x77: store(s_.hl(), s_.a); break;
        case 0x78: s_.a = s_.b; break; case 0x79: s_.a = s_.c; break; case 0x7A: s_.a = s_.d; break;
        case 0x7B: s_.a = s_.e; break; case 0x7C: s_.a = s_.h; break; case 0x7D: s_.a = s_.l; break;
        case 0x7E: s_.a = load(s_.hl()); break; case 0x80: add(s_.b); break;
        case 0x81: add(s_.c); break; case 0x82: add(s_.d); break; case 0x83: add(s_.e); break;
        case 0x84: add(s_.h); break; case 0x85: add(s_.l); break;
        case 0x86: add(load(s_.hl())); break; case 0x87: add(s_.a); break;
        case 0x88: adc(s_.b); break; case 0x89: adc(s_.c); break; case 0x8A: adc(s_.d); break;
        case 0x8B: adc(s_.e); break; case 0x8C: adc(s_.h); break; case 0x8D: adc(s_.l); break;
        case 0x8E: adc(load(s_.hl())); break; case 0x8F: adc(s_.a); break;
        case 0x90: sub(s_.b); break; case 0x91: sub(s_.c); break; case 0x92: sub(s_.d); break;
        case 0x93: sub(s_.e); break; case 0x94: sub(s_.h); break; case 0x95: sub(s_.l); break;
        case 0x96: sub(load(s_.hl())); break; case 0x97: sub(s_.a); break;
        case 0x98: sbb(s_.b); break; case 0x99: sbb(s_.c); break; case 0x9A: sbb(s_.d); break;
        case 0x9B: sbb(s_.e); break; case 0x9C: sbb(s_.h); break; case 0x9D: sbb(s_.l); break;
        case 0x9E: sbb(load(s_.hl())); break; case 0x9F: sbb(s_.a); break;
        case 0xA0: ana(s_.b); break; case 0xA1: ana(s_.c); break; case 0xA2: ana(s_.d); break;
        case 0xA3: ana(s_.e); break; case 0xA4: ana(s_.h); break; case 0xA5: ana(s_.l); break;
        case 0xA6: ana(load(s_.hl())); break; case 0xA7: ana(s_.a); break;
        case 0xA8: xra(s_.b); break; case 0xA9: xra(s_.c); break; case 0xAA: xra(s_.d); break;
        case 0xAB: xra(s_.e); break; case 0xAC: xra(s_.h); break; case 0xAD: xra(s_.l); break;
        case 0xAE: xra(load(s_.hl())); break; case 0xAF: xra(s_.a); break;
        case 0xB0: ora(s_.b); break; case 0xB1: ora(s_.c); break; case 0xB2: ora(s_.d); break;
        case 0xB3: ora(s_.e); break; case 0xB4: ora(s_.h); break; case 0xB5: ora(s_.l); break;
        case 0xB6: ora(load(s_.hl())); break; case 0xB7: ora(s_.a); break;
        case 0xB8: cmp(s_.b); break; case 0xB9: cmp(s_.c); break; case 0xBA: cmp(s_.d); break;
        case 0xBB: cmp(s_.e); break; case 0xBC: cmp(s_.h); break; case 0xBD: cmp(s_.l); break;
        case 0xBE: cmp(load(s_.hl())); break; case 0xBF: cmp(s_.a); break;
        case 0xC0: return_if(holds(0)); break; case 0xC1: set_bc(pop()); break;
        case 0xC2: jump_if(holds(0)); break; case 0xC3: s_.pc = operand_word(); break;
        case 0xC4: call_if(holds(0)); break; case 0xC5: t_ += 2; push(s_.b, s_.c); break;
        case 0xC6: add(operand()); break; case 0xC7: t_ += 2; call(0); break;
        case 0xC8: return_if(holds(1)); break; case 0xC9: s_.pc = pop(); break;
        case 0xCA: jump_if(holds(1)); break;
        case 0xCB: if (!all_) return false;
            restart_on_overflow(); break;
        case 0xCC: call_if(holds(1)); break; case 0xCD: t_ += 2; call(operand_word()); break;
        case 0xCE: adc(operand()); break; case 0xCF: t_ += 2; call(8); break;
        case 0xD0: return_if(holds(2)); break; case 0xD1: set_de(pop()); break;
        case 0xD2: jump_if(holds(2)); break; case 0xD3: out(operand()); break;
        case 0xD4: call_if(holds(2)); break; case 0xD5: t_ += 2; push(s_.d, s_.e); break;
        case 0xD6: sub(operand()); break; case 0xD7: t_ += 2; call(16); break;
        case 0xD8: return_if(holds(3)); break;
        case 0xD9: if (!all_) return false;
            store_word(s_.de(), s_.l, s_.h); break;
        case 0xDA: jump_if(holds(3)); break; case 0xDB: in(operand()); break;
        case 0xDC: call_if(holds(3)); break;
        case 0xDD: if (!all_) return false;
            jump_if((s_.f & flag::kK) == 0); break;
        case 0xDE: sbb(operand()); break; case 0xDF: t_ += 2; call(24); break;
        case 0xE0: return_if(holds(4)); break; case 0xE1: set_hl(pop()); break;
        case 0xE2: jump_if(holds(4)); break; case 0xE3: xthl(); break;
        case 0xE4: call_if(holds(4)); break; case 0xE5: t_ += 2; push(s_.h, s_.l); break;
        case 0xE6: ana(operand()); break; case 0xE7: t_ += 2; call(32); break;
        case 0xE8: return_if(holds(5)); break; case 0xE9: t_ += 2; s_.pc = s_.hl(); break;
        case 0xEA: jump_if(holds(5)); break; case 0xEB: xchg(); break;
        case 0xEC: call_if(holds(5)); break;
        case 0xED: if (!all_) return false;
            set_hl(load_word(s_.de())); break;
        case 0xEE: xra(operand()); break; case 0xEF: t_ += 2; call(40); break;
        case 0xF0: return_if(holds(6)); break; case 0xF1: set_psw(pop()); break;
        case 0xF2: jump_if(holds(6)); break; case 0xF3: s_.interrupt_enable = false; break;
        case 0xF4: call_if(holds(6)); break; case 0xF5: t_ += 2; push(s_.a, s_.f); break;
        case 0xF6: ora(operand()); break; case 0xF7: t_ += 2; call(48); break;
        case 0xF8: return_if(holds(7)); break; case 0xF9: t_ += 2; s_.sp = s_.hl(); break;
        case 0xFA: jump_if(holds(7)); break;
        case 0xFB: s_.interrupt_enable = true; s_.ei_shadow = true; break;
        case 0xFC: call_if(holds(7)); break;
        case 0xFD: if (!all_) return false;
            jump_if((s_.f & flag::kK) != 0); break;
        case 0xFE: cmp(operand()); break; case 0xFF: t_ += 2; call(56); break;        }
        // clang-format on
        return true;
    }

    // -- Machine cycles of three T-states
    // ----------------------------------------------------------
    uint8_t operand() {
        t_ += 3;
        return bus_.operand(s_.pc++, t_);
    }
    uint16_t operand_word() {
        const uint8_t low = operand();
        return static_cast<uint16_t>(operand() << 8 | low);
    }
    uint8_t load(uint16_t address) {
        t_ += 3;
        return bus_.read(address, t_);
    }
    void store(uint16_t address, uint8_t value) {
        t_ += 3;
        bus_.write(address, value, t_);
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
        store(--s_.sp, high);
        store(--s_.sp, low);
    }
    uint16_t pop() {
        const uint8_t low = load(s_.sp++);
        return static_cast<uint16_t>(load(s_.sp++) << 8 | low);
    }
    void in(uint8_t port) {
        t_ += 3;
        s_.a = bus_.in(port, t_);
    }
    void out(uint8_t port) {
        t_ += 3;
        bus_.out(port, s_.a, t_);
    }

    // -- Registers
    // ---------------------------------------------------------------------------------
    void set_bc(uint16_t value) {
        s_.b = static_cast<uint8_t>(value >> 8);
        s_.c = static_cast<uint8_t>(value);
    }
    void set_de(uint16_t value) {
        s_.d = static_cast<uint8_t>(value >> 8);
        s_.e = static_cast<uint8_t>(value);
    }
    void set_hl(uint16_t value) {
        s_.h = static_cast<uint8_t>(value >> 8);
        s_.l = static_cast<uint8_t>(value);
    }
    void set_sp(uint16_t value) { s_.sp = value; }
    void set_psw(uint16_t value) {
        s_.a = static_cast<uint8_t>(value >> 8);
        s_.f = static_cast<uint8_t>(value & ~flag::kUnused);
    }
    void set_result(AluResult result) {
        s_.a = result.value;
        s_.f = result.flags;
    }

    // -- Arithmetic
    // --------------------------------------------------------------------------------
    [[nodiscard]] uint8_t carry() const { return s_.f & flag::kCarry; }
    void add(uint8_t value) { set_result(add_flags(s_.a, value, 0)); }
    void adc(uint8_t value) { set_result(add_flags(s_.a, value, carry())); }
    void sub(uint8_t value) { set_result(subtract_flags(s_.a, value, 0)); }
    void sbb(uint8_t value) { set_result(subtract_flags(s_.a, value, carry())); }
    void cmp(uint8_t value) { s_.f = subtract_flags(s_.a, value, 0).flags; }
    void ana(uint8_t value) {
        s_.a &= value;
        s_.f = logic_flags(s_.a, flag::kAuxiliaryCarry);
    }
    void xra(uint8_t value) {
        s_.a ^= value;
        s_.f = logic_flags(s_.a, 0);
    }
    void ora(uint8_t value) {
        s_.a |= value;
        s_.f = logic_flags(s_.a, 0);
    }
    void inr(uint8_t& value) {
        const AluResult result = increment_flags(value, s_.f);
        value = result.value;
        s_.f = result.flags;
    }
    void dcr(uint8_t& value) {
        const AluResult result = decrement_flags(value, s_.f);
        value = result.value;
        s_.f = result.flags;
    }
    void inr_memory() {
        uint8_t value = load(s_.hl());
        inr(value);
        store(s_.hl(), value);
    }
    void dcr_memory() {
        uint8_t value = load(s_.hl());
        dcr(value);
        store(s_.hl(), value);
    }
    void daa() { set_result(decimal_adjust_flags(s_.a, s_.f)); }
    uint16_t count(uint16_t value, bool up) {
        const WideResult result = count_flags(value, up, s_.f);
        s_.f = result.flags;
        return result.value;
    }
    void dad(uint16_t value) {
        t_ += 6;  // two bus-idle cycles
        const WideResult result = double_add_flags(s_.hl(), value, s_.f);
        set_hl(result.value);
        s_.f = result.flags;
    }
    // V of a rotate (disputed): the overflow of A + A to the left, 0 to the right.
    void rlc() {
        const bool out = (s_.a & 0x80) != 0;
        s_.f = rotate_flags(s_.f, out, ((s_.a ^ s_.a << 1) & 0x80) != 0);
        s_.a = static_cast<uint8_t>(s_.a << 1 | (out ? 1 : 0));
    }
    void ral() {
        const bool out = (s_.a & 0x80) != 0;
        const auto shifted = static_cast<uint8_t>(s_.a << 1 | carry());
        s_.f = rotate_flags(s_.f, out, ((s_.a ^ s_.a << 1) & 0x80) != 0);
        s_.a = shifted;
    }
    void rrc() {
        const bool out = (s_.a & 1) != 0;
        s_.f = rotate_flags(s_.f, out, false);
        s_.a = static_cast<uint8_t>(s_.a >> 1 | (out ? 0x80 : 0));
    }
    void rar() {
        const bool out = (s_.a & 1) != 0;
        const auto shifted = static_cast<uint8_t>(s_.a >> 1 | carry() << 7);
        s_.f = rotate_flags(s_.f, out, false);
        s_.a = shifted;
    }
    void dsub() {
        t_ += 6;
        const WideResult result = double_subtract_flags(s_.hl(), s_.bc());
        set_hl(result.value);
        s_.f = result.flags;
    }
    void arhl() {
        t_ += 3;
        s_.f = static_cast<uint8_t>((s_.f & ~flag::kCarry) | (s_.l & 1));
        set_hl(static_cast<uint16_t>(s_.hl() >> 1 | (s_.hl() & 0x8000)));
    }
    // Rotated left through CY; V tells that the sign has changed.
    void rdel() {
        t_ += 6;
        const uint16_t old = s_.de();
        set_de(static_cast<uint16_t>(old << 1 | carry()));
        s_.f = rotate_wide_flags(s_.f, (old & 0x8000) != 0, ((old ^ old << 1) & 0x8000) != 0);
    }

    // -- Control
    // -----------------------------------------------------------------------------------
    [[nodiscard]] bool holds(unsigned condition) const { return condition_holds(condition, s_.f); }
    void call(uint16_t address) {
        push(static_cast<uint8_t>(s_.pc >> 8), static_cast<uint8_t>(s_.pc));
        s_.pc = address;
    }
    // A branch not taken reads the low address byte only.
    void jump_if(bool taken) {
        if (taken) {
            s_.pc = operand_word();
        } else {
            operand();
            ++s_.pc;
        }
    }
    void call_if(bool taken) {
        t_ += 2;
        if (taken) {
            call(operand_word());
        } else {
            operand();
            ++s_.pc;
        }
    }
    void return_if(bool taken) {
        t_ += 2;
        if (taken) s_.pc = pop();
    }
    void restart_on_overflow() {
        t_ += 2;
        if ((s_.f & flag::kV) != 0) call(0x0040);
    }
    void xchg() {
        const uint16_t old = s_.hl();
        set_hl(s_.de());
        set_de(old);
    }
    void xthl() {
        const uint8_t low = load(s_.sp);
        const uint8_t high = load(static_cast<uint16_t>(s_.sp + 1));
        store(static_cast<uint16_t>(s_.sp + 1), s_.h);
        store(s_.sp, s_.l);
        s_.h = high;
        s_.l = low;
    }

    // -- Interrupt masks and the serial line
    // ---------------------------------------------------------
    void rim() {
        bus_.update_pins(t_ - 1);  // T3 of the only cycle
        const bool enable = s_.trap_saved_valid ? s_.trap_saved_enable : s_.interrupt_enable;
        s_.trap_saved_valid = false;
        s_.a = static_cast<uint8_t>(
            (s_.pin(Pin::sid).level ? 0x80 : 0) | (s_.rst75_latch ? 0x40 : 0) |
            (s_.pin(Pin::rst65).level ? 0x20 : 0) | (s_.pin(Pin::rst55).level ? 0x10 : 0) |
            (enable ? 0x08 : 0) | s_.masks);
    }
    void sim() {
        if ((s_.a & 0x08) != 0) s_.masks = s_.a & mask::kAll;
        if ((s_.a & 0x10) != 0) s_.rst75_latch = false;
        if ((s_.a & 0x40) != 0) {
            s_.sod = (s_.a & 0x80) != 0;
            bus_.serial_out(s_.sod, t_);
        }
    }

    CpuState& s_;
    B& bus_;
    uint64_t t_;  ///< inside an instruction: T-states up to here
    bool all_;
};

}  // namespace host_sim
