// estimates_test.cpp - the bits fit their words and no two are the same.
#include "firmware/executive/estimates.hpp"

#include <gtest/gtest.h>

#include <initializer_list>

namespace {

using namespace rover;

unsigned united(std::initializer_list<unsigned> bits) {
    unsigned all = 0;
    for (const unsigned bit : bits) {
        EXPECT_EQ(bit & (bit - 1), 0u);
        EXPECT_EQ(all & bit, 0u);
        all |= bit;
    }
    return all;
}

TEST(Estimates, EveryBitIsItsOwnAndFitsItsField) {
    EXPECT_EQ(united({kAvailableOdometry, kAvailableAttitude, kAvailableLinkage, kAvailableSlip,
                      kAvailableLookAhead, kAvailableSinkage}),
              0x3Fu);
    EXPECT_EQ(united({kEventCycle, kEventSlipAlarm, kEventSinkageAlarm, kEventLostLock,
                      kEventTickGap, kEventSensorFault, kEventOverspeed}),
              0x7Fu);
    EXPECT_EQ(united({kFaultBogieLeft, kFaultBogieRight, kFaultDifferential, kFaultPitch,
                      kFaultRoll, kFaultTachometer, kFaultRangeStale, kFaultCalibration}),
              0xFFu);
}

TEST(Estimates, NothingIsAvailableBeforeTheFirstStep) {
    const Estimates estimates;
    EXPECT_EQ(estimates.available, 0);
    EXPECT_EQ(estimates.mode, SlipMode::odometry_only);
}

}  // namespace
