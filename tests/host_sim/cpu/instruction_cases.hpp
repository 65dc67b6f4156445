// instruction_cases.hpp - one instruction by hand: registers before, registers and flags after, on
// both interpreters.
#pragma once

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <string>
#include <vector>

#include "host_sim/cpu/flat_machine.hpp"

namespace cpu_test {

/// What an instruction can change but memory.
struct Values {
    int a = 0, bc = 0, de = 0, hl = 0, sp = 0x8000, pc = 0x0100;
    std::string flags{};  ///< letters of those that are set: S Z K A P V C
    bool operator==(const Values&) const = default;
};

inline constexpr std::string_view kFlagLetters = "SZKA.PVC";

inline std::string letters(unsigned flags) {
    std::string result;
    for (unsigned i = 0; i < 8; ++i) {
        if ((flags >> (7 - i) & 1U) != 0) result += kFlagLetters[i];
    }
    return result;
}
inline uint8_t flag_byte(const std::string& text) {
    unsigned flags = 0;
    for (const char letter : text) flags |= 0x80U >> kFlagLetters.find(letter);
    return static_cast<uint8_t>(flags);
}
inline std::ostream& operator<<(std::ostream& out, const Values& values) {
    return out << fmt::format("A {:02X} BC {:04X} DE {:04X} HL {:04X} SP {:04X} PC {:04X} flags {}",
                              values.a, values.bc, values.de, values.hl, values.sp, values.pc,
                              values.flags);
}

/// Executes `code` at 0100H with `before` on one interpreter or the other.
inline Values execute(const std::vector<int>& code, const Values& before, bool fast) {
    host_sim::FlatMachine machine;
    uint16_t address = 0x0100;
    for (const int byte : code) machine.memory.bytes[address++] = static_cast<uint8_t>(byte);
    host_sim::CpuState& cpu = machine.cpu;
    cpu.t = 1000;
    cpu.a = static_cast<uint8_t>(before.a);
    cpu.b = static_cast<uint8_t>(before.bc >> 8), cpu.c = static_cast<uint8_t>(before.bc);
    cpu.d = static_cast<uint8_t>(before.de >> 8), cpu.e = static_cast<uint8_t>(before.de);
    cpu.h = static_cast<uint8_t>(before.hl >> 8), cpu.l = static_cast<uint8_t>(before.hl);
    cpu.sp = static_cast<uint16_t>(before.sp), cpu.pc = 0x0100;
    cpu.f = flag_byte(before.flags);
    if (fast) {
        machine.run(1001);
    } else {
        machine.run_reference(1001);
    }
    return {cpu.a, cpu.bc(), cpu.de(), cpu.hl(), cpu.sp, cpu.pc, letters(cpu.f)};
}

/// Expects `after` of both interpreters; its PC is set to the next instruction unless it jumps.
inline void expect(const std::vector<int>& code, const Values& before, Values after) {
    if (after.pc == 0x0100) after.pc += static_cast<int>(code.size());
    for (const bool fast : {false, true}) {
        EXPECT_EQ(execute(code, before, fast), after)
            << (fast ? "fast" : "reference") << fmt::format(" opcode {:02X} before: ", code[0])
            << testing::PrintToString(before);
    }
}

}  // namespace cpu_test
