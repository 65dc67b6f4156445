// fast_registers.hpp - the processor's registers as host locals, with lazy flags and a packed
// clock. Depends on   cpu_state.hpp, flags.hpp, flat_memory.hpp. Lazy flags   no instruction builds
// a flag byte. `result` gives S, Z and P when somebody asks,
//              `carries` AC and V, `carry` is CY, `k_source` K.
// Clock        T-states left and instructions done in one word, so that one addition counts both
// and
//              its sign says stop.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

#include "host_sim/cpu/cpu_state.hpp"
#include "host_sim/cpu/flags.hpp"
#include "host_sim/cpu/flat_memory.hpp"

namespace host_sim::fast {

/// Result words that no byte has: Z set together with S, or without P, as POP PSW can load them.
inline constexpr uint32_t kZeroWithSign = 0x100;
inline constexpr uint32_t kZeroWithoutParity = 0x200;
inline constexpr uint32_t kSignBits = 0x80 | kZeroWithSign;

/// S, Z and P of a result word. Of the words above FFH only those with a zero low byte occur.
inline constexpr std::array<uint8_t, 0x400> kResultFlags = [] {
    std::array<uint8_t, 0x400> table{};
    for (uint32_t word = 0; word < table.size(); ++word) {
        uint8_t flags = kSignZeroParity[word & 0xFF];
        if ((word & kZeroWithSign) != 0) flags |= flag::kSign;
        if ((word & kZeroWithoutParity) != 0) flags = static_cast<uint8_t>(flags & ~flag::kParity);
        table[word] = flags;
    }
    return table;
}();

/// A result word with the given S, Z and P.
constexpr uint32_t result_word(uint8_t flags) {
    const bool sign = (flags & flag::kSign) != 0;
    const bool parity = (flags & flag::kParity) != 0;
    if ((flags & flag::kZero) != 0) {
        return (sign ? kZeroWithSign : 0) | (parity ? 0 : kZeroWithoutParity);
    }
    if (sign) return parity ? 0x81 : 0x80;
    return parity ? 0x03 : 0x01;
}

inline constexpr uint32_t kKIsVXorS = 0x10000;  ///< `k_source` after arithmetic; else K = (it is 0)

/// One run's clock. At most kSlice T-states, so that the instruction count fits its 20 bits.
inline constexpr unsigned kCountBits = 20;
inline constexpr uint64_t kSlice = uint64_t{1} << 21;

/// What one instruction of `t_states` adds to the clock.
constexpr int64_t clock_step(int t_states) {
    return 1 - (static_cast<int64_t>(t_states) << kCountBits);
}

/// Registers are 32 bits wide in the host but hold 8 (sp, pc: 16) at every boundary.
struct Registers {
    uint32_t a, b, c, d, e, h, l, sp, pc;
    uint32_t result, carries, carry, k_source;
    int64_t clock;

    [[nodiscard]] bool v() const { return ((carries >> 7 ^ carries >> 8) & 1) != 0; }
    [[nodiscard]] bool k() const {
        if (k_source == kKIsVXorS) return v() != ((result & kSignBits) != 0);
        return k_source == 0;
    }
    [[nodiscard]] uint32_t flags() const {
        return kResultFlags[result] | (carries & flag::kAuxiliaryCarry) | carry |
               (v() ? flag::kV : 0U) | (k() ? flag::kK : 0U);
    }
    void set_flags(uint32_t flags) {
        result = result_word(static_cast<uint8_t>(flags));
        carries = (flags & flag::kAuxiliaryCarry) | ((flags & flag::kV) != 0 ? 0x80 : 0);
        carry = flags & flag::kCarry;
        k_source = (flags & flag::kK) != 0 ? 0 : 1;
    }

    /// Takes the state over for a run of at most `t_states` T-states (at least 1).
    void load(const CpuState& cpu, uint64_t t_states) {
        a = cpu.a, b = cpu.b, c = cpu.c, d = cpu.d, e = cpu.e, h = cpu.h, l = cpu.l;
        sp = cpu.sp, pc = cpu.pc;
        set_flags(cpu.f);
        clock = static_cast<int64_t>(std::min(t_states, kSlice) - 1) << kCountBits;
    }
    /// Gives the state back, `t_states` being what load() was told.
    void store(CpuState& cpu, uint64_t t_states) const {
        cpu.a = static_cast<uint8_t>(a), cpu.f = static_cast<uint8_t>(flags());
        cpu.b = static_cast<uint8_t>(b), cpu.c = static_cast<uint8_t>(c);
        cpu.d = static_cast<uint8_t>(d), cpu.e = static_cast<uint8_t>(e);
        cpu.h = static_cast<uint8_t>(h), cpu.l = static_cast<uint8_t>(l);
        cpu.sp = static_cast<uint16_t>(sp), cpu.pc = static_cast<uint16_t>(pc);
        const auto left = clock >> kCountBits;
        cpu.t += static_cast<uint64_t>(static_cast<int64_t>(std::min(t_states, kSlice) - 1) - left);
        cpu.instructions += static_cast<uint64_t>(clock & ((int64_t{1} << kCountBits) - 1));
    }
};

}  // namespace host_sim::fast
