// servos_test.cpp - the image holds steering motors and mast: settles, stops with every fault, and
// leaves lasers and acquisition alone. Nobody commands angles yet: they are put into memory.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <random>

#include "hal/io.hpp"
#include "tests/system/image/image_bench.hpp"

namespace {

namespace rb85 = hal::rb85;
using host_sim::Stimulus;
using image_test::ImageBench;
using image_test::kStepT;
using PortC = host_sim::chips::I82c55a::Port;

constexpr std::size_t kServoCount = 5;  // four steering motors, the mast
constexpr std::array<std::uint8_t, kServoCount> kChannels = {5, 6, 7, 8, 10};
constexpr double kRestDegrees = 2 * 90.0 / 256;
constexpr std::uint64_t kTickT = rb85::kTickCount;

class ServoBench : public ImageBench {
public:
    [[nodiscard]] unsigned port_c() const {
        const auto& part = board.state.ppis[0];
        return part.port_output(PortC::c) & part.port_output_mask(PortC::c);
    }
    [[nodiscard]] int duty(std::size_t servo) const {
        if (servo < 4) return board.state.motors.duty(static_cast<unsigned>(6 + servo));
        if ((port_c() & rb85::kMastOnBit) == 0) return 0;
        return (port_c() & rb85::kMastLeftBit) != 0 ? 255 : -255;
    }
    [[nodiscard]] bool all_run() const {
        for (std::size_t i = 0; i < kServoCount; ++i) {
            if (duty(i) == 0) return false;
        }
        return true;
    }
    [[nodiscard]] bool all_off() const {
        for (std::size_t i = 0; i < kServoCount; ++i) {
            if (duty(i) != 0) return false;
        }
        return true;
    }
    void command(std::size_t servo, double degrees) {
        const std::size_t place = servo < 4 ? offsetof(hal::Commands, steer_brad) + 2 * servo
                                            : offsetof(hal::Commands, mast_brad);
        const auto angle_brad = static_cast<unsigned>(std::lround(degrees * 65536 / 360)) & 0xFFFF;
        auto* at = &board.state.memory.bytes[address("commands") + place];
        at[0] = static_cast<std::uint8_t>(angle_brad & 0xFF);
        at[1] = static_cast<std::uint8_t>(angle_brad >> 8);
    }
    void command_all(double degrees) {
        for (std::size_t i = 0; i < kServoCount; ++i) command(i, degrees);
    }
    void potentiometer(std::size_t servo, double degrees) {
        board.schedule({.t = now(),
                        .kind = Stimulus::Kind::sensor,
                        .index = kChannels[servo],
                        .value = static_cast<std::int32_t>(std::lround(degrees / 45 * 5e6))});
    }
    /// To a board whose servos turn to the left without ever getting there.
    bool run_until_all_run() {
        if (!run_to_step(2)) return false;
        command_all(30);
        run(2 * kStepT);
        return all_run();
    }
    void expect_no_misuse() const {
        const auto& s = board.state;
        EXPECT_EQ(s.violation_count, 0u);
        EXPECT_EQ(s.analog.unsettled_count, 0u);
        EXPECT_EQ(s.analog.amplifier.early_hold_count, 0u);
        EXPECT_EQ(s.analog.adc.busy_start_count, 0u);
        EXPECT_EQ(s.analog.adc.busy_read_count, 0u);
        EXPECT_EQ(s.motors.reversal_count, 0u);
        EXPECT_EQ(fault_register() & rover::kFaultConverter, 0);
    }
};

TEST(ImageServos, ComeToRestWhereTheyAreWanted) {
    const unsigned seed = 5;
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> unit(0, 1);
    ServoBench bench;
    ASSERT_TRUE(bench.run_to_step(2));
    double slowest_s = 0;
    for (int round = 0; round < 6; ++round) {
        std::array<double, kServoCount> wanted{};
        std::array<double, kServoCount> degrees{};
        std::array<double, kServoCount> full_speed{};
        std::array<bool, kServoCount> turned_round{};
        std::array<int, kServoCount> last{};
        for (std::size_t i = 0; i < kServoCount; ++i) {
            wanted[i] = -39 + 78 * unit(random);
            degrees[i] = -43 + 86 * unit(random);
            full_speed[i] = i < 4 ? 20 + 25 * unit(random) : 6;
            bench.command(i, wanted[i]);
            bench.potentiometer(i, degrees[i]);
        }
        bench.run(kStepT);
        double moved_s = 0;
        for (int millisecond = 0; millisecond < 20'000; ++millisecond) {
            bench.run(kTickT / 10);
            for (std::size_t i = 0; i < kServoCount; ++i) {
                const int now = bench.duty(i);
                degrees[i] += full_speed[i] * now / 255 / 1000;
                bench.potentiometer(i, degrees[i]);
                if (now * last[i] < 0) turned_round[i] = true;
                if (now == 0) continue;
                last[i] = now;
                moved_s = millisecond / 1000.0;
            }
        }
        for (std::size_t i = 0; i < kServoCount; ++i) {
            EXPECT_NEAR(degrees[i], wanted[i], kRestDegrees) << round << ' ' << i;
            EXPECT_FALSE(turned_round[i]) << round << ' ' << i;
        }
        EXPECT_LT(moved_s, 17.0) << round;
        slowest_s = std::max(slowest_s, moved_s);
    }
    std::printf("all at rest after %.1f s at most\n", slowest_s);
    bench.expect_no_misuse();
}

TEST(ImageServos, WithoutPotentiometersOrConverterTheyStayOff) {
    ServoBench bench;
    ASSERT_TRUE(bench.run_until_all_run());
    for (const std::uint8_t channel : kChannels) bench.board.replay_sensor(channel, 0xFFFF);
    bench.run(kStepT);
    for (int i = 0; i < 100; ++i) {
        bench.run(kStepT / 50 + 7);
        ASSERT_TRUE(bench.all_off());
    }
    for (std::size_t i = 0; i < kServoCount; ++i) bench.potentiometer(i, 0);
    bench.run(2 * kStepT);
    EXPECT_TRUE(bench.all_run());
    bench.expect_no_misuse();
    bench.board.state.analog.adc.conversion12_t = 1'000'000'000;
    bench.run(kStepT);
    EXPECT_TRUE(bench.all_off());
}

// A tick at any moment of the acquisition, which it only meets when a step is late.
TEST(ImageServos, ATickInTheMiddleOfTheAcquisitionSpoilsNothing) {
    ServoBench start;
    for (std::uint8_t channel = 0; channel < 5; ++channel) {
        start.sensor(channel, static_cast<std::uint16_t>(1000 + 300 * channel));
    }
    ASSERT_TRUE(start.run_until_all_run());
    ASSERT_TRUE(start.run_to("rover_acquire"));
    const auto snapshot = start.board.state;
    const auto inputs = start.address("inputs") + offsetof(hal::RawInputs, adc_q4_count);
    for (std::uint64_t t = 0; t < 19'000; t += 23) {
        ServoBench bench;
        bench.board.state = snapshot;
        bench.run(t);
        bench.board.state.cpu.rst75_latch = true;
        bench.board.state.cpu.rst75_latched_t = bench.now();
        ASSERT_TRUE(bench.run_to("rover_control")) << t;
        for (unsigned channel = 0; channel < 5; ++channel) {
            ASSERT_EQ(bench.word(static_cast<std::uint16_t>(inputs + 2 * channel)),
                      16 * (1000 + 300 * channel))
                << t;
        }
        bench.run(4 * kTickT);
        bench.expect_no_misuse();
        ASSERT_FALSE(HasFailure()) << t;
    }
}

TEST(ImageServos, ATrapAtAnyInstructionOfTheTickLeavesThemOff) {
    for (const unsigned tick : {1U, 2U, 3U, 4U, 5U, 6U}) {  // the lost conversion, then each servo
        ServoBench start;
        ASSERT_TRUE(start.run_until_all_run());
        ASSERT_TRUE(start.run_to("rover_control"));
        for (unsigned i = 0; i < tick; ++i) {
            start.run(100);
            ASSERT_TRUE(start.run_to("on_tick"));
        }
        const auto snapshot = start.board.state;
        for (std::uint64_t t = 1; t < 900; t += 3) {
            ServoBench bench;
            bench.board.state = snapshot;
            const std::uint64_t at = snapshot.cpu.t + t;
            bench.board.schedule({.t = at, .kind = Stimulus::Kind::bumper, .value = 1});
            bench.board.schedule({.t = at + 50, .kind = Stimulus::Kind::bumper, .value = 0});
            bench.run(t + 3000);  // what the tick was about to do, and its look at the faults
            for (int i = 0; i < 8; ++i) {
                ASSERT_TRUE(bench.all_off()) << tick << ' ' << t;
                bench.run(kTickT / 2);
            }
        }
    }
}

TEST(ImageServos, StayOffWithEveryFaultThatStops) {
    ServoBench stack;
    ASSERT_TRUE(stack.run_until_all_run());
    stack.board.state.memory.bytes[0xFDFF] ^= 0x01;
    stack.run(kStepT + kTickT);
    for (int i = 0; i < 100; ++i) {
        ASSERT_TRUE(stack.all_off());
        stack.run(kStepT / 50 + 3);
    }
    const std::size_t place = image_test::program().identity + 12U;
    ServoBench rom;
    const auto bad = static_cast<std::uint8_t>(image_test::program().rom[place] ^ 1U);
    rom.board.program(std::array{bad}, static_cast<std::uint16_t>(place));
    ASSERT_TRUE(rom.run_to_step(2));
    EXPECT_NE(rom.fault_register() & rover::kFaultRom, 0);
    rom.command_all(30);
    for (int i = 0; i < 200; ++i) {
        rom.run(kStepT / 50 + 3);
        ASSERT_TRUE(rom.all_off());
    }
}

TEST(ImageServos, AreOffFromTheRestartToTheFirstStepBehindIt) {
    for (const bool button : {true, false}) {
        ServoBench bench;
        ASSERT_TRUE(bench.run_until_all_run());
        const std::uint64_t resets = bench.board.state.reset_count;
        if (button) {
            bench.reset();
        } else {
            ASSERT_TRUE(bench.ask(0x04, {0}, 0x82));
            bench.run(kStepT);
        }
        unsigned looks = 0;
        while (bench.board.state.reset_count == resets || bench.steps() != 1) {
            ASSERT_TRUE(bench.all_off()) << button;
            bench.run(1000);
            ++looks;
        }
        EXPECT_GT(looks, 100u);
        // Straight ahead is where they are.
        bench.run(3 * kStepT);
        EXPECT_TRUE(bench.all_off());
    }
}

TEST(ImageServos, MastAndLasersLeaveEachOtherAlone) {
    ServoBench bench;
    ASSERT_TRUE(bench.run_until_all_run());
    const auto lasers = bench.address("commands") + offsetof(hal::Commands, laser_bits);
    for (const unsigned bits : {0x0FU, 0x05U, 0x00U}) {
        bench.board.state.memory.bytes[lasers] = static_cast<std::uint8_t>(bits);
        bench.run(2 * kStepT);
        host_sim::StepRecord record;
        std::uint64_t off_since = 0;
        const std::uint64_t end = bench.now() + 2 * kStepT;
        while (bench.now() < end) {
            bench.board.step(record, end);
            ASSERT_EQ(bench.port_c() & 0x3F, bits);
            // The mast's turn takes the power off for some instructions.
            if (bench.duty(4) != 0) off_since = bench.now();
            ASSERT_LT(bench.now() - off_since, 300u) << bits;
        }
    }
}

}  // namespace
