// vectors_test.cpp - single instructions on which three separately written 8085 cores agree, on
// both interpreters: registers, settled flags, T-states, and all 64 KB of memory afterwards. Source
// the collection's README.md (format, origin); skipped when it is absent.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "host_sim/cpu/flat_machine.hpp"

namespace {

using host_sim::CpuState;
using host_sim::FlatMachine;
using host_sim::FlatMemory;

struct Registers {
    unsigned pc = 0, sp = 0, a = 0, f = 0, bc = 0, de = 0, hl = 0;
    bool operator==(const Registers&) const = default;
};

std::string text(const Registers& r) {
    return fmt::format("PC {:04X} SP {:04X} A {:02X} F {:02X} BC {:04X} DE {:04X} HL {:04X}", r.pc,
                       r.sp, r.a, r.f, r.bc, r.de, r.hl);
}

struct Write {
    uint16_t address = 0;
    uint8_t value = 0;
};

struct Case {
    int line = 0;
    std::array<uint8_t, 3> code{};
    Registers before, after;
    unsigned t_states = 0;
    unsigned flag_mask = 0;
    std::vector<Write> writes;
};

std::istream& operator>>(std::istream& in, Registers& r) {
    return in >> r.pc >> r.sp >> r.a >> r.f >> r.bc >> r.de >> r.hl;
}

/// `op b1 b2 | PC SP A F BC DE HL -> PC SP A F BC DE HL T fmask writes`, hexadecimal but T.
Case parse(const std::string& line, int number) {
    std::istringstream in(line);
    Case result;
    result.line = number;
    std::string separator;
    std::string writes;
    in >> std::hex;
    for (uint8_t& byte : result.code) {
        unsigned value = 0;
        in >> value;
        byte = static_cast<uint8_t>(value);
    }
    in >> separator >> result.before >> separator >> result.after >> std::dec >> result.t_states >>
        std::hex >> result.flag_mask >> writes;
    EXPECT_TRUE(in) << "vectors.txt:" << number << ": not a case: " << line;
    if (writes == "-") return result;
    std::istringstream list(writes);
    for (std::string one; std::getline(list, one, ',');) {
        const std::size_t colon = one.find(':');
        result.writes.push_back(
            {static_cast<uint16_t>(std::stoul(one.substr(0, colon), nullptr, 16)),
             static_cast<uint8_t>(std::stoul(one.substr(colon + 1), nullptr, 16))});
    }
    return result;
}

CpuState state_of(const Registers& r) {
    CpuState cpu;
    cpu.pc = static_cast<uint16_t>(r.pc), cpu.sp = static_cast<uint16_t>(r.sp);
    cpu.a = static_cast<uint8_t>(r.a), cpu.f = static_cast<uint8_t>(r.f);
    cpu.b = static_cast<uint8_t>(r.bc >> 8), cpu.c = static_cast<uint8_t>(r.bc);
    cpu.d = static_cast<uint8_t>(r.de >> 8), cpu.e = static_cast<uint8_t>(r.de);
    cpu.h = static_cast<uint8_t>(r.hl >> 8), cpu.l = static_cast<uint8_t>(r.hl);
    cpu.t = 1000;  // the pins have long settled, else the fast interpreter is not used
    return cpu;
}

Registers registers_of(const CpuState& cpu) {
    return {cpu.pc, cpu.sp, cpu.a, cpu.f, cpu.bc(), cpu.de(), cpu.hl()};
}

/// Memory before every case, but for the instruction's bytes.
uint8_t filling(unsigned address) {
    return static_cast<uint8_t>(address * 167 + (address >> 8) * 59 + 13);
}

class Vectors : public testing::Test {
protected:
    static std::string path() { return ROVER_SOURCE_DIR "/../shared/data/iss8085/vectors.txt"; }

    void SetUp() override {
        std::ifstream file(path());
        if (!file) GTEST_SKIP() << "the vectors are not beside this repository: " << path();
        int number = 0;
        for (std::string line; std::getline(file, line);) {
            ++number;
            if (!line.empty() && line[0] != '#') cases_.push_back(parse(line, number));
        }
        for (unsigned address = 0; address < 0x10000; ++address) {
            machine_.memory.bytes[address] = expected_.bytes[address] = filling(address);
        }
    }

    template <class Run>
    void check_all(Run run) {
        int failures = 0;
        for (const Case& one : cases_) {
            const std::string wrong = check(one, run);
            if (wrong.empty()) continue;
            ADD_FAILURE() << "vectors.txt:" << one.line << ": opcode "
                          << fmt::format("{:02X}", one.code[0]) << ": " << wrong;
            if (++failures == 20) FAIL() << "and perhaps more";
        }
        // The collection's README: 64 cases for each of 254 opcodes.
        EXPECT_EQ(cases_.size(), 64U * 254U);
    }

private:
    template <class Run>
    std::string check(const Case& one, Run run) {
        machine_.cpu = state_of(one.before);
        for (unsigned i = 0; i < 3; ++i) {
            const auto address = static_cast<uint16_t>(one.before.pc + i);
            machine_.memory.bytes[address] = expected_.bytes[address] = one.code[i];
        }
        run(machine_, machine_.cpu.t + 1);  // any instruction is over by then, none before
        for (const Write& write : one.writes) expected_.bytes[write.address] = write.value;
        const std::string wrong = difference(one);
        machine_.memory.bytes = expected_.bytes;  // a wrong write spoils this case only
        for (unsigned i = 0; i < 3; ++i) {
            restore(static_cast<uint16_t>(one.before.pc + i));
        }
        for (const Write& write : one.writes) restore(write.address);
        return wrong;
    }

    std::string difference(const Case& one) const {
        std::string wrong;
        Registers left = registers_of(machine_.cpu);
        Registers right = one.after;
        left.f &= one.flag_mask;
        right.f &= one.flag_mask;
        if (left != right)
            wrong += fmt::format("\n  left    {}\n  expects {}", text(left), text(right));
        if (machine_.cpu.t - 1000 != one.t_states || machine_.cpu.instructions != 1) {
            wrong += fmt::format("\n  {} T-states and {} instructions, expected {} and 1",
                                 machine_.cpu.t - 1000, machine_.cpu.instructions, one.t_states);
        }
        if ((machine_.cpu.f & host_sim::flag::kUnused) != 0) wrong += "\n  bit 3 of F is set";
        if (machine_.memory.bytes == expected_.bytes) return wrong;
        for (unsigned address = 0; address < 0x10000; ++address) {
            const uint8_t value = machine_.memory.bytes[address];
            if (value == expected_.bytes[address]) continue;
            wrong += fmt::format("\n  memory {:04X} is {:02X}, expected {:02X}", address, value,
                                 expected_.bytes[address]);
        }
        return wrong;
    }

    void restore(uint16_t address) {
        machine_.memory.bytes[address] = expected_.bytes[address] = filling(address);
    }

    std::vector<Case> cases_;
    FlatMachine machine_;
    FlatMemory expected_;
};

TEST_F(Vectors, HoldOnTheReferenceInterpreter) {
    check_all([](FlatMachine& machine, uint64_t until_t) { machine.run_reference(until_t); });
}

TEST_F(Vectors, HoldOnTheFastInterpreter) {
    check_all([](FlatMachine& machine, uint64_t until_t) { machine.run(until_t); });
}

}  // namespace
