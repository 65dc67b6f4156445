// registers_test.cpp - registers by name; flag bits from the data sheet's PSW: S Z K AC 0 P V CY.
#include "tools/debug/registers.hpp"

#include <gtest/gtest.h>

#include "tools/debug/debug_error.hpp"

namespace debug_console {
namespace {

using host_sim::CpuState;

Register named(const char* name) {
    const auto which = find_register(name);
    EXPECT_TRUE(which.has_value()) << name;
    return which.value_or(Register::a);
}

TEST(Registers, EachIsSetAndReadBackAlone) {
    const std::pair<const char*, int64_t> values[] = {
        {"A", 0xA3},    {"B", 0xA3},    {"C", 0xA3},    {"D", 0xA3},    {"E", 0xA3},
        {"H", 0xA3},    {"L", 0xA3},    {"BC", 0xA35C}, {"DE", 0xA35C}, {"HL", 0xA35C},
        {"SP", 0xA35C}, {"PC", 0xA35C}, {"S", 1},       {"Z", 1},       {"K", 1},
        {"AC", 1},      {"P", 1},       {"V", 1},       {"CY", 1},      {"IE", 1}};
    for (const auto& [name, value] : values) {
        CpuState cpu;
        const CpuState before;
        set_register(cpu, named(name), value);
        EXPECT_EQ(register_value(cpu, named(name)), value) << name;
        EXPECT_FALSE(cpu == before) << name;
        set_register(cpu, named(name), 0);
        EXPECT_TRUE(cpu == before) << name << " touches nothing else";
    }
}

TEST(Registers, PairsAreHighThenLow) {
    CpuState cpu;
    set_register(cpu, named("hl"), 0x1234);
    EXPECT_EQ(cpu.h, 0x12);
    EXPECT_EQ(cpu.l, 0x34);
    set_register(cpu, named("PSW"), 0x12FF);
    EXPECT_EQ(cpu.a, 0x12);
    EXPECT_EQ(cpu.f, 0xF7) << "bit 3 does not exist";
    set_register(cpu, named("F"), 0xFF);
    EXPECT_EQ(cpu.f, 0xF7);
    EXPECT_EQ(register_value(cpu, named("PSW")), 0x12F7);
}

TEST(Registers, FlagsHaveTheirBits) {
    const std::pair<const char*, uint8_t> bits[] = {{"S", 0x80},  {"Z", 0x40}, {"K", 0x20},
                                                    {"AC", 0x10}, {"P", 0x04}, {"V", 0x02},
                                                    {"CY", 0x01}};
    for (const auto& [name, bit] : bits) {
        CpuState cpu;
        set_register(cpu, named(name), 1);
        EXPECT_EQ(cpu.f, bit) << name;
    }
    EXPECT_EQ(flags_text(0xD5), "S1 Z1 K0 AC1 P1 V0 CY1");
    EXPECT_EQ(flags_text(0x22), "S0 Z0 K1 AC0 P0 V1 CY0");
}

TEST(Registers, RefuseWhatDoesNotFit) {
    CpuState cpu;
    EXPECT_THROW(set_register(cpu, named("A"), 256), DebugError);
    EXPECT_THROW(set_register(cpu, named("A"), -1), DebugError);
    EXPECT_THROW(set_register(cpu, named("HL"), 0x10000), DebugError);
    EXPECT_THROW(set_register(cpu, named("CY"), 2), DebugError);
    EXPECT_THROW(set_register(cpu, named("T"), 0), DebugError);
    EXPECT_THROW(set_register(cpu, named("N"), 0), DebugError);
    EXPECT_TRUE(cpu == CpuState());
    EXPECT_FALSE(find_register("X").has_value());
    EXPECT_FALSE(find_register("").has_value());
}

TEST(Registers, SettingPcEndsHalt) {
    CpuState cpu;
    cpu.halted = true;
    set_register(cpu, named("$"), 0x100);
    EXPECT_EQ(cpu.pc, 0x100);
    EXPECT_FALSE(cpu.halted);
}

TEST(Registers, MasksAndPendingInterruptsAreNamed) {
    CpuState cpu;
    EXPECT_EQ(masks_text(cpu.masks), "7.5 6.5 5.5");
    EXPECT_EQ(masks_text(0), "none");
    EXPECT_EQ(masks_text(0x02), "6.5");
    EXPECT_EQ(pending_text(cpu), "none");
    set_pin(cpu, host_sim::Pin::trap, true, 1);
    set_pin(cpu, host_sim::Pin::rst75, true, 2);
    set_pin(cpu, host_sim::Pin::rst55, true, 3);
    EXPECT_EQ(pending_text(cpu), "TRAP 7.5 5.5");
}

// 30720 T at 3.072 MHz are 10 ms.
TEST(Registers, TimeHasItsMilliseconds) {
    EXPECT_EQ(time_text(30720), "T 30720 (10.000 ms)");
    EXPECT_EQ(time_text(1), "T 1 (0.000 ms)");
}

}  // namespace
}  // namespace debug_console
