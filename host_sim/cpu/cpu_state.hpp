// cpu_state.hpp - everything an 8085 knows between two instructions, as one plain struct.
// Depends on   the standard library.
// Use          a snapshot is a copy, a comparison is ==. Whoever drives the processor's input pins
//              calls set_pin; the interpreters read them.
// Source       Intel 8085AH data sheet (1987); MCS-80/85 Family User's Manual.
#pragma once

#include <array>
#include <cstdint>

namespace host_sim {

/// Bits of the flag byte as PUSH PSW stores it. K and V are undocumented by Intel; bit 3 reads 0.
namespace flag {
inline constexpr uint8_t kSign = 0x80;
inline constexpr uint8_t kZero = 0x40;
inline constexpr uint8_t kK = 0x20;
inline constexpr uint8_t kAuxiliaryCarry = 0x10;
inline constexpr uint8_t kParity = 0x04;
inline constexpr uint8_t kV = 0x02;
inline constexpr uint8_t kCarry = 0x01;
inline constexpr uint8_t kUnused = 0x08;
}  // namespace flag

/// Which instructions exist. `documented` stops at the ten opcodes that Intel left out.
enum class InstructionSet : uint8_t { documented, all };

/// Input pins that the interpreter looks at.
enum class Pin : uint8_t { trap, rst75, rst65, rst55, intr, sid };
inline constexpr unsigned kPinCount = 6;

/// An input pin and its last two changes, so that it can be sampled two T-states back even when it
/// has changed in each of them.
struct PinState {
    bool level = false;
    bool previous = false;            ///< the level before the last change
    bool older = false;               ///< the level before the change before
    uint64_t changed_t = 0;           ///< T-state at whose beginning the level changed last
    uint64_t previous_changed_t = 0;  ///< and before

    bool operator==(const PinState&) const = default;
};

/// Interrupt masks as RIM and SIM hold them: 1 disables.
namespace mask {
inline constexpr uint8_t kRst55 = 0x01;
inline constexpr uint8_t kRst65 = 0x02;
inline constexpr uint8_t kRst75 = 0x04;
inline constexpr uint8_t kAll = 0x07;
}  // namespace mask

/// Registers, interrupt logic, pins and time. Register contents after power-on are undefined on the
/// part; here they are 0 so that two runs agree.
struct CpuState {
    uint8_t a = 0;
    uint8_t f = 0;
    uint8_t b = 0;
    uint8_t c = 0;
    uint8_t d = 0;
    uint8_t e = 0;
    uint8_t h = 0;
    uint8_t l = 0;
    uint16_t sp = 0;
    uint16_t pc = 0;
    uint64_t t = 0;             ///< T-states since power-on
    uint64_t instructions = 0;  ///< executed since power-on; accepted interrupts do not count

    bool halted = false;
    bool interrupt_enable = false;  ///< the IE flip-flop
    bool ei_shadow = false;         ///< the last instruction was EI: no maskable interrupt yet
    uint8_t masks = mask::kAll;
    bool rst75_latch = false;
    uint64_t rst75_latched_t = 0;
    bool trap_latch = false;  ///< a rising edge of TRAP is waiting
    uint64_t trap_latched_t = 0;
    bool trap_saved_valid = false;   ///< no RIM since the last TRAP
    bool trap_saved_enable = false;  ///< IE as it was before that TRAP
    bool sod = false;
    std::array<PinState, kPinCount> pins{};
    uint64_t pins_changed_t = 0;  ///< the latest change of all pins

    [[nodiscard]] uint16_t bc() const { return static_cast<uint16_t>(b << 8 | c); }
    [[nodiscard]] uint16_t de() const { return static_cast<uint16_t>(d << 8 | e); }
    [[nodiscard]] uint16_t hl() const { return static_cast<uint16_t>(h << 8 | l); }
    [[nodiscard]] const PinState& pin(Pin which) const {
        return pins[static_cast<unsigned>(which)];
    }

    bool operator==(const CpuState&) const = default;
};

/// Drives an input pin from the beginning of T-state `t`, setting the RST 7.5 and TRAP edge
/// latches. Calls for one pin come in the order of their times, none ahead of the next instruction
/// boundary; an unchanged level is no event.
void set_pin(CpuState& cpu, Pin which, bool level, uint64_t t);

/// The RESET IN pin: PC 0, interrupts disabled and masked, latches cleared, SOD low, out of HALT.
/// Registers, flags, pins and time stay as they are.
void reset(CpuState& cpu);

}  // namespace host_sim
