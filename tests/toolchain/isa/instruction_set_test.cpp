// instruction_set_test.cpp - the table against T-states, lengths and machine cycles typed in again
// from Intel's data: the T-state chart of the MCS-80/85 Family User's Manual by opcode.
#include "toolchain/isa/instruction_set.hpp"

#include <gtest/gtest.h>

#include <set>
#include <string>

namespace {

using namespace toolchain::isa;  // NOLINT: a test of this namespace

/// T-states by opcode; a conditional one as not taken * 100 + taken.
constexpr int kTStates[256] = {
    4,   10, 7,   6,  4,   4,  7,  4,  10,  10, 7,   6,   4,   4,   7, 4,   // 0_
    7,   10, 7,   6,  4,   4,  7,  4,  10,  10, 7,   6,   4,   4,   7, 4,   // 1_
    4,   10, 16,  6,  4,   4,  7,  4,  10,  10, 16,  6,   4,   4,   7, 4,   // 2_
    4,   10, 13,  6,  10,  10, 10, 4,  10,  10, 13,  6,   4,   4,   7, 4,   // 3_
    4,   4,  4,   4,  4,   4,  7,  4,  4,   4,  4,   4,   4,   4,   7, 4,   // 4_
    4,   4,  4,   4,  4,   4,  7,  4,  4,   4,  4,   4,   4,   4,   7, 4,   // 5_
    4,   4,  4,   4,  4,   4,  7,  4,  4,   4,  4,   4,   4,   4,   7, 4,   // 6_
    7,   7,  7,   7,  7,   7,  5,  7,  4,   4,  4,   4,   4,   4,   7, 4,   // 7_
    4,   4,  4,   4,  4,   4,  7,  4,  4,   4,  4,   4,   4,   4,   7, 4,   // 8_
    4,   4,  4,   4,  4,   4,  7,  4,  4,   4,  4,   4,   4,   4,   7, 4,   // 9_
    4,   4,  4,   4,  4,   4,  7,  4,  4,   4,  4,   4,   4,   4,   7, 4,   // A_
    4,   4,  4,   4,  4,   4,  7,  4,  4,   4,  4,   4,   4,   4,   7, 4,   // B_
    612, 10, 710, 10, 918, 12, 7,  12, 612, 10, 710, 612, 918, 18,  7, 12,  // C_
    612, 10, 710, 10, 918, 12, 7,  12, 612, 10, 710, 10,  918, 710, 7, 12,  // D_
    612, 10, 710, 16, 918, 12, 7,  12, 612, 6,  710, 4,   918, 10,  7, 12,  // E_
    612, 10, 710, 4,  918, 12, 7,  12, 612, 6,  710, 4,   918, 710, 7, 12,  // F_
};

TEST(InstructionSet, TStatesAreThoseOfTheChart) {
    for (unsigned opcode = 0; opcode < 256; ++opcode) {
        const Instruction& entry = instruction(static_cast<uint8_t>(opcode));
        const int chart = kTStates[opcode];
        EXPECT_EQ(entry.t_not_taken, chart > 100 ? chart / 100 : chart) << entry.text();
        EXPECT_EQ(entry.t_taken, chart % 100) << entry.text();
        EXPECT_EQ(entry.conditional(), chart > 100) << entry.text();
        EXPECT_EQ(entry.opcode, opcode);
    }
}

TEST(InstructionSet, TextsAreDifferentAndInIntelsOrder) {
    std::set<std::string> texts;
    for (const Instruction& entry : instruction_set()) texts.emplace(entry.text());
    EXPECT_EQ(texts.size(), 256u);

    // The corners of each regular block.
    EXPECT_EQ(instruction(0x40).text(), "MOV B,B");
    EXPECT_EQ(instruction(0x7F).text(), "MOV A,A");
    EXPECT_EQ(instruction(0x5E).text(), "MOV E,M");
    EXPECT_EQ(instruction(0x71).text(), "MOV M,C");
    EXPECT_EQ(instruction(0x31).text(), "LXI SP,d16");
    EXPECT_EQ(instruction(0x36).text(), "MVI M,d8");
    EXPECT_EQ(instruction(0x3D).text(), "DCR A");
    EXPECT_EQ(instruction(0x12).text(), "STAX D");
    EXPECT_EQ(instruction(0x0A).text(), "LDAX B");
    EXPECT_EQ(instruction(0x97).text(), "SUB A");
    EXPECT_EQ(instruction(0xBD).text(), "CMP L");
    EXPECT_EQ(instruction(0xF5).text(), "PUSH PSW");
    EXPECT_EQ(instruction(0xE1).text(), "POP H");
    EXPECT_EQ(instruction(0xE2).text(), "JPO a16");
    EXPECT_EQ(instruction(0xFC).text(), "CM a16");
    EXPECT_EQ(instruction(0xD8).text(), "RC");
    EXPECT_EQ(instruction(0xF7).text(), "RST 6");
    EXPECT_EQ(instruction(0xDB).text(), "IN p8");
}

TEST(InstructionSet, MnemonicAndOperandsAreTheTwoPartsOfTheText) {
    EXPECT_EQ(instruction(0x01).mnemonic(), "LXI");
    EXPECT_EQ(instruction(0x01).operands(), "B,d16");
    EXPECT_EQ(instruction(0xC9).mnemonic(), "RET");
    EXPECT_EQ(instruction(0xC9).operands(), "");
}

TEST(InstructionSet, TenOpcodesAreUndocumented) {
    const std::set<std::string> expected = {"DSUB", "ARHL", "RDEL", "LDHI d8", "LDSI d8",
                                            "RSTV", "SHLX", "LHLX", "JNK a16", "JK a16"};
    std::set<std::string> found;
    for (const Instruction& entry : instruction_set()) {
        if (!entry.documented) found.emplace(entry.text());
    }
    EXPECT_EQ(found, expected);
    EXPECT_EQ(instruction(0xDD).alternate_mnemonic, "JNX5");
    EXPECT_EQ(instruction(0xFD).alternate_mnemonic, "JX5");
}

TEST(InstructionSet, MachineCyclesOfOneInstructionOfEachForm) {
    using enum BusCycle;
    const auto cycles = [](std::initializer_list<BusCycle> list) {
        BusCycles result;
        for (const BusCycle kind : list) result.kinds[result.count++] = kind;
        return result;
    };
    EXPECT_EQ(instruction(0xE3).cycles_taken,
              cycles({fetch4, memory_read, memory_read, memory_write, memory_write}));
    EXPECT_EQ(instruction(0xCD).cycles_taken,
              cycles({fetch6, memory_read, memory_read, memory_write, memory_write}));
    EXPECT_EQ(instruction(0xC4).cycles_not_taken, cycles({fetch6, memory_read}));
    EXPECT_EQ(instruction(0xC2).cycles_not_taken, cycles({fetch4, memory_read}));
    EXPECT_EQ(instruction(0xC2).cycles_taken, cycles({fetch4, memory_read, memory_read}));
    EXPECT_EQ(instruction(0xC0).cycles_not_taken, cycles({fetch6}));
    EXPECT_EQ(instruction(0xC0).cycles_taken, cycles({fetch6, memory_read, memory_read}));
    EXPECT_EQ(instruction(0x09).cycles_taken, cycles({fetch4, bus_idle, bus_idle}));
    EXPECT_EQ(instruction(0xDB).cycles_taken, cycles({fetch4, memory_read, io_read}));
    EXPECT_EQ(instruction(0xD3).cycles_taken, cycles({fetch4, memory_read, io_write}));
    EXPECT_EQ(instruction(0x34).cycles_taken, cycles({fetch4, memory_read, memory_write}));
    EXPECT_EQ(instruction(0x76).cycles_taken, cycles({fetch4, bus_idle}));
}

TEST(InstructionSet, DocumentedFlagsAreThoseOfTheManual) {
    constexpr uint8_t kDocumented =
        flag::kSign | flag::kZero | flag::kAuxiliaryCarry | flag::kParity | flag::kCarry;
    for (const Instruction& entry : instruction_set()) {
        if (!entry.documented) continue;
        const std::string name(entry.mnemonic());
        uint8_t expected = 0;
        static const std::set<std::string> kAll = {"ADD", "ADI", "ADC", "ACI", "SUB", "SUI",
                                                   "SBB", "SBI", "ANA", "ANI", "XRA", "XRI",
                                                   "ORA", "ORI", "CMP", "CPI", "DAA"};
        static const std::set<std::string> kCarryOnly = {"DAD", "RLC", "RRC", "RAL",
                                                         "RAR", "STC", "CMC"};
        if (kAll.contains(name) || entry.text() == "POP PSW") expected = kDocumented;
        if (kCarryOnly.contains(name)) expected = flag::kCarry;
        if (name == "INR" || name == "DCR") expected = kDocumented & ~flag::kCarry;
        EXPECT_EQ(entry.flags & kDocumented, expected) << entry.text();
        EXPECT_EQ(entry.flags_unsettled & kDocumented, 0) << entry.text();
    }
    // K counts the 16-bit increment's carry: the undocumented loop end.
    EXPECT_EQ(instruction(0x0B).flags, flag::kK);
    EXPECT_EQ(instruction(0x18).flags, flag::kCarry | flag::kV);
}

TEST(InstructionSet, FlowNamesWhatChangesTheProgramCounter) {
    EXPECT_EQ(instruction(0xC3).flow, Flow::jump);
    EXPECT_EQ(instruction(0xDD).flow, Flow::jump);
    EXPECT_EQ(instruction(0xE9).flow, Flow::jump_hl);
    EXPECT_EQ(instruction(0xDC).flow, Flow::call);
    EXPECT_EQ(instruction(0xF8).flow, Flow::ret);
    EXPECT_EQ(instruction(0xCF).flow, Flow::restart);
    EXPECT_EQ(instruction(0xCB).flow, Flow::restart);
    EXPECT_EQ(instruction(0x76).flow, Flow::halt);
    int others = 0;
    for (const Instruction& entry : instruction_set()) others += entry.flow == Flow::next ? 1 : 0;
    // 1 JMP, 8 Jcc, JNK, JK, PCHL; 1 CALL, 8 Ccc; 1 RET, 8 Rcc; 8 RST, RSTV; HLT.
    EXPECT_EQ(others, 256 - 12 - 9 - 9 - 9 - 1);
}

}  // namespace
