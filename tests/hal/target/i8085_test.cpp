// i8085_test.cpp - hal/target/i8085.hpp under all drivers: parts_program.cpp, compiled by i85cc, on
// the simulated board. Results, T-states, and no chip is misused: this is where times are real.
// Expected values: the stimuli; times of docs/chips. The real code is what is measured here, so
// bounds of T-states are those of the pages.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <map>
#include <optional>
#include <stdexcept>
#include <string>

#include "hal/board/rb85.hpp"
#include "host_sim/board/board.hpp"
#include "host_sim/cpu/step_record.hpp"
#include "toolchain/driver/driver.hpp"

// Compiled for the host it would need <i85.h>: hal/target/i8085.hpp is what parts_program.cpp uses.

namespace {

using host_sim::Board;
using host_sim::Stimulus;

const toolchain::assembly::Program& program() {
    static const toolchain::assembly::Program compiled = [] {
        const std::string root = ROVER_SOURCE_DIR;
        toolchain::driver::Request made;
        made.sources = {{.path = root + "/tests/hal/target/parts_program.cpp"}};
        made.front_end = {"-I" + root};
        made.keep = {"wish",  "argument", "duties",          "signs",         "result",
                     "sums",  "pulses",   "frame",           "servo",         "servo_result",
                     "ticks", "received", "received_status", "servo_results", "channels"};
        return toolchain::driver::compile_program(made).program;
    }();
    return compiled;
}

enum Wish : uint8_t {
    sums = 1,
    servo_turn,
    pulses,
    range,
    drive,
    off,
    wheels,
    serial,
    reset_usart
};

class PartsOnTheBoard : public testing::Test {
protected:
    void SetUp() override {
        const auto& image = program().image;
        for (std::size_t i = 0; i < 0x8000; ++i) {
            if (image.present[i]) board.program({&image.bytes[i], 1}, static_cast<uint16_t>(i));
        }
        run();  // boot
    }
    void TearDown() override {
        expect_no_misuse();
        for (const auto& [name, cost] : cost_t) fmt::print("{}: {} T\n", name, cost);
    }

    static uint16_t address(const std::string& name) {
        const auto* symbol = program().find(name);
        if (symbol == nullptr) throw std::runtime_error(name + " is not there");
        return symbol->value;
    }
    [[nodiscard]] uint16_t word(const std::string& name, unsigned index = 0) const {
        const auto* at = &board.state.memory.bytes[address(name) + 2U * index];
        return static_cast<uint16_t>(at[0] | at[1] << 8);
    }
    [[nodiscard]] uint8_t byte(const std::string& name, unsigned index = 0) const {
        return board.state.memory.bytes[address(name) + index];
    }
    void set(const std::string& name, uint8_t value, unsigned index = 0) {
        board.state.memory.bytes[address(name) + index] = value;
    }
    void sensor(uint8_t channel, uint16_t count) {
        board.schedule({board.state.cpu.t, Stimulus::Kind::sensor, channel,
                        host_sim::sensor_uv_of_count(count)});
    }
    void stimulate(Stimulus::Kind kind, uint8_t index, int32_t value) {
        board.schedule({board.state.cpu.t, kind, index, value});
    }

    /// Fulfils a wish: to the HLT behind it. Measures the functions named in `cost_t`, unless
    /// an interrupt comes in between.
    void run(std::optional<Wish> wish = std::nullopt) {
        if (wish) set("wish", *wish);
        std::map<uint16_t, std::string> entries;
        for (const auto& [name, cost] : cost_t) entries[address(name)] = name;
        std::string running;
        uint64_t since_t = 0;
        uint16_t stack = 0;
        bool disturbed = false;
        host_sim::StepRecord record;
        const uint64_t end_t = board.state.cpu.t + 3'072'000;
        bool left = !wish;
        while (board.state.cpu.t < end_t) {
            if (running.empty() && entries.contains(board.state.cpu.pc)) {
                running = entries[board.state.cpu.pc];
                since_t = board.state.cpu.t;
                stack = board.state.cpu.sp;
                disturbed = false;
            }
            board.step(record);
            disturbed = disturbed || record.kind != host_sim::StepRecord::Kind::instruction;
            if (!running.empty() && board.state.cpu.sp > stack) {
                const uint64_t took_t = board.state.cpu.t - since_t;
                if (!disturbed) cost_t[running] = std::max(cost_t[running], took_t);
                running.clear();
            }
            if (!board.state.cpu.halted) left = true;
            if (left && board.state.cpu.halted && byte("wish") == 0) return;
        }
        FAIL() << "no end";
    }

    void expect_no_misuse() const {
        const auto& s = board.state;
        EXPECT_EQ(s.violation_count, 0U);
        EXPECT_EQ(s.analog.unsettled_count, 0U);
        EXPECT_EQ(s.analog.amplifier.early_hold_count, 0U);
        EXPECT_EQ(s.analog.adc.busy_start_count, 0U);
        EXPECT_EQ(s.analog.adc.busy_read_count, 0U);
        EXPECT_EQ(s.analog.adc.moved_input_count, 0U);
        for (const auto& timer : s.timers) {
            EXPECT_EQ(timer.unprogrammed_access_count, 0U);
            EXPECT_EQ(timer.undefined_read_count, 0U);
            EXPECT_EQ(timer.live_read_count, 0U);
            EXPECT_EQ(timer.lost_latch_count, 0U);
            EXPECT_EQ(timer.illegal_count_count, 0U);
        }
        for (const auto& ppi : s.ppis) EXPECT_EQ(ppi.input_write_count, 0U);
        EXPECT_EQ(s.range.early_strobe_count, 0U);
        EXPECT_EQ(s.range.overread_count, 0U);
        EXPECT_EQ(s.motors.reversal_count, 0U);
        EXPECT_EQ(s.motors.read_count, 0U);
        EXPECT_EQ(s.motors.unmapped_write_count, 0U);
        EXPECT_EQ(s.usart.recovery_violation_count, 0U);
        EXPECT_EQ(s.usart.overwritten_count, 0U);
        EXPECT_EQ(s.usart.early_write_count, 0U);
        EXPECT_EQ(s.usart.invalid_mode_count, 0U);
        EXPECT_EQ(s.usart.lost_data_write_count, 0U);
    }

    Board board;
    std::map<std::string, uint64_t> cost_t;
};

// 16 conversions of 162 T, and select, settle and the sum itself.
TEST_F(PartsOnTheBoard, SumsAreExactAndFast) {
    for (uint8_t channel = 0; channel < 16; ++channel) {
        sensor(channel, static_cast<uint16_t>(channel * 273));
    }
    cost_t["sum_of_16"] = 0;
    const uint64_t conversions = board.state.analog.adc.conversion_count;
    run(sums);
    for (unsigned channel = 0; channel < 16; ++channel) {
        EXPECT_EQ(word("sums", channel), channel * 273 * 16) << channel;
    }
    EXPECT_EQ(board.state.analog.adc.conversion_count - conversions, 256U);
    EXPECT_LE(cost_t["sum_of_16"], 3000U);
}

// The tick wants to convert a channel of its own, ever elsewhere in the sums: its period changes
// from run to run.
TEST_F(PartsOnTheBoard, TheTickKeepsOutOfTheSumsAndHasItsOwn) {
    for (uint8_t channel = 0; channel < 16; ++channel) {
        sensor(channel, static_cast<uint16_t>(4095 - channel * 111));
    }
    set("channels", 8);
    run(sums);
    const uint16_t before = word("ticks");
    uint16_t results = word("servo_results");
    for (unsigned i = 0; i < 200; ++i) {
        const unsigned servo = 8 + i % 6;
        set("servo", static_cast<uint8_t>(servo));
        const unsigned period = 2000 + 37 * (i % 100);
        board.state.timers[0].write(0, static_cast<uint8_t>(period), board.state.cpu.t);
        board.state.timers[0].write(0, static_cast<uint8_t>(period >> 8), board.state.cpu.t);
        board.state.event_t = 0;
        run(sums);
        for (unsigned channel = 0; channel < 8; ++channel) {
            ASSERT_EQ(word("sums", channel), (4095 - channel * 111) * 16) << i << ": " << channel;
        }
        board.run(board.state.cpu.t + 13'000);  // two ticks and more
        ASSERT_EQ(byte("servo_result"), (4095 - servo * 111) / 16) << i;
        ASSERT_NE(word("servo_results"), results) << i;
        results = word("servo_results");
    }
    EXPECT_GT(word("ticks") - before, 1000);
}

TEST_F(PartsOnTheBoard, ADeadConverterIsAbsent) {
    auto& chain = board.state.analog;
    chain.adc.conversion12_t = 1'000'000'000;
    cost_t["sum_of_16"] = 0;
    run(sums);
    for (unsigned channel = 0; channel < 16; ++channel) {
        EXPECT_EQ(word("sums", channel), hal::kAdcAbsent);
    }
    // The bound is at least twice a conversion and not more than four times.
    EXPECT_GE(cost_t["sum_of_16"], 216U);
    EXPECT_LE(cost_t["sum_of_16"], 600U);
}

TEST_F(PartsOnTheBoard, AConversionFromTurnToTurn) {
    cost_t["servo_turn"] = 0;
    sensor(9, 3777);
    set("channels", 8);
    run(sums);
    set("servo", 9);
    run(servo_turn);
    run(servo_turn);
    EXPECT_EQ(byte("servo_result"), 3777 / 16);
    EXPECT_LE(cost_t["servo_turn"], 250U);
}

TEST_F(PartsOnTheBoard, PulsesOfSixWheels) {
    cost_t["read_pulses"] = 0;
    run(pulses);
    for (unsigned wheel = 0; wheel < 6; ++wheel) EXPECT_EQ(word("pulses", wheel), 0);
    for (uint8_t wheel = 0; wheel < 6; ++wheel) {
        for (unsigned i = 0; i < 1000U * wheel + 1; ++i) {
            stimulate(Stimulus::Kind::tach_pulse, wheel, 0);
        }
    }
    run(pulses);
    for (unsigned wheel = 0; wheel < 6; ++wheel) {
        EXPECT_EQ(word("pulses", wheel), 1000 * wheel + 1);
    }
    EXPECT_LE(cost_t["read_pulses"], 700U);
}

TEST_F(PartsOnTheBoard, RangeFrames) {
    cost_t["range_read"] = 0;
    board.set_range_scan(0xFF, {100, -100, 0x1234, -32768, 32767, 0, -1, 1});
    run(range);
    EXPECT_EQ(word("result"), 0);
    const uint8_t expected[18] = {0x01, 0xFF, 0x64, 0x00, 0x9C, 0xFF, 0x34, 0x12, 0x00,
                                  0x80, 0xFF, 0x7F, 0x00, 0x00, 0xFF, 0xFF, 0x01, 0x00};
    for (unsigned i = 0; i < 18; ++i) EXPECT_EQ(byte("frame", i), expected[i]) << i;
    EXPECT_LE(cost_t["range_read"], 3000U);
    cost_t["range_read"] = 0;
    board.state.range.set_connected(false, board.state.cpu.t);
    run(range);
    EXPECT_EQ(word("result"), 1);
    EXPECT_FALSE(board.state.range.select_line);
    EXPECT_GE(cost_t["range_read"], 307U);  // 100 us
    EXPECT_LE(cost_t["range_read"], 700U);
}

TEST_F(PartsOnTheBoard, MotorsTurnAsTold) {
    for (const char* name : {"drive", "steer", "all_off"}) cost_t[name] = 0;
    for (unsigned i = 0; i < 6; ++i) set("duties", static_cast<uint8_t>(200 + i), i);
    for (const uint8_t signs : std::array<uint8_t, 5>{0x00, 0x05, 0x0A, 0x0F, 0x00}) {
        set("signs", signs);
        run(drive);
        for (unsigned motor = 0; motor < 10; ++motor) {
            const bool reverse =
                motor < 6 ? (signs >> motor & 1) != 0 : (signs >> (motor - 6) & 1) != 0;
            const int duty = 200 + static_cast<int>(motor < 6 ? motor : motor - 6);
            EXPECT_EQ(board.state.motors.duty(motor), reverse ? -duty : duty) << motor;
        }
    }
    EXPECT_LE(cost_t["drive"], 400U);
    run(off);
    for (unsigned motor = 0; motor < 10; ++motor) EXPECT_EQ(board.state.motors.duty(motor), 0);
}

TEST_F(PartsOnTheBoard, WatchdogIsToggledAndMasksStay) {
    const bool sod = board.state.cpu.sod;
    for (const char* name : {"toggle", "wheels"}) cost_t[name] = 0;
    run(wheels);
    EXPECT_NE(board.state.cpu.sod, sod);
    run(wheels);
    EXPECT_EQ(board.state.cpu.sod, sod);
    EXPECT_EQ(board.state.cpu.masks, 0x03);
    EXPECT_EQ(board.state.watchdog.fired_count, 0U);
}

TEST_F(PartsOnTheBoard, PresenceOfTachometers) {
    run(wheels);
    EXPECT_EQ(word("result") & 0xFF, 0x3F);
    stimulate(Stimulus::Kind::tach_connected, 4, 0);
    run(wheels);
    EXPECT_EQ(word("result") & 0xFF, 0x2F);
}

TEST_F(PartsOnTheBoard, UsartTalksAndTellsOfItsErrors) {
    stimulate(Stimulus::Kind::serial_byte, 0, 0x41);
    stimulate(Stimulus::Kind::serial_byte, 0, 0x42);
    board.run(board.state.cpu.t + 4000);
    set("argument", 0x99);
    run(serial);
    EXPECT_EQ(byte("received_status") & 0x3A, 0x12);  // RxRDY, and 41H is lost
    EXPECT_EQ(byte("received"), 0x42);
    board.run(board.state.cpu.t + 2000);
    const auto sent = board.take_transmitted();
    ASSERT_EQ(sent.size(), 1U);
    EXPECT_EQ(sent[0].byte, 0x99);
}

// What the code in between costs shows in the recovery time: 16 T are the most that the data sheet
// asks for, in synchronous mode, where mode 00 leaves the part for a moment.
TEST_F(PartsOnTheBoard, UsartIsResetFromAnyMode) {
    cost_t["usart_reset"] = 0;
    for (const uint8_t mode : std::array<uint8_t, 5>{0x00, 0x0C, 0x4E, 0xFF, 0x80}) {
        auto& usart = board.state.usart;
        usart.reset();
        usart.write(1, mode, board.state.cpu.t += 100);
        board.state.cpu.t += 100;
        run(reset_usart);
        EXPECT_EQ(usart.clock_factor, 16) << int{mode};
        EXPECT_EQ(usart.command, 0x37) << int{mode};
        EXPECT_EQ(usart.mode, 0x4E) << int{mode};
    }
}

}  // namespace
