// Messages in words, every figure converted by hand.
#include "tools/monitor/words.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace {

using monitor::Telemetry;
using rover::Estimates;
using testing::HasSubstr;

/// 1.25 m by the odometer, 1 m by the estimator, 25 % slip, 8.5 mm sinkage.
Telemetry sample() {
    Telemetry telemetry;
    telemetry.step = 70'000;
    Estimates& e = telemetry.estimates;
    e.available = rover::kAvailableOdometry | rover::kAvailableAttitude | rover::kAvailableLinkage |
                  rover::kAvailableSlip | rover::kAvailableSinkage;
    e.position_q4_mm = 16'000;
    e.odometer_q4_mm = 20'000;
    e.position_sigma_q4_mm = 192;  // 12 mm
    e.slip_percent = 25;
    e.sinkage_q4_mm = 136;
    e.pitch_brad = 1820;  // 9.998 degrees
    e.roll_brad = -3641;  // -20.001 degrees
    e.rocker_brad = 182;  // 0.9998 degrees
    e.bogie_brad = -1;    // -0.005 degrees
    e.mode = rover::SlipMode::tracking;
    return telemetry;
}

TEST(Words, ATelemetryLineHasEveryFigureInItsUnit) {
    EXPECT_EQ(monitor::telemetry_line(sample()),
              "step 70000 7000.0 s: position 1.000 m ±0.012, odometer 1.250 m, slip 25 %, "
              "sinkage 8.5 mm, pitch +10.0° roll -20.0° rocker +1.0° bogie +0.0°; tracking; "
              "alarms: none; sensor faults: none");
}

TEST(Words, WhatIsNotAvailableIsNoNumber) {
    Telemetry telemetry = sample();
    telemetry.estimates.available = 0;
    EXPECT_THAT(monitor::telemetry_line(telemetry),
                HasSubstr("position -, odometer -, slip -, sinkage -, pitch - roll - rocker - "
                          "bogie -;"));
}

TEST(Words, AlarmsAndFaultsHaveNames) {
    Estimates e;
    e.events = 0x7F;
    EXPECT_EQ(monitor::alarm_names(e), "SLIP, SINKAGE, lost lock, overspeed, tick gap");
    e.events = 0x81;
    EXPECT_EQ(monitor::alarm_names(e), "bits 0080H");
    e.faults = 0x0021;
    EXPECT_EQ(monitor::sensor_fault_names(e),
              "left bogie potentiometer, a tachometer disagrees with the others");
    EXPECT_EQ(monitor::board_fault_names(0), "none");
    EXPECT_EQ(monitor::board_fault_names(0x0240), "no calibration record, bumper (drives off)");
    EXPECT_EQ(monitor::board_fault_names(0x0101),
              "ROM check wrong (drives off), undervoltage (drives off)");
    EXPECT_EQ(monitor::board_fault_names(0x8000), "bits 8000H");
}

TEST(Words, AStatusLineSaysWhyTheBoardStarted) {
    rover::BoardStatus status;
    status.reset_count = 7;
    status.reset_cause = rover::ResetCause::watchdog;
    status.warm = 1;
    status.faults = 0x0080;
    status.last_faults = 0x0004;
    status.late_steps = 1;
    status.received = 300;
    EXPECT_EQ(monitor::status_line(status),
              "status: reset 7: watchdog, warm start; faults: no checkpoint; of the run before: "
              "stack overwritten (drives off); steps late 1, left out 0; bytes received 300, "
              "dropped 0, wrong 0; frames left out 0, refused 0; traps 0");
}

TEST(Words, NoticesTellOfGapsAndRestarts) {
    Telemetry telemetry = sample();
    EXPECT_EQ(monitor::notice(telemetry), "");
    telemetry.missing = 1;
    EXPECT_EQ(monitor::notice(telemetry), "no telemetry of 1 step before step 70000");
    telemetry.missing = 4;
    telemetry.restart = host_sim::Restart::cold;
    EXPECT_EQ(monitor::notice(telemetry),
              "the rover was reset and has started cold; no telemetry of 4 steps before step "
              "70000");
}

TEST(Words, AScreenShowsWhatIsKnown) {
    monitor::Known known;
    known.port = "/dev/ttyUSB0";
    EXPECT_EQ(monitor::screen(known).size(), 2u);
    known.telemetry = sample();
    known.telemetry->estimates.events = rover::kEventSlipAlarm;
    known.status.emplace();
    known.identity.emplace();
    const std::vector<std::string> lines = monitor::screen(known);
    EXPECT_EQ(lines.size(), 10u);
    EXPECT_EQ(lines[0], "/dev/ttyUSB0   rover85 0.0.0 sources 00000000");
    EXPECT_EQ(lines[5], "alarms    SLIP");
    EXPECT_EQ(lines[7], "board     reset 0: power-up, cold start");
}

}  // namespace
