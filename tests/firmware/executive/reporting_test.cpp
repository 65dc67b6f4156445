// reporting_test.cpp - units, the position between cycles, availability, alarms and commands.
#include "firmware/executive/reporting.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace {

using namespace rover;
using namespace rover::executive;

TEST(TakePosition, IsTwentyFiveQuartersRoundedDownModulo32Bits) {
    for (const std::int64_t value :
         {0ll, 1ll, 2ll, 3ll, -1ll, -2ll, -3ll, -4ll, 153ll, 100'000'007ll, -340'000'001ll,
          2'147'483'647ll, -2'147'483'648ll}) {
        const std::int64_t exact = (value * 25 - ((value * 25 % 4) + 4) % 4) / 4;
        Controller controller;
        controller.map.travelled_q6_bin = static_cast<std::int32_t>(value);
        take_position(controller);
        EXPECT_EQ(controller.cycle_position_q4_mm,
                  static_cast<std::int32_t>(static_cast<std::uint32_t>(exact & 0xFFFFFFFF)))
            << value;
    }
}

TEST(AdvanceQ4Mm, IsTwentyFiveQuartersRoundedTowardsZero) {
    for (int advance = -5000; advance <= 5000; ++advance) {
        ASSERT_EQ(advance_q4_mm(static_cast<std::int16_t>(advance)), advance * 25 / 4) << advance;
    }
    EXPECT_EQ(q4_mm_from_q6_bin(10485), 65531);
}

// Rounded down, and up to one more or less for the share's own rounding.
TEST(LearnedAdvance, IsTheMeanOfSixCentimetresForwardAndAllOfItBackwards) {
    Controller controller;
    EXPECT_EQ(learned_advance(controller, 960), 960);
    for (const int mean : {1638, 4096, 8192, 9830}) {
        controller.map.mean_q12_bin = static_cast<std::int16_t>(mean);
        report_cycle(controller);
        for (int travel = 0; travel <= 32767; travel += 13) {
            const double exact = travel * (mean / 9830.0);
            const int found = learned_advance(controller, static_cast<std::int16_t>(travel));
            ASSERT_LE(found, exact + 1) << travel;
            ASSERT_GT(found, exact - 2) << travel;
        }
        EXPECT_EQ(learned_advance(controller, -960), -960);
    }
    EXPECT_EQ(learned_advance(controller, 32767), 32767) << "no slip is exact";
}

struct Report {
    Controller controller;
    Report() {
        controller.map.has_map = controller.map.measured = true;
        controller.map.sinkage_valid = true;
        controller.map.mode = SlipMode::tracking;
        controller.map.slip_alarm = controller.map.sinkage_alarm = true;
    }
    const Estimates& make(bool linkage) {
        controller.estimates.events = 0;
        controller.estimates.available = linkage ? kAvailableLinkage : 0;
        rover::executive::take_position(controller);
        report_cycle(controller);
        report_map(controller);
        return controller.estimates;
    }
};

TEST(ReportMap, AlarmsAndSlipNeedTheLinkage) {
    Report report;
    EXPECT_EQ(report.make(true).available, kAvailableLinkage | kAvailableSlip | kAvailableSinkage);
    EXPECT_EQ(report.make(true).events, kEventSlipAlarm | kEventSinkageAlarm);
    EXPECT_EQ(report.make(false).available, 0);
    EXPECT_EQ(report.make(false).events, 0);
}

TEST(ReportMap, SinkageAndItsAlarmAreNotThoseOfAnotherPlaceInReverse) {
    Report report;
    report.controller.map.mode = SlipMode::reversing;
    EXPECT_EQ(report.make(true).available, kAvailableLinkage | kAvailableSlip);
    EXPECT_EQ(report.make(true).events, kEventSlipAlarm);
}

TEST(ReportMap, SlipIsNotAvailableBeforeTheRearWheelStandsOnMeasuredGround) {
    Report report;
    report.controller.map.measured = false;
    EXPECT_EQ(report.make(true).available & kAvailableSlip, 0);
    report.controller.map.measured = true;
    report.controller.map.has_map = false;
    EXPECT_EQ(report.make(true).available & kAvailableSlip, 0);
}

TEST(ReportMap, PositionRunsOnFromTheLastCycle) {
    Report report;
    report.controller.map.mean_q12_bin = 4915;  // half
    report.controller.map.travelled_q6_bin = 64 * 100;
    report.controller.since_cycle_q4_mm = 400;
    EXPECT_EQ(report.make(true).position_q4_mm, 100 * 400 + 200);
    report.controller.since_cycle_q4_mm = -400;
    EXPECT_EQ(report.make(true).position_q4_mm, 100 * 400 - 400);
}

TEST(Command, DrivesAheadAndSlowlyWhileAnAlarmIsUp) {
    for (const Event event : {kEventCycle, kEventSlipAlarm, kEventSinkageAlarm, kEventLostLock,
                              kEventTickGap, kEventSensorFault, kEventOverspeed}) {
        Estimates estimates;
        set_event(estimates, event);
        hal::Commands commands;
        command(estimates, commands);
        const bool alarm = event == kEventSlipAlarm || event == kEventSinkageAlarm;
        for (const std::int8_t drive : commands.drive_percent) EXPECT_EQ(drive, alarm ? 50 : 100);
    }
}

}  // namespace
