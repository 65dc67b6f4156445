// interrupt_bench.hpp - a processor before an interrupt, and the table of interrupt inputs.
#pragma once

#include <gtest/gtest.h>

#include <initializer_list>

#include "scripted_machine.hpp"

namespace cpu_test {

using host_sim::Interrupt;
using host_sim::Pin;
using host_sim::StepRecord;
using Kind = StepRecord::Kind;

inline constexpr int kNop = 0x00, kInrA = 0x3C, kSim = 0x30, kMviA = 0x3E, kHlt = 0x76, kRet = 0xC9,
                     kDi = 0xF3, kEi = 0xFB, kLxiH = 0x21, kCallOpcode = 0xCD;
inline constexpr uint16_t kCode = 0x0100;
inline constexpr uint16_t kStack = 0x9000;
inline constexpr uint64_t kBegin = 1000;

/// Memory is full of NOPs (4 T). Interrupts are enabled and unmasked, all pins low.
struct Bench : ScriptedMachine {
    Bench() {
        cpu.pc = kCode;
        cpu.sp = kStack;
        cpu.t = kBegin;
        cpu.masks = 0;
        cpu.interrupt_enable = true;
    }
    void code(std::initializer_list<int> bytes) { put(kCode, bytes); }
    void drive(Pin pin, bool level, uint64_t t) { host_sim::set_pin(cpu, pin, level, t); }
    /// High long ago.
    void raise(Pin pin) { drive(pin, true, kBegin - 100); }
    /// High for long, and low again for long.
    void pulse(Pin pin) {
        drive(pin, true, kBegin - 100);
        drive(pin, false, kBegin - 50);
    }
    /// Executes `count` steps that must be instructions.
    void instructions(int count) {
        for (int i = 0; i < count; ++i) ASSERT_EQ(step().kind, Kind::instruction) << "step " << i;
    }
    [[nodiscard]] unsigned pushed() const {
        return memory.bytes[cpu.sp] | unsigned{memory.bytes[cpu.sp + 1U]} << 8;
    }
    [[nodiscard]] uint64_t elapsed() const { return cpu.t - kBegin; }
};

struct Source {
    Pin pin;
    Kind kind;
    Interrupt interrupt;
    uint16_t vector;
    uint8_t mask;
    const char* name;
};

// Data sheet: table "Interrupt Priority, Restart Address, and Sensitivity", highest first. INTR:
// RST 7 from the open bus.
inline constexpr Source kSources[] = {
    {Pin::trap, Kind::trap, Interrupt::trap, 0x0024, 0, "TRAP"},
    {Pin::rst75, Kind::rst75, Interrupt::rst75, 0x003C, 4, "RST 7.5"},
    {Pin::rst65, Kind::rst65, Interrupt::rst65, 0x0034, 2, "RST 6.5"},
    {Pin::rst55, Kind::rst55, Interrupt::rst55, 0x002C, 1, "RST 5.5"},
    {Pin::intr, Kind::intr, Interrupt::intr, 0x0038, 0, "INTR"},
};
inline constexpr Pin kLevelPins[] = {Pin::rst65, Pin::rst55, Pin::intr};

}  // namespace cpu_test
