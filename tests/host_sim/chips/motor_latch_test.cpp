// motor_latch_test.cpp - the motor latches against docs/chips/motor-latch.md.
#include "host_sim/chips/motor_latch.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <array>
#include <string>
#include <vector>

namespace {

using host_sim::chips::kNever;
using host_sim::chips::MotorLatch;

constexpr uint16_t kDriveDirections = 10;
constexpr uint16_t kSteerDirections = 11;

TEST(MotorLatch, StartsWithAllMotorsOff) {
    const MotorLatch latch;
    for (unsigned motor = 0; motor < 10; ++motor) EXPECT_EQ(latch.duty(motor), 0);
    EXPECT_FALSE(latch.motors_off);
    EXPECT_EQ(latch.next_event_t(), kNever);
}

TEST(MotorLatch, EachAddressIsOneMotor) {
    for (unsigned motor = 0; motor < 10; ++motor) {
        MotorLatch latch;
        latch.write(static_cast<uint16_t>(motor), 200, 0);
        for (unsigned other = 0; other < 10; ++other) {
            EXPECT_EQ(latch.duty(other), other == motor ? 200 : 0);
        }
    }
}

TEST(MotorLatch, EachDirectionBitIsOneMotor) {
    for (unsigned motor = 0; motor < 10; ++motor) {
        MotorLatch latch;
        for (uint16_t i = 0; i < 10; ++i) latch.write(i, 255, 0);
        const bool drives = motor < 6;
        const unsigned bit = drives ? motor : motor - 6;
        latch.write(drives ? kDriveDirections : kSteerDirections, static_cast<uint8_t>(1u << bit),
                    0);
        for (unsigned other = 0; other < 10; ++other) {
            EXPECT_EQ(latch.duty(other), other == motor ? -255 : 255);
        }
        EXPECT_EQ(latch.reversal_count, 1u);
    }
}

TEST(MotorLatch, BitsWithoutAMotorAreNotKept) {
    MotorLatch latch;
    latch.write(kDriveDirections, 0xFF, 0);
    latch.write(kSteerDirections, 0xFF, 0);
    EXPECT_EQ(latch.drive_directions, 0x3F);
    EXPECT_EQ(latch.steer_directions, 0x0F);
    EXPECT_EQ(latch.reversal_count, 0u) << "no duty, no reversal under power";
}

TEST(MotorLatch, ReversingUnderPowerIsCounted) {
    MotorLatch latch;
    latch.write(2, 10, 0);
    latch.write(kDriveDirections, 0x07, 0);
    EXPECT_EQ(latch.reversal_count, 1u) << "only motor 2 had power";
    latch.write(2, 0, 0);
    latch.write(kDriveDirections, 0x00, 0);
    EXPECT_EQ(latch.reversal_count, 1u);
}

TEST(MotorLatch, ReadingYieldsAnOpenBus) {
    MotorLatch latch;
    latch.write(0, 0x12, 0);
    EXPECT_EQ(latch.read(0, 1), 0xFF);
    EXPECT_EQ(latch.read_count, 1u);
    EXPECT_EQ(latch.duty(0), 0x12);
}

TEST(MotorLatch, AddressesWithoutALatchAreCounted) {
    MotorLatch latch;
    for (uint16_t address = 12; address < 16; ++address) latch.write(address, 0xFF, 0);
    EXPECT_EQ(latch.unmapped_write_count, 4u);
    latch.unmapped_write_count = 0;
    EXPECT_EQ(latch, MotorLatch{});
    latch.write(0x73, 5, 0);
    EXPECT_EQ(latch.duty(3), 5) << "four address lines";
}

TEST(MotorLatch, ResetTurnsAllMotorsOff) {
    MotorLatch latch;
    for (uint16_t i = 0; i < 12; ++i) latch.write(i, 0xFF, 0);
    latch.reset();
    EXPECT_EQ(latch.duties, MotorLatch{}.duties);
    EXPECT_EQ(latch.drive_directions, 0);
    EXPECT_EQ(latch.steer_directions, 0);
}

TEST(MotorLatch, ClearLineHoldsAllMotorsOffUntilReleasedAndWrittenAgain) {
    MotorLatch latch;
    latch.write(0, 100, 0);
    latch.write(9, 100, 0);
    latch.set_motors_off(true);
    EXPECT_EQ(latch.duty(0), 0);
    EXPECT_EQ(latch.duty(9), 0);
    latch.write(0, 100, 1);
    EXPECT_EQ(latch.duty(0), 0);
    EXPECT_EQ(latch.cleared_write_count, 1u);
    latch.set_motors_off(false);
    EXPECT_EQ(latch.duty(0), 0) << "no memory of the time before";
    latch.write(0, 100, 2);
    EXPECT_EQ(latch.duty(0), 100);
}

TEST(MotorLatch, PropertiesShowEveryMotor) {
    MotorLatch latch;
    latch.write(6, 30, 0);
    latch.write(kSteerDirections, 1, 0);
    std::string all;
    for (const auto& [name, value] : latch.properties()) all += name + "=" + value + ";";
    EXPECT_NE(all.find("drive motor 5=0/255;"), std::string::npos) << all;
    EXPECT_NE(all.find("steering motor 0=-30/255;"), std::string::npos) << all;
    EXPECT_NE(all.find("clear line=inactive;"), std::string::npos) << all;
}

RC_GTEST_PROP(MotorLatch, OutputsDependOnTheLastWriteToEachAddressOnly, ()) {
    MotorLatch latch;
    std::array<uint8_t, 12> last{};
    const auto values = *rc::gen::container<std::vector<uint8_t>>(rc::gen::arbitrary<uint8_t>());
    for (const uint8_t value : values) {
        const auto address = *rc::gen::inRange<uint16_t>(0, 12);
        latch.write(address, value, 0);
        last[address] = value;
    }
    for (unsigned motor = 0; motor < 10; ++motor) {
        const bool reverse =
            motor < 6 ? (last[10] >> motor & 1) != 0 : (last[11] >> (motor - 6) & 1) != 0;
        RC_ASSERT(latch.duty(motor) == (reverse ? -last[motor] : last[motor]));
    }
}

}  // namespace
