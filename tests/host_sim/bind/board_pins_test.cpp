// What is put on a board's pins and read from them, against the chips' own state and by hand.
#include "host_sim/bind/board_pins.hpp"

#include <gtest/gtest.h>

#include <stdexcept>

#include "tests/support/assemble.hpp"

namespace {

using host_sim::Board;
using host_sim::commands_of;
using host_sim::InputPins;

void load(Board& board, const char* source) {
    const auto code = test_support::assemble(source);
    board.program(code.bytes, code.origin);
}

TEST(BoardPins, AStepIsATenthOfASecond) {
    EXPECT_EQ(host_sim::kStepT, 307'200u);
}

// Counter 0 of timer A, mode 2, 30,720: OUT is low in the last clock of each period and rises at
// its end. The count's second byte is written at the end of the OUT: 7+10+7+10+7+10 = 51 T; it is
// loaded at the next clock, 52.
TEST(BoardPins, TheNextTickIsTheTimersNextRisingEdge) {
    Board board;
    load(board, "MVI A,34H\n OUT 13H\n MVI A,00H\n OUT 10H\n MVI A,78H\n OUT 10H\nSTAY: JMP STAY");
    board.run(1000);
    const uint64_t first = host_sim::next_tick_t(board);
    EXPECT_EQ(first, 52u + 30'720);
    board.run(first - 1);
    EXPECT_EQ(host_sim::next_tick_t(board), board.state.cpu.t < first ? first : first + 30'720);
    board.run(first + 20);
    EXPECT_EQ(host_sim::next_tick_t(board), first + 30'720);
}

// Duties of 255/100 of the percentage, rounded half up; wheel 1 backward (sign latch 3AH).
TEST(BoardPins, MotorsAndLasersAreCommands) {
    Board board;
    load(board, R"(
        MVI  A,255
        OUT  30H
        MVI  A,128
        OUT  31H
        MVI  A,3
        OUT  32H
        MVI  A,02H
        OUT  3AH
        MVI  A,82H
        OUT  23H
        MVI  A,0C5H
        OUT  22H
STAY:   JMP  STAY
)");
    board.run(1000);
    const hal::Commands commands = commands_of(board);
    EXPECT_EQ(commands.drive_percent[0], 100);
    EXPECT_EQ(commands.drive_percent[1], -50);
    EXPECT_EQ(commands.drive_percent[2], 1);
    EXPECT_EQ(commands.drive_percent[3], 0);
    EXPECT_EQ(commands.laser_bits, 5);
    EXPECT_EQ(commands.mast_brad, 1) << "on, to the left";
    EXPECT_EQ(commands.telemetry_size, 0);
}

TEST(BoardPins, ADutyOfNoWholePercentageIsRefused) {
    Board board;
    load(board, "MVI A,1\n OUT 34H\nSTAY: JMP STAY");
    board.run(100);
    try {
        (void)commands_of(board);
        FAIL() << "duty 1 is 0.39 %";
    } catch (const std::range_error& error) {
        EXPECT_STREQ(error.what(), "duty 1 of drive motor 4 stands for no whole percentage");
    }
}

TEST(BoardPins, LevelsReachTheChips) {
    Board board;
    load(board, "STAY: JMP STAY");
    host_sim::unplug_sensors(board);
    using Kind = host_sim::chips::AnalogInput::Source::Kind;
    EXPECT_EQ(board.state.analog.sources[3].kind, Kind::silent);
    hal::RawInputs inputs;
    for (uint16_t& channel : inputs.adc_q4_count) channel = hal::kAdcAbsent;
    inputs.adc_q4_count[3] = 1607;
    inputs.adc_q4_count[5] = 1234;  // a steering potentiometer
    InputPins pins;
    pins.set_levels(board, inputs);
    EXPECT_EQ(board.state.analog.sources[3].sum_q4, 1607);
    EXPECT_EQ(board.state.analog.sources[5].kind, Kind::silent);
    EXPECT_FALSE(board.state.range.connected);
    inputs.range_scan_count = 9;
    inputs.range_present = 0x03;
    inputs.range_q1_mm[1] = -20;
    pins.set_levels(board, inputs);
    EXPECT_TRUE(board.state.range.connected);
    EXPECT_EQ(board.state.range.scan_counter, 9);
    EXPECT_EQ(board.state.range.scan_q1_mm[1], -20);
}

TEST(BoardPins, WheelsTurnByTheDifferenceOfTheCounts) {
    Board board;
    load(board, "MVI A,34H\n OUT 17H\n XRA A\n OUT 14H\n OUT 14H\nSTAY: JMP STAY");
    board.run(1000);
    InputPins pins;
    hal::RawInputs inputs;
    inputs.tach_count[0] = 65'000;
    pins.set_counts(inputs);
    inputs.tach_count[0] = 465;  // 1001 more, across the wrap; the first pulse loads the count
    pins.turn_wheels(board, inputs);
    EXPECT_EQ(board.state.timers[1].counters[0].value, 65'536u - 1000);
    pins.set_counts(inputs);
    inputs.tach_count[0] = 365;
    pins.turn_wheels(board, inputs);
    EXPECT_EQ(board.state.timers[1].counters[0].value, 65'536u - 1100) << "it counts either way";
    EXPECT_EQ(board.state.ppis[0].port_level(host_sim::chips::I82c55a::Port::b) & 1, 0);
}

}  // namespace
