// The board's VCD: exact times of pins and ports, named variables, a complete file.
#include "host_sim/board/board_vcd.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "tests/host_sim/board/board_program.hpp"

namespace {

using host_sim::Board;
using host_sim::BoardVcd;
using host_sim::StepRecord;

using Changes = std::vector<std::pair<uint64_t, std::string>>;  // ns, value as in the file

/// A reader of its own: scopes, names and changes by "scope.name".
std::map<std::string, Changes> read_vcd(const std::filesystem::path& path) {
    std::ifstream file(path);
    std::map<std::string, std::string> names;
    std::map<std::string, Changes> changes;
    std::vector<std::string> scopes;
    uint64_t ns = 0;
    for (std::string line; std::getline(file, line);) {
        std::istringstream words(line);
        std::string word;
        words >> word;
        if (word == "$scope") {
            std::string kind;
            words >> kind >> word;
            scopes.push_back(word);
        } else if (word == "$upscope") {
            scopes.pop_back();
        } else if (word == "$var") {
            std::string kind;
            std::string width;
            std::string id;
            std::string name;
            words >> kind >> width >> id >> name;
            std::string full;
            for (const std::string& scope : scopes) full += scope + ".";
            names[id] = full + name;
        } else if (word.starts_with('#')) {
            ns = std::stoull(word.substr(1));
        } else if (word.starts_with('b')) {
            std::string id;
            words >> id;
            changes[names[id]].emplace_back(ns, word.substr(1));
        } else if (word.starts_with('0') || word.starts_with('1') || word.starts_with('x')) {
            changes[names[word.substr(1)]].emplace_back(ns, word.substr(0, 1));
        }
    }
    return changes;
}

/// Beginning of a T-state in ns: 1 / 3.072 MHz is 15625 / 48 ns.
uint64_t ns(uint64_t t) {
    return (t * 15625 + 24) / 48;
}

class BoardVcdTest : public testing::Test {
protected:
    std::filesystem::path path =
        std::filesystem::temp_directory_path() /
        (std::string("board_vcd_") + testing::UnitTest::GetInstance()->current_test_info()->name() +
         ".vcd");

    void TearDown() override { std::filesystem::remove(path); }

    std::map<std::string, Changes> record(const char* source, uint64_t until_t,
                                          const std::vector<host_sim::VcdVariable>& variables) {
        Board board;
        board_test::program(board, board_test::assemble_program(source));
        BoardVcd vcd(path, board.state, variables);
        StepRecord step;
        while (board.state.cpu.t < until_t) {
            board.step(step, until_t);
            vcd.observe(step, board.state);
        }
        vcd.close();
        return read_vcd(path);
    }
};

TEST_F(BoardVcdTest, TimerPulsesKeepTheirOwnTimes) {
    // As in board_interrupt_test: 1000 clocks in mode 2, written complete at 71 T. OUT is high from
    // the control word (end of its OUT at 37 T), low for one clock at 71 + 1000 k, high again.
    const auto changes = record(R"(
        JMP  START
        ORG  100H
START:  LXI  SP,TOP
        MVI  A,34H
        OUT  TIMERC
        MVI  A,0E8H
        OUT  TIMER0
        MVI  A,03H
        OUT  TIMER0
LOOP:   JMP  LOOP
)",
                                3300, {});
    const Changes expected = {{0, "0"},        {ns(37), "1"},   {ns(1071), "0"}, {ns(1072), "1"},
                              {ns(2071), "0"}, {ns(2072), "1"}, {ns(3071), "0"}, {ns(3072), "1"}};
    EXPECT_EQ(changes.at("cpu.pins.rst75"), expected);
}

TEST_F(BoardVcdTest, PortWritesAndVariablesAreSignals) {
    // MVI 7, OUT 10 (its last cycle 14 to 17 T), STA 13, HLT 5.
    const auto changes =
        record("MVI A,55H\n OUT MOTOR+2\n STA 8123H\n HLT", 100, {{"speed", 0x8122, 2}});
    const Changes strobe = {{0, "0"}, {ns(14), "1"}, {ns(17), "0"}};
    EXPECT_EQ(changes.at("ports.write"), strobe);
    EXPECT_EQ(changes.at("ports.address").back(), std::pair(ns(14), std::string("110010")));
    EXPECT_EQ(changes.at("motors.duty2").back(), std::pair(ns(17), std::string("1010101")));
    EXPECT_EQ(changes.at("program.speed").back(),
              std::pair(ns(30), std::string("101010100000000")));
    EXPECT_EQ(changes.at("cpu.halted").back(), std::pair(ns(35), std::string("1")));
}

TEST_F(BoardVcdTest, VariablesHaveOneToFourBytes) {
    Board board;
    EXPECT_THROW(BoardVcd(path, board.state, {{"long", 0x8000, 5}}), std::invalid_argument);
}

}  // namespace
