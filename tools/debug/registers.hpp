// registers.hpp - the processor's registers, flags and time by name.
// Depends on   host_sim/cpu.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "host_sim/cpu/cpu_state.hpp"

namespace debug_console {

/// What a name in an expression can mean besides symbols. `instructions` counts executed ones.
enum class Register : uint8_t {
    // clang-format off
    a, f, b, c, d, e, h, l, bc, de, hl, psw, sp, pc,
    sign, zero, k, auxiliary_carry, parity, v, carry,
    interrupt_enable, masks, t, instructions,
    // clang-format on
};

/// A register by its Intel name, in any case of letters: A ... L, BC (or B pair names), PSW, SP,
/// PC (or $), S, Z, K, AC, P, V, CY, IE, MASKS, T, N.
[[nodiscard]] std::optional<Register> find_register(std::string_view name);

/// Flags and IE are 0 or 1.
[[nodiscard]] int64_t register_value(const host_sim::CpuState& cpu, Register which);

/// Sets a register, a flag or IE.
/// @errors DebugError when the value does not fit, or the register is a count (T, N)
void set_register(host_sim::CpuState& cpu, Register which, int64_t value);

/// "S0 Z1 K0 AC0 P1 V0 CY0"
[[nodiscard]] std::string flags_text(uint8_t f);

/// "7.5 5.5" for the bits of interrupt masks; "none".
[[nodiscard]] std::string masks_text(uint8_t masks);

/// Interrupts that are waiting, masked or not: "TRAP 7.5 6.5 5.5"; "none".
[[nodiscard]] std::string pending_text(const host_sim::CpuState& cpu);

/// T-states with the time they take at 3.072 MHz: "T 30720 (10.000 ms)".
[[nodiscard]] std::string time_text(uint64_t t);

}  // namespace debug_console
