// stimulus_commands_test.cpp - the outside world by hand, seen in the board's state.
#include "tests/support/trap_gate.hpp"
#include "tests/tools/debug/bench.hpp"
#include "tools/debug/commands.hpp"

namespace debug_console {
namespace {

using debug_test::Bench;
using testing::HasSubstr;
using testing::MatchesRegex;
using testing::StartsWith;

TEST(StimulusCommands, SerialOutputIsShownAsItLeaves) {
    Bench bench;
    EXPECT_THAT(bench("until 20ms"), MatchesRegex("serial T [0-9]+: \"OK\\\\n\"\nT (.|\n)*"));
    Bench hex;
    hex("serial hex");
    EXPECT_THAT(hex("until 20ms"), MatchesRegex("serial T [0-9]+: 4F 4B 0A\nT (.|\n)*"));
    Bench silent;
    silent("serial off");
    EXPECT_THAT(silent("until 20ms"), StartsWith("T "));
    EXPECT_EQ(silent("serial morse"), "refused: text, hex or off is missing");
}

// One character takes ten bits of 160 T; two sent together arrive one behind the other.
TEST(StimulusCommands, SendReachesTheReceiver) {
    Bench bench;
    bench("until 10000");
    bench("send \"A\" 42H");
    const auto& usart = bench.session.board.state.usart;
    bench("until +1500");
    EXPECT_FALSE(usart.rx_ready);
    bench("until +200");
    EXPECT_TRUE(usart.rx_ready);
    EXPECT_EQ(usart.rx_data, 'A');
    EXPECT_EQ(usart.overrun_count, 0u);
    bench("until +1600");
    EXPECT_EQ(usart.overrun_count, 1u) << "the program does not read";
    EXPECT_EQ(usart.rx_data, 'B');
    EXPECT_EQ(bench("send"), "refused: BYTE or \"TEXT\" is missing");
    EXPECT_THAT(bench("send 300"), StartsWith("refused: "));
}

TEST(StimulusCommands, SensorsTakeVoltsOrCounts) {
    Bench bench;
    bench("sensor pitch counts 2048");
    bench("sensor 12 uv -1500000");
    const auto& inputs = bench.session.board.state.analog.mux.inputs_uv;
    EXPECT_EQ(inputs[3], 0) << "code 2048 of 4096 is the middle of -5 V to 5 V";
    EXPECT_EQ(inputs[12], -1'500'000);
    bench("sensor gyro counts 0");
    EXPECT_EQ(inputs[9], -5'000'000);
    EXPECT_THAT(bench("sensor"), HasSubstr("12 battery            -1500000 uV\n"));
    EXPECT_EQ(bench("sensor 3"), "refused: uv VALUE or counts VALUE is missing");
    EXPECT_THAT(bench("sensor 16 uv 0"), StartsWith("refused: "));
    EXPECT_THAT(bench("sensor pitch counts 4096"), StartsWith("refused: "));
}

TEST(StimulusCommands, TachPulsesAreClocksOfTheirCounter) {
    Bench bench;
    // Counter 1 of timer B: mode 0 from a count of 100. The first pulse loads it.
    auto& timer = bench.session.board.state.timers[1];
    timer.write(3, 0x70, 0);
    timer.write(1, 100, 0);
    timer.write(1, 0, 0);
    bench("step");
    bench("tach 1 5 100");
    bench("until +370");
    EXPECT_EQ(timer.counters[1].value, 97u) << "loaded, and three of them";
    bench("until +60");
    EXPECT_EQ(timer.counters[1].value, 96u);
    bench("tach 5 backward");
    EXPECT_EQ(bench.session.board.state.ppis[0].outside[1] & 0x20, 0);
    bench("tach 5 forward");
    EXPECT_EQ(bench.session.board.state.ppis[0].outside[1] & 0x20, 0x20);
    bench("tach 2 out");
    EXPECT_EQ(bench.session.board.state.presence.lines, 0xFB);
    bench("tach 2 in");
    EXPECT_EQ(bench.session.board.state.presence.lines, 0xFF);
    EXPECT_THAT(bench("tach 6"), StartsWith("refused: "));
}

TEST(StimulusCommands, LinesAreSetAtOnceOrLater) {
    Bench bench;
    const host_sim::BoardState& state = bench.session.board.state;
    bench("trap undervoltage on");
    EXPECT_TRUE(state.undervoltage);
    bench("trap undervoltage off");
    EXPECT_FALSE(state.undervoltage);
    test_support::open_trap_gate(bench.session.board.state);
    bench("trap bumper on");
    EXPECT_TRUE(state.cpu.pin(host_sim::Pin::trap).level);
    bench("service on");
    EXPECT_TRUE(state.cpu.pin(host_sim::Pin::sid).level);
    bench("detectors 101B");
    EXPECT_EQ(state.ppis[1].outside[1], 0x05);
    bench("scan 10 -12 none 40");
    EXPECT_EQ(state.range.scan_present, 0x0B);
    EXPECT_EQ(state.range.scan_q1_mm[1], -12);
    EXPECT_EQ(bench("trap fire on"), "refused: undervoltage or bumper is missing");
    EXPECT_EQ(bench("service maybe"), "refused: on or off is missing");
    EXPECT_EQ(bench("scan"), "refused: HEIGHT is missing");
    EXPECT_EQ(bench("scan 1 2 3 4 5 6 7 8 9"), "refused: a scan has at most 8 samples");
}

TEST(StimulusCommands, AtSchedules) {
    Bench bench;
    test_support::open_trap_gate(bench.session.board.state);
    bench("at 100 trap bumper on");
    EXPECT_FALSE(bench.session.board.state.bumper);
    ASSERT_EQ(bench.session.board.state.stimuli.size(), 1u);
    EXPECT_EQ(bench.session.board.state.stimuli[0].t, 100u);
    bench("break interrupt trap");
    EXPECT_THAT(bench("c"), StartsWith("breakpoint 1: TRAP taken instead of 0117H main+23\n"));
    EXPECT_EQ(bench.t(), 105u + 12) << "OUT 11H ends at 105";
    EXPECT_EQ(bench("at +5 step"), "refused: step cannot be scheduled; `help at` lists what can");
    EXPECT_THAT(bench("at +5 service"), StartsWith("refused: "));
    EXPECT_FALSE(bench.console.stimulus_t.has_value()) << "over with the command";
    bench("delete all");
    bench("at +1000 reset");
    const uint64_t resets = bench.session.board.state.reset_count;
    bench("until +2000");
    EXPECT_EQ(bench.session.board.state.reset_count, resets + 1);
}

// The button's pulse lasts 16 T in the model; RAM is battery-backed.
TEST(StimulusCommands, ResetAndPowerBeginAnew) {
    Bench bench;
    bench("step 3");
    bench("poke 8000H 42H");
    EXPECT_THAT(bench("reset"), StartsWith("T 61467 (20.009 ms), +61440\n"));
    EXPECT_EQ(bench.pc(), 0);
    EXPECT_EQ(bench("print A"), "52 = 34H\n") << "RESET leaves the registers";
    bench("step 3");
    EXPECT_THAT(bench("power"), StartsWith("T 61494 (20.018 ms), +0\n"));
    EXPECT_EQ(bench("print A"), "0 = 00H\n");
    EXPECT_EQ(bench("print [8000H]"), "66 = 42H\n");
}

}  // namespace
}  // namespace debug_console
