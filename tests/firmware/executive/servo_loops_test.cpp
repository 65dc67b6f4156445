// servo_loops_test.cpp - codes and duties of all values; motors with friction and inertia, on the
// models of the board's parts, come to rest where they are wanted.
#include "firmware/executive/servo_loops.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>
#include <string>

#include "hal/board/rb85_parts.hpp"
#include "host_sim/bind/sim_bus.hpp"
#include "tests/support/recording_bus.hpp"

namespace {

namespace rb85 = hal::rb85;
using host_sim::SimBoard;
using host_sim::Stimulus;
using Parts = hal::Rb85Parts<host_sim::SimBus>;
using PortC = host_sim::chips::I82c55a::Port;

constexpr double kDegreesPerCode = 90.0 / 256;
constexpr double kRestDegrees = 2 * kDegreesPerCode;  // a code may be any angle of its 0.35 degrees
constexpr std::array<uint8_t, 5> kChannels = {5, 6, 7, 8, 10};

// -- Values --------------------------------------------------------------------------------------

TEST(ServoCode, IsTheAngleAsAConversionSeesItWithinTheReach) {
    for (int angle_brad = -32768; angle_brad <= 32767; ++angle_brad) {
        const double degrees = angle_brad * 360.0 / 65536;
        const int code = rover::servo_code(static_cast<int16_t>(angle_brad));
        const int exact = static_cast<int>(std::floor(128 + degrees / kDegreesPerCode));
        ASSERT_EQ(code, std::min(std::max(exact, 128 - 112), 128 + 111)) << angle_brad;
    }
}

TEST(ServoDuty, IsOffNearEnoughAndWithoutPotentiometerElseGrowsWithTheError) {
    for (int measured = 0; measured < 256; ++measured) {
        for (int wanted = 16; wanted < 240; ++wanted) {
            const int off = std::abs(measured - wanted);
            const bool plugged_in = measured != 0 && measured != 255;
            const int expected = plugged_in && off > 1 ? 64 + off / 2 : 0;
            ASSERT_EQ(
                rover::servo_duty(static_cast<uint8_t>(measured), static_cast<uint8_t>(wanted)),
                expected)
                << measured << ' ' << wanted;
        }
    }
}

// -- What is written, and in which order ---------------------------------------------------------

/// Conversions as said, one a tick; what goes out.
class Writes {
public:
    std::string tick(uint8_t selected, uint8_t measured) {
        bus_.in(0x20, {selected});
        bus_.in(0x21, {0x00});
        bus_.in(0x28, {measured});
        rover::hold_servo<hal::Rb85Parts<test_support::RecordingBus>>(servos, commands);
        std::string all = bus_.accesses() + ' ';
        std::string out;
        for (std::size_t at = 0; at < all.size(); at = all.find(' ', at) + 1) {
            if (all[at] != '<') out += all.substr(at, all.find(' ', at) + 1 - at);
        }
        return out;
    }

    rover::ServoLoops servos{};
    hal::Commands commands;

private:
    test_support::RecordingBus::Script bus_;
};

TEST(HoldServo, GivesADutyAndStartsTheNextConversion) {
    Writes writes;
    EXPECT_EQ(writes.tick(5, 100), "36=4E 37=00 38=00 39=00 3B=00 20=06 28=00 ");  // 64 + 28/2
    EXPECT_EQ(writes.tick(6, 125), "36=4E 37=41 38=00 39=00 3B=00 20=07 28=00 ");
    EXPECT_EQ(writes.tick(8, 127), "36=4E 37=41 38=00 39=00 3B=00 20=0A 28=00 ");
    EXPECT_EQ(writes.tick(5, 129), "36=00 37=41 38=00 39=00 3B=01 20=06 28=00 ");
}

TEST(HoldServo, AMotorThatTurnsRoundHasNoPowerUntilItsNextTurn) {
    Writes writes;
    EXPECT_EQ(writes.tick(7, 200), "36=00 37=00 38=00 39=00 3B=04 20=08 28=00 ");
    EXPECT_EQ(writes.tick(7, 200), "36=00 37=00 38=64 39=00 3B=04 20=08 28=00 ");
    EXPECT_EQ(writes.tick(7, 54), "36=00 37=00 38=00 39=00 3B=00 20=08 28=00 ");
    EXPECT_EQ(writes.tick(7, 54), "36=00 37=00 38=65 39=00 3B=00 20=08 28=00 ");
}

// Bit set/reset of port C: 0C and 0D are bit 6, on; 0E and 0F bit 7, left.
TEST(HoldServo, TheMastHasNoPowerWhileItsDirectionChanges) {
    Writes writes;
    EXPECT_EQ(writes.tick(10, 100), "23=0C 23=0F 23=0D 20=05 28=00 ");
    EXPECT_EQ(writes.tick(10, 130), "23=0C 23=0E 23=0D 20=05 28=00 ");
    EXPECT_EQ(writes.tick(10, 127), "23=0C 20=05 28=00 ");
    writes.commands.mast_brad = -64 * 4;
    EXPECT_EQ(writes.tick(10, 127), "23=0C 23=0E 23=0D 20=05 28=00 ");
}

TEST(HoldServo, LeavesTheConverterToTheMainLineAndBeginsAnewBehindIt) {
    Writes writes;
    for (uint8_t channel = 0; channel < 5; ++channel) EXPECT_EQ(writes.tick(channel, 1), "");
    EXPECT_EQ(writes.tick(14, 1), "20=05 28=00 ");
}

// -- Motors on the board's parts -----------------------------------------------------------------

struct Motor {
    double degrees = 0;
    double full_speed = 30;   ///< degrees a second at full duty
    double friction = 0;      ///< duty of 255 that does not move it
    double inertia_s = 0.02;  ///< time constant of its speed
    double speed = 0;

    void move(int duty, double seconds) {
        const double power = std::max(0.0, std::abs(duty) - friction) / (255 - friction);
        const double goal = duty < 0 ? -power * full_speed : power * full_speed;
        speed += (goal - speed) * std::min(1.0, seconds / inertia_s);
        degrees = std::min(44.9, std::max(-44.9, degrees + speed * seconds));
    }
};

class ServosOnTheModel : public testing::Test {
protected:
    void SetUp() override {
        Parts::PpiA::set_mode<rb85::kPpiAMode>();
        Parts::AnalogInputs::claim();
        for (uint8_t channel = 0; channel < 5; ++channel) {
            set(channel, -30.0 + 15 * channel);
        }
        motors[4].full_speed = 6;  // the mast knows no duty
        for (std::size_t i = 0; i < 5; ++i) set(kChannels[i], motors[i].degrees);
    }
    void set(uint8_t channel, double degrees) {
        board.apply(Stimulus::Kind::sensor, channel,
                    static_cast<int32_t>(std::lround(degrees / 45 * 5'000'000)));
    }
    [[nodiscard]] int duty(std::size_t servo) const {
        if (servo < 4) return board.state.motors.duty(static_cast<unsigned>(6 + servo));
        const unsigned level = board.state.ppis[0].port_output(PortC::c);
        if ((level & rb85::kMastOnBit) == 0) return 0;
        return (level & rb85::kMastLeftBit) != 0 ? 255 : -255;
    }
    /// A tick, and behind every tenth the main line's conversions.
    void tick() {
        const uint64_t begin_t = board.state.cpu.t;
        rover::hold_servo<Parts>(servos, commands);
        if (ticks++ % 10 == 0) acquire();
        for (unsigned slice = 0; slice < 10; ++slice) {
            for (std::size_t i = 0; i < 5; ++i) {
                motors[i].move(duty(i), 0.001);
                if (plugged_in) set(kChannels[i], motors[i].degrees);
            }
        }
        board.elapse(begin_t + rb85::kTickCount - board.state.cpu.t);
    }
    void acquire() {
        Parts::AnalogInputs::claim();
        board.elapse(300);
        for (uint8_t channel = 0; channel < 5; ++channel) {
            uint16_t sum = 0;
            ASSERT_TRUE(Parts::AnalogInputs::sum_of_16(channel, sum));
            ASSERT_NEAR(sum, 32768 + 32768 * (-30.0 + 15 * channel) / 45, 16) << int{channel};
        }
        Parts::AnalogInputs::release();
        Parts::Watchdog::toggle();
    }
    void command(std::size_t servo, double degrees) {
        const auto angle_brad = static_cast<int16_t>(std::lround(degrees * 65536 / 360));
        (servo < 4 ? commands.steer_brad[servo] : commands.mast_brad) = angle_brad;
    }
    void run(unsigned how_many) {
        for (unsigned i = 0; i < how_many; ++i) tick();
    }
    void expect_no_misuse() const {
        EXPECT_EQ(board.state.analog.unsettled_count, 0U);
        EXPECT_EQ(board.state.analog.adc.busy_start_count, 0U);
        EXPECT_EQ(board.state.analog.adc.busy_read_count, 0U);
        EXPECT_EQ(board.state.analog.amplifier.early_hold_count, 0U);
        EXPECT_EQ(board.state.motors.reversal_count, 0U);
        EXPECT_EQ(board.state.violation_count, 0U);
        EXPECT_EQ(board.state.watchdog.fired_count, 0U);
    }

    SimBoard board;
    rover::ServoLoops servos{};
    hal::Commands commands;
    std::array<Motor, 5> motors;
    unsigned ticks = 0;
    bool plugged_in = true;
};

// Motors from slow to as fast as they may be, with friction of up to three quarters of the least
// duty, and inertia.
TEST_F(ServosOnTheModel, ComeToRestFromAnywhereWithoutOscillating) {
    const unsigned seed = 20;
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> unit(0, 1);
    for (unsigned round = 0; round < 40; ++round) {
        std::array<double, 5> wanted{};
        for (std::size_t i = 0; i < 5; ++i) {
            Motor& motor = motors[i];
            motor.degrees = -44 + 88 * unit(random);
            motor.speed = 0;
            motor.full_speed = i < 4 ? 10 + 40 * unit(random) : 2 + 6 * unit(random);
            motor.friction = 48 * unit(random);
            motor.inertia_s = 0.002 + 0.02 * unit(random);
            wanted[i] = -39 + 78 * unit(random);
            command(i, wanted[i]);
            set(kChannels[i], motor.degrees);
        }
        run(5);
        std::array<int, 5> turned_round{};
        std::array<int, 5> last{};
        for (unsigned i = 0; i < 5000; ++i) {
            tick();
            for (std::size_t servo = 0; servo < 5; ++servo) {
                const int now = duty(servo);
                if (now * last[servo] < 0) ++turned_round[servo];
                if (now != 0) last[servo] = now;
                if (i < 4000) continue;
                ASSERT_EQ(now, 0) << round << ' ' << servo;  // at rest for the last ten seconds
            }
        }
        for (std::size_t servo = 0; servo < 5; ++servo) {
            EXPECT_NEAR(motors[servo].degrees, wanted[servo], kRestDegrees)
                << round << ' ' << servo;
            EXPECT_EQ(turned_round[servo], 0) << round << ' ' << servo;
        }
    }
    expect_no_misuse();
}

TEST_F(ServosOnTheModel, AreBackWhenSomethingPushesThem) {
    command(1, 20);
    command(4, -10);
    run(2000);
    EXPECT_NEAR(motors[1].degrees, 20, kRestDegrees);
    motors[1].degrees = 24;
    motors[4].degrees = 0;
    run(1000);
    EXPECT_NEAR(motors[1].degrees, 20, kRestDegrees);
    EXPECT_NEAR(motors[4].degrees, -10, kRestDegrees);
    expect_no_misuse();
}

TEST_F(ServosOnTheModel, BeyondTheReachTheyStopAtItsEnd) {
    for (std::size_t i = 0; i < 5; ++i) command(i, i % 2 == 0 ? 90 : -90);
    run(2000);
    for (std::size_t i = 0; i < 5; ++i) {
        const double end = 28 * 360.0 / 256;
        EXPECT_NEAR(motors[i].degrees, i % 2 == 0 ? end : -end, kRestDegrees) << i;
        EXPECT_EQ(duty(i), 0) << i;
    }
}

TEST_F(ServosOnTheModel, NoPotentiometerNoPower) {
    plugged_in = false;
    for (std::size_t i = 0; i < 5; ++i) command(i, 30);
    for (const double rail : {-45.0, 45.0}) {
        for (const uint8_t channel : kChannels) set(channel, 0);
        run(20);
        for (std::size_t i = 0; i < 5; ++i) EXPECT_NE(duty(i), 0) << i;
        for (const uint8_t channel : kChannels) set(channel, rail);
        run(11);
        for (unsigned i = 0; i < 30; ++i) {
            tick();
            for (std::size_t servo = 0; servo < 5; ++servo) ASSERT_EQ(duty(servo), 0) << servo;
        }
    }
    for (const uint8_t channel : kChannels) set(channel, 0);
    run(20);
    for (std::size_t i = 0; i < 5; ++i) EXPECT_NE(duty(i), 0) << i;
    for (const uint8_t channel : kChannels) {
        board.state.analog.set_silent(channel, board.state.cpu.t);
    }
    run(11);
    for (unsigned i = 0; i < 30; ++i) {
        tick();
        for (std::size_t servo = 0; servo < 5; ++servo) ASSERT_EQ(duty(servo), 0) << servo;
    }
    EXPECT_EQ(board.state.analog.adc.busy_read_count, 0U);
}

// Only the loops: the main line would find its channels absent.
TEST_F(ServosOnTheModel, NoEndOfTheConversionNoPower) {
    for (std::size_t i = 0; i < 5; ++i) command(i, 30);
    run(20);
    for (std::size_t i = 0; i < 5; ++i) EXPECT_NE(duty(i), 0) << i;
    board.state.analog.adc.conversion12_t = 1'000'000'000;
    ticks = 1;
    for (unsigned i = 0; i < 6; ++i) tick();
    for (std::size_t i = 0; i < 5; ++i) EXPECT_EQ(duty(i), 0) << i;
    EXPECT_EQ(board.state.analog.adc.busy_read_count, 0U);
}

TEST_F(ServosOnTheModel, TheOtherBitsOfPortCStay) {
    for (const uint8_t others : {uint8_t{0x00}, uint8_t{0x3F}, uint8_t{0x15}}) {
        Parts::PpiA::write_c(others);
        for (const double degrees : {30.0, -30.0}) {
            command(4, degrees);
            for (unsigned i = 0; i < 40; ++i) {
                tick();
                ASSERT_EQ(board.state.ppis[0].port_output(PortC::c) & 0x3F, others);
            }
            EXPECT_NE(duty(4), 0);
        }
    }
}

}  // namespace
