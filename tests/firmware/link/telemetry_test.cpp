// telemetry_test.cpp - the frame against a frame written by hand and against its specification.
#include "firmware/link/telemetry.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cstddef>
#include <cstring>
#include <random>
#include <string>
#include <vector>

#include "tests/support/page_table.hpp"

namespace {

using Frame = std::uint8_t[hal::kTelemetryBytesMax];

rover::Estimates sample() {
    rover::Estimates e;
    e.step_count = 0x0102;
    e.tick_count = 0x0304;
    e.available = 0x3F;
    e.events = 0x41;
    e.faults = 0x00A5;
    e.mode = rover::SlipMode::reversing;
    e.cycle_count = 0x0506;
    e.position_q4_mm = -2;
    e.odometer_q4_mm = 0x0708090A;
    e.position_sigma_q4_mm = 0xFFFE;
    e.advance_q4_mm = -256;
    e.slip_percent = -1;
    e.match_cost_q4 = 0x0B0C;
    e.sinkage_q4_mm = 0x0D0E;
    e.pitch_brad = -32768;
    e.roll_brad = 32767;
    e.rocker_brad = 0x0F10;
    e.bogie_brad = 0x1112;
    e.height_middle_q4_mm = 0x1314;
    e.height_front_q4_mm = 0x1516;
    e.height_ahead_q4_mm[0] = 0x1718;
    e.height_ahead_q4_mm[1] = 0x191A;
    return e;
}

/// Check of bytes 2 to 47, bit by bit.
std::uint16_t check_of(const std::uint8_t* frame) {
    std::uint32_t crc = 0xFFFF;
    for (int i = 2; i < 48; ++i) {
        crc ^= std::uint32_t{frame[i]} << 8;
        for (int bit = 0; bit < 8; ++bit) {
            crc = (crc & 0x8000u) != 0 ? (crc << 1) ^ 0x1021u : crc << 1;
        }
    }
    return static_cast<std::uint16_t>(crc);
}

TEST(Telemetry, FrameIsTheOneWrittenByHand) {
    const std::array<std::uint8_t, 48> expected = {
        0xA5, 0x5A, 0x01, 0x2C,              // head
        0x02, 0x01, 0x04, 0x03, 0x3F, 0x41,  // step, tick, available, events
        0xA5, 0x00, 0x03, 0x06, 0x05,        // faults, mode, cycle
        0xFE, 0xFF, 0xFF, 0xFF,              // position
        0x0A, 0x09, 0x08, 0x07,              // odometer
        0xFE, 0xFF, 0x00, 0xFF, 0xFF,        // sigma, advance, slip
        0x0C, 0x0B, 0x0E, 0x0D,              // cost, sinkage
        0x00, 0x80, 0xFF, 0x7F,              // pitch, roll
        0x10, 0x0F, 0x12, 0x11,              // rocker, bogie
        0x14, 0x13, 0x16, 0x15,              // z(1), z(2)
        0x18, 0x17, 0x1A, 0x19,              // z(3), z(4)
    };
    Frame frame = {};
    EXPECT_EQ(rover::write_telemetry(sample(), frame), 50);
    EXPECT_EQ(std::memcmp(frame, expected.data(), expected.size()), 0);
    EXPECT_EQ(frame[48] | frame[49] << 8, check_of(expected.data()));
    EXPECT_EQ(rover::kTelemetryPayloadSize, 44);
}

// The payload is the bytes of the estimates where structs have no padding.
TEST(Telemetry, VisitsTheFieldsInTheOrderOfTheirDeclarations) {
    rover::Estimates estimates;
    const void* last = nullptr;
    std::size_t bytes = 0;
    rover::for_each_field(estimates, [&](const auto& field) {
        EXPECT_GT(static_cast<const void*>(&field), last) << "field at byte " << bytes;
        last = &field;
        bytes += sizeof field;
    });
    EXPECT_EQ(bytes, rover::kTelemetryPayloadSize);
}

TEST(Telemetry, EveryWrongBitIsRefusedAndNothingIsTouched) {
    Frame frame = {};
    rover::write_telemetry(sample(), frame);
    for (std::size_t bit = 0; bit < 50 * 8; ++bit) {
        frame[bit / 8] = static_cast<std::uint8_t>(frame[bit / 8] ^ 1u << bit % 8);
        rover::Estimates untouched;
        untouched.step_count = 777;
        EXPECT_FALSE(rover::read_telemetry(frame, 50, untouched)) << "bit " << bit;
        EXPECT_EQ(untouched.step_count, 777);
        EXPECT_EQ(untouched.cycle_count, 0);
        frame[bit / 8] = static_cast<std::uint8_t>(frame[bit / 8] ^ 1u << bit % 8);
    }
    rover::Estimates read;
    EXPECT_TRUE(rover::read_telemetry(frame, 50, read));
}

TEST(Telemetry, AnotherSizeOrAnUnknownModeIsRefused) {
    Frame frame = {};
    rover::write_telemetry(sample(), frame);
    rover::Estimates read;
    for (std::uint8_t size = 0; size < 160; ++size) {
        EXPECT_EQ(rover::read_telemetry(frame, size, read), size == 50);
    }
    for (std::uint32_t mode = 0; mode < 256; ++mode) {
        frame[12] = static_cast<std::uint8_t>(mode);
        const std::uint16_t check = check_of(frame);
        frame[48] = static_cast<std::uint8_t>(check & 0xFFu);
        frame[49] = static_cast<std::uint8_t>(check >> 8);
        EXPECT_EQ(rover::read_telemetry(frame, 50, read), mode <= 5) << mode;
    }
}

// The payload is a bijection: any 44 bytes with a legal mode are some estimates, and come out
// again.
TEST(Telemetry, WhatIsReadIsWhatWasWritten) {
    const std::uint32_t seed = std::random_device{}();
    std::mt19937 random(seed);
    for (int round = 0; round < 20000; ++round) {
        Frame frame = {0xA5, 0x5A, 1, 44};
        for (int i = 4; i < 48; ++i) frame[i] = static_cast<std::uint8_t>(random() & 0xFFu);
        frame[12] = static_cast<std::uint8_t>(random() % 6);
        const std::uint16_t check = check_of(frame);
        frame[48] = static_cast<std::uint8_t>(check & 0xFFu);
        frame[49] = static_cast<std::uint8_t>(check >> 8);
        rover::Estimates read;
        ASSERT_TRUE(rover::read_telemetry(frame, 50, read)) << "seed " << seed;
        Frame again = {};
        ASSERT_EQ(rover::write_telemetry(read, again), 50);
        ASSERT_EQ(std::memcmp(frame, again, 50), 0) << "seed " << seed << " round " << round;
    }
}

// -- The page ------------------------------------------------------------------------------------

using test_support::Row;

std::vector<Row> table_of(const std::string& heading) {
    return test_support::table_of("docs/spec/telemetry.md", heading);
}

std::string type_name(const std::uint8_t&) {
    return "u8";
}
std::string type_name(const std::int8_t&) {
    return "s8";
}
std::string type_name(const std::uint16_t&) {
    return "u16";
}
std::string type_name(const std::int16_t&) {
    return "s16";
}
std::string type_name(const std::int32_t&) {
    return "s32";
}
std::string type_name(const rover::SlipMode&) {
    return "u8";
}

/// Name of the member that lies at an offset of Estimates.
std::string member_at(std::size_t offset) {
#define ROVER_MEMBER(name) \
    if (offset == offsetof(rover::Estimates, name)) return #name
    ROVER_MEMBER(step_count);
    ROVER_MEMBER(tick_count);
    ROVER_MEMBER(available);
    ROVER_MEMBER(events);
    ROVER_MEMBER(faults);
    ROVER_MEMBER(mode);
    ROVER_MEMBER(cycle_count);
    ROVER_MEMBER(position_q4_mm);
    ROVER_MEMBER(odometer_q4_mm);
    ROVER_MEMBER(position_sigma_q4_mm);
    ROVER_MEMBER(advance_q4_mm);
    ROVER_MEMBER(slip_percent);
    ROVER_MEMBER(match_cost_q4);
    ROVER_MEMBER(sinkage_q4_mm);
    ROVER_MEMBER(pitch_brad);
    ROVER_MEMBER(roll_brad);
    ROVER_MEMBER(rocker_brad);
    ROVER_MEMBER(bogie_brad);
    ROVER_MEMBER(height_middle_q4_mm);
    ROVER_MEMBER(height_front_q4_mm);
    ROVER_MEMBER(height_ahead_q4_mm[0]);
    ROVER_MEMBER(height_ahead_q4_mm[1]);
#undef ROVER_MEMBER
    return "unknown";
}

TEST(TelemetryPage, PayloadTableHasTheFieldsOffsetsAndTypesOfTheCode) {
    const std::vector<Row> rows = table_of("## Payload");
    rover::Estimates estimates;
    std::size_t offset = rover::kTelemetryHeadSize;
    std::size_t index = 0;
    rover::for_each_field(estimates, [&](auto& field) {
        ASSERT_LT(index, rows.size());
        const Row& row = rows[index++];
        ASSERT_EQ(row.size(), 6u);
        const auto at = static_cast<std::size_t>(reinterpret_cast<const char*>(&field) -
                                                 reinterpret_cast<const char*>(&estimates));
        EXPECT_EQ(row[0], std::to_string(offset));
        EXPECT_EQ(row[1], type_name(field));
        EXPECT_EQ(row[2], member_at(at));
        offset += sizeof(field);
    });
    EXPECT_EQ(index, rows.size());
    EXPECT_EQ(offset, 48u);
}

TEST(TelemetryPage, FrameTableHasNoGapAndFiftyBytes) {
    std::size_t offset = 0;
    for (const Row& row : table_of("## Frame")) {
        EXPECT_EQ(row.at(0), std::to_string(offset));
        offset += std::stoul(row.at(1));
    }
    EXPECT_EQ(offset, rover::kTelemetrySize);
}

TEST(TelemetryPage, BitTablesHaveTheBitsOfTheCode) {
    const auto check = [](const std::string& heading,
                          const std::vector<std::pair<std::string, unsigned>>& bits) {
        const std::vector<Row> rows = table_of(heading);
        ASSERT_EQ(rows.size(), bits.size()) << heading;
        for (std::size_t i = 0; i < bits.size(); ++i) {
            EXPECT_EQ(rows[i].at(1), bits[i].first);
            EXPECT_EQ(1u << std::stoul(rows[i].at(0)), bits[i].second) << bits[i].first;
        }
    };
    using namespace rover;
    check("### available", {{"kAvailableOdometry", kAvailableOdometry},
                            {"kAvailableAttitude", kAvailableAttitude},
                            {"kAvailableLinkage", kAvailableLinkage},
                            {"kAvailableSlip", kAvailableSlip},
                            {"kAvailableLookAhead", kAvailableLookAhead},
                            {"kAvailableSinkage", kAvailableSinkage}});
    check("### events", {{"kEventCycle", kEventCycle},
                         {"kEventSlipAlarm", kEventSlipAlarm},
                         {"kEventSinkageAlarm", kEventSinkageAlarm},
                         {"kEventLostLock", kEventLostLock},
                         {"kEventTickGap", kEventTickGap},
                         {"kEventSensorFault", kEventSensorFault},
                         {"kEventOverspeed", kEventOverspeed}});
    check("### faults", {{"kFaultBogieLeft", kFaultBogieLeft},
                         {"kFaultBogieRight", kFaultBogieRight},
                         {"kFaultDifferential", kFaultDifferential},
                         {"kFaultPitch", kFaultPitch},
                         {"kFaultRoll", kFaultRoll},
                         {"kFaultTachometer", kFaultTachometer},
                         {"kFaultRangeStale", kFaultRangeStale},
                         {"kFaultCalibration", kFaultCalibration}});
}

TEST(TelemetryPage, ModeTableHasTheModesOfTheCode) {
    const std::vector<std::pair<std::string, rover::SlipMode>> modes = {
        {"odometry_only", rover::SlipMode::odometry_only},
        {"tracking", rover::SlipMode::tracking},
        {"reacquiring", rover::SlipMode::reacquiring},
        {"reversing", rover::SlipMode::reversing},
        {"turning", rover::SlipMode::turning},
        {"moved", rover::SlipMode::moved}};
    const std::vector<Row> rows = table_of("### mode");
    ASSERT_EQ(rows.size(), modes.size());
    for (std::size_t i = 0; i < modes.size(); ++i) {
        EXPECT_EQ(rows[i].at(1), modes[i].first);
        EXPECT_EQ(rows[i].at(0), std::to_string(static_cast<int>(modes[i].second)));
    }
}

}  // namespace
