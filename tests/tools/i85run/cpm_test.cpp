// cpm_test.cpp - BDOS calls by the CP/M 2.2 manual: results, side effects and cost.
#include "tools/i85run/cpm.hpp"

#include <gtest/gtest.h>

#include <deque>
#include <string>
#include <vector>

namespace {

using i85run::Cpm;
using i85run::Machine;
using i85run::Stop;

class I85runCpm : public testing::Test {
protected:
    I85runCpm()
        : cpm_({[this](char character) { printed_ += character; }, [this] { return next_key(); },
                true, [this](const std::string& line) { warnings_.push_back(line); }}) {}

    int next_key() {
        if (keys_.empty()) return -1;
        const int key = keys_.front();
        keys_.pop_front();
        return key;
    }

    void start(std::vector<uint8_t> program = {0xC9}) { cpm_.start(machine_, program); }

    /// A CALL 0005h from 0100h has just been executed. @return whether the program goes on
    bool call_bdos(uint8_t function, uint16_t de = 0) {
        machine_.cpu.c = function;
        machine_.cpu.d = static_cast<uint8_t>(de >> 8);
        machine_.cpu.e = static_cast<uint8_t>(de);
        machine_.cpu.sp = 0xFD00;
        machine_.memory.bytes[0xFD00] = 0x03;
        machine_.memory.bytes[0xFD01] = 0x01;
        machine_.cpu.pc = 0x0005;
        return cpm_.serve_trap(machine_, record_);
    }

    [[nodiscard]] uint16_t word_at(uint16_t address) const {
        return static_cast<uint16_t>(machine_.memory.bytes[address] |
                                     machine_.memory.bytes[address + 1U] << 8);
    }

    void put_text(uint16_t address, std::string_view text) {
        for (const char character : text) {
            machine_.memory.bytes[address++] = static_cast<uint8_t>(character);
        }
    }

    Machine machine_;
    host_sim::StepRecord record_;
    std::string printed_;
    std::deque<int> keys_;
    std::vector<std::string> warnings_;
    Cpm cpm_;
};

TEST_F(I85runCpm, StartLoadsTheProgramAndPageZero) {
    start({0x3E, 0x42, 0xC9});
    EXPECT_EQ(machine_.memory.bytes[0x0100], 0x3E);
    EXPECT_EQ(machine_.memory.bytes[0x0102], 0xC9);
    EXPECT_EQ(word_at(0x0006), 0xFE00) << "top of memory";
    EXPECT_EQ(machine_.memory.bytes[0x0080], 0x00) << "empty command tail";
    EXPECT_EQ(machine_.memory.bytes[0x005D], ' ') << "blank file name";
    EXPECT_EQ(machine_.cpu.pc, 0x0100);
    EXPECT_EQ(word_at(machine_.cpu.sp), 0x0000) << "RET is a warm boot";
    EXPECT_LT(machine_.cpu.sp, 0xFE00);
}

TEST_F(I85runCpm, RetWithTheInitialStackIsAWarmBoot) {
    start({0xC9});
    EXPECT_EQ(machine_.run(1000), Stop::trap);
    EXPECT_EQ(machine_.cpu.t, 10u);
    EXPECT_EQ(machine_.cpu.pc, 0x0000);
    EXPECT_FALSE(cpm_.serve_trap(machine_, record_));
}

TEST_F(I85runCpm, EveryWayToTheWarmBootEndsTheProgram) {
    // JMP 0000h; RST 0; through the word at 0001h: LHLD 0001h, PCHL
    for (const auto& program :
         std::vector<std::vector<uint8_t>>{{0xC3, 0x00, 0x00}, {0xC7}, {0x2A, 0x01, 0x00, 0xE9}}) {
        start(program);
        machine_.cpu.t = 0;
        EXPECT_EQ(machine_.run(1000), Stop::trap);
        EXPECT_FALSE(cpm_.serve_trap(machine_, record_));
    }
}

TEST_F(I85runCpm, ResetEndsTheProgram) {
    start();
    EXPECT_FALSE(call_bdos(0));
}

TEST_F(I85runCpm, ACallCostsOneRet) {
    start();
    EXPECT_TRUE(call_bdos(2, 'x'));
    EXPECT_EQ(machine_.cpu.pc, 0x0103);
    EXPECT_EQ(machine_.cpu.sp, 0xFD02);
    EXPECT_EQ(machine_.cpu.t, 10u);
    EXPECT_EQ(machine_.cpu.instructions, 1u);
    EXPECT_EQ(record_.opcode(), 0xC9);
}

TEST_F(I85runCpm, TheBdosIsAlsoCalledAtItsAddressAt0006) {
    start();
    machine_.cpu.c = 2;
    machine_.cpu.e = 'y';
    machine_.cpu.pc = word_at(0x0006);
    EXPECT_TRUE(cpm_.serve_trap(machine_, record_));
    EXPECT_EQ(printed_, "y");
}

TEST_F(I85runCpm, ConsoleOutputPrintsE) {
    start();
    for (const char character : std::string("A\r\n\x80")) {
        call_bdos(2, static_cast<uint8_t>(character));
    }
    EXPECT_EQ(printed_, "A\r\n\x80");
}

TEST_F(I85runCpm, PrintStringEndsAtTheDollar) {
    start();
    put_text(0x2000, "Hello, 8085$not this");
    call_bdos(9, 0x2000);
    EXPECT_EQ(printed_, "Hello, 8085");
    put_text(0xFFFE, "ab");
    machine_.memory.bytes[0x0000] = '$';
    call_bdos(9, 0xFFFE);
    EXPECT_EQ(printed_, "Hello, 8085ab") << "addresses wrap";
}

TEST_F(I85runCpm, AStringWithoutEndIsPrintedOnceAround) {
    start();
    call_bdos(9, 0x4000);
    EXPECT_EQ(printed_.size(), 0x10000u);
    EXPECT_EQ(warnings_.size(), 1u);
}

TEST_F(I85runCpm, RegistersSurviveOutput) {
    start();
    machine_.cpu.a = 0x12;
    machine_.cpu.b = 0x34;
    machine_.cpu.h = 0x56;
    machine_.cpu.l = 0x78;
    machine_.cpu.f = 0x45;
    call_bdos(2, '.');
    EXPECT_EQ(machine_.cpu.a, 0x12);
    EXPECT_EQ(machine_.cpu.b, 0x34);
    EXPECT_EQ(machine_.cpu.hl(), 0x5678);
    EXPECT_EQ(machine_.cpu.f, 0x45);
}

TEST_F(I85runCpm, ConsoleInputEchoesAndEndsWithControlZ) {
    start();
    keys_ = {'q'};
    call_bdos(1);
    EXPECT_EQ(machine_.cpu.a, 'q');
    EXPECT_EQ(machine_.cpu.l, 'q');
    EXPECT_EQ(printed_, "q");
    call_bdos(1);
    EXPECT_EQ(machine_.cpu.a, 0x1A);
}

TEST_F(I85runCpm, DirectConsolePrintsOrFindsNoKey) {
    start();
    keys_ = {'q'};
    call_bdos(6, 'z');
    EXPECT_EQ(printed_, "z");
    machine_.cpu.a = 0x55;
    call_bdos(6, 0xFF);
    EXPECT_EQ(machine_.cpu.a, 0);
    EXPECT_EQ(printed_, "z");
}

TEST_F(I85runCpm, ReadLineFillsTheBuffer) {
    start();
    keys_ = {'a', 'b', '\r', 'c', 'd', 'e'};
    machine_.memory.bytes[0x3000] = 2;
    call_bdos(10, 0x3000);
    EXPECT_EQ(machine_.memory.bytes[0x3001], 2) << "full before the carriage return is read";
    EXPECT_EQ(machine_.memory.bytes[0x3002], 'a');
    EXPECT_EQ(machine_.memory.bytes[0x3003], 'b');
    machine_.memory.bytes[0x3000] = 80;
    call_bdos(10, 0x3000);
    EXPECT_EQ(machine_.memory.bytes[0x3001], 0) << "an empty line";
    call_bdos(10, 0x3000);
    EXPECT_EQ(machine_.memory.bytes[0x3001], 3) << "ends with the input";
}

TEST_F(I85runCpm, StatusAndVersion) {
    start();
    machine_.cpu.a = 0x55;
    call_bdos(11);
    EXPECT_EQ(machine_.cpu.a, 0) << "no key is waiting";
    call_bdos(12);
    EXPECT_EQ(machine_.cpu.hl(), 0x0022) << "CP/M 2.2";
    EXPECT_EQ(machine_.cpu.a, 0x22);
}

TEST_F(I85runCpm, UnsupportedFunctionsAreReportedOnceByNumber) {
    start();
    EXPECT_TRUE(call_bdos(15));
    EXPECT_EQ(machine_.cpu.a, 0xFF) << "open file: not found";
    EXPECT_TRUE(call_bdos(15));
    EXPECT_TRUE(call_bdos(25));
    EXPECT_EQ(machine_.cpu.a, 0x00) << "current disk: A";
    ASSERT_EQ(warnings_.size(), 2u);
    EXPECT_NE(warnings_[0].find("BDOS function 15"), std::string::npos);
    EXPECT_NE(warnings_[1].find("BDOS function 25"), std::string::npos);
}

}  // namespace
