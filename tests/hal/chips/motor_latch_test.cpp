// motor_latch_test.cpp - the driver of the motor latches: docs/chips/motor-latch.md.
#include "hal/chips/motor_latch.hpp"

#include <gtest/gtest.h>

#include <random>

#include "tests/hal/chips/parts.hpp"

namespace {

using hal_test::SimBoard;

// A type of its own for each test: the directions that the driver remembers are its own too.
template <class Bus, int kTest>
struct OwnBus : Bus {};
template <int kTest>
using Recorded = hal::MotorLatch<OwnBus<test_support::RecordingBus, kTest>, 0x30>;
template <int kTest>
using Simulated = hal::MotorLatch<OwnBus<host_sim::SimBus, kTest>, 0x30>;

constexpr uint8_t kDuty[6] = {1, 2, 3, 4, 5, 6};
constexpr uint8_t kSteerDuty[4] = {7, 8, 9, 10};

TEST(MotorLatchDriver, SameDirectionIsSixDuties) {
    hal_test::Script bus;
    Recorded<1>::drive(kDuty, 0);
    EXPECT_EQ(bus.accesses(), "30=01 31=02 32=03 33=04 34=05 35=06");
}

TEST(MotorLatchDriver, NewDirectionComesBetweenZeroAndDuty) {
    hal_test::Script bus;
    Recorded<2>::drive(kDuty, 0x21);
    EXPECT_EQ(bus.accesses(),
              "30=00 31=00 32=00 33=00 34=00 35=00 3A=21 30=01 31=02 32=03 33=04 34=05 35=06");
    Recorded<2>::drive(kDuty, 0x21);
    EXPECT_EQ(bus.accesses(), "30=01 31=02 32=03 33=04 34=05 35=06");
}

TEST(MotorLatchDriver, SteeringIsFourDutiesThenDirections) {
    hal_test::Script bus;
    Recorded<3>::steer(kSteerDuty, 0);
    EXPECT_EQ(bus.accesses(), "36=07 37=08 38=09 39=0A 3B=00");
    Recorded<3>::steer(kSteerDuty, 0x0A);
    EXPECT_EQ(bus.accesses(), "36=07 37=08 38=09 39=0A 3B=0A");
}

TEST(MotorLatchDriver, AllOffIsTheStateAfterReset) {
    hal_test::Script bus;
    Recorded<4>::drive(kDuty, 0x3F);
    Recorded<4>::steer(kSteerDuty, 0x0F);
    (void)bus.accesses();
    Recorded<4>::all_off();
    EXPECT_EQ(bus.accesses(),
              "30=00 31=00 32=00 33=00 34=00 35=00 36=00 37=00 38=00 39=00 3A=00 3B=00");
    Recorded<4>::drive(kDuty, 0);
    EXPECT_EQ(bus.accesses(), "30=01 31=02 32=03 33=04 34=05 35=06");
}

// Any commands one behind the other: the motors do what was said last, and no bridge reverses
// under power.
TEST(MotorLatchDriver, NeverReversesUnderPower) {
    constexpr unsigned kSeed = 30;
    std::mt19937 random(kSeed);
    const auto byte = [&random] { return static_cast<uint8_t>(random()); };
    SimBoard board;
    using Motors = Simulated<5>;
    uint8_t right = 0;
    for (unsigned i = 0; i < 2000; ++i) {
        const uint8_t duty[6] = {byte(), byte(), byte(), byte(), byte(), byte()};
        const uint8_t backward = byte() & 0x3F;
        Motors::drive(duty, backward);
        uint8_t steer[4] = {byte(), byte(), byte(), byte()};
        const uint8_t before = right;
        right = byte() & 0x0F;
        for (unsigned motor = 0; motor < 4; ++motor) {
            if (((before ^ right) >> motor & 1) != 0) steer[motor] = 0;  // as steer() demands
        }
        Motors::steer(steer, right);
        for (unsigned motor = 0; motor < 6; ++motor) {
            const int sign = (backward >> motor & 1) != 0 ? -1 : 1;
            ASSERT_EQ(board.state.motors.duty(motor), sign * duty[motor]) << "seed " << kSeed;
        }
        for (unsigned motor = 0; motor < 4; ++motor) {
            const int sign = (right >> motor & 1) != 0 ? -1 : 1;
            ASSERT_EQ(board.state.motors.duty(6 + motor), sign * steer[motor]);
        }
        if (i % 100 == 0) {
            Motors::all_off();
            right = 0;
        }
    }
    EXPECT_EQ(board.state.watchdog.fired_count, 0U);
    EXPECT_EQ(board.state.motors.reversal_count, 0U);
    EXPECT_EQ(board.state.motors.unmapped_write_count, 0U);
    EXPECT_EQ(board.state.violation_count, 0U);
}

}  // namespace
