// link_frames_test.cpp - the ground's frames against docs/spec/link.md and the firmware's own end.
#include "host_sim/bind/link_frames.hpp"

#include <gtest/gtest.h>

#include <random>
#include <string_view>

#include "firmware/link/calibration_frame.hpp"
#include "firmware/link/frames.hpp"
#include "firmware/link/telemetry.hpp"

namespace {

using host_sim::DownlinkFrame;
using host_sim::DownlinkReader;
using host_sim::UplinkType;
using Bytes = std::vector<uint8_t>;

TEST(LinkCrc, CheckValue) {
    constexpr std::string_view kText = "123456789";
    EXPECT_EQ(host_sim::link_crc(Bytes(kText.begin(), kText.end())), 0x29B1);
}

TEST(UplinkFrame, IsTheBytesOfThePageAndTheFirmwareReadsThem) {
    const Bytes payload = {1, 0xC5, 0x3A, 9};
    const Bytes bytes = host_sim::uplink_frame(UplinkType::restart, payload);
    ASSERT_EQ(bytes.size(), 10u);
    EXPECT_EQ(Bytes(bytes.begin(), bytes.begin() + 8), (Bytes{0xC5, 0x3A, 4, 4, 1, 0xC5, 0x3A, 9}));
    rover::UplinkParser parser;
    for (std::size_t i = 0; i < bytes.size(); ++i) {
        EXPECT_EQ(parser.take(bytes[i]), i + 1 == bytes.size()) << i;
    }
    EXPECT_EQ(parser.type(), 4);
    EXPECT_EQ(Bytes(parser.payload(), parser.payload() + parser.size()), payload);
}

TEST(CalibrationPayload, TheFirmwareReadsWhatWasMeant) {
    hal::Calibration calibration;
    calibration.version = 0x0102;
    for (unsigned i = 0; i < hal::kAngleChannelCount; ++i) {
        calibration.angle[i] = {static_cast<uint16_t>(0x1100 + i),
                                static_cast<uint16_t>(0x2200 + i), i % 2 == 1};
    }
    calibration.wheel_radius_q4_mm = 0x3344;
    calibration.tach_counts_per_turn = 0x5566;
    calibration.tach_q16_mm_per_count = 0x7788;
    calibration.range_offset_q1_mm = -2;
    const Bytes payload = host_sim::calibration_payload(calibration);
    uint8_t expected[rover::kCalibrationBytes];
    rover::write_calibration(calibration, expected);
    EXPECT_EQ(payload, Bytes(expected, expected + sizeof expected));
    EXPECT_EQ(payload.size(), 35u);
    EXPECT_EQ(Bytes(payload.begin(), payload.begin() + 7), (Bytes{2, 1, 0, 0x11, 0, 0x22, 0}));
    EXPECT_EQ(Bytes(payload.end() - 2, payload.end()), (Bytes{0xFE, 0xFF}));
}

Bytes telemetry_frame(uint16_t step_count) {
    rover::Estimates estimates;
    estimates.step_count = step_count;
    uint8_t frame[hal::kTelemetryBytesMax];
    const uint8_t size = rover::write_telemetry(estimates, frame);
    return {frame, frame + size};
}

std::vector<DownlinkFrame> read(DownlinkReader& reader, const Bytes& bytes) {
    std::vector<DownlinkFrame> frames;
    uint64_t t = 0;
    for (const uint8_t byte : bytes) {
        if (auto frame = reader.take(byte, t += 1600)) frames.push_back(*frame);
    }
    return frames;
}

TEST(DownlinkReader, FindsFramesAndSaysWhenTheyWereComplete) {
    DownlinkReader reader;
    Bytes bytes = telemetry_frame(0x0304);
    bytes.insert(bytes.begin(), {0x00, 0xA5});  // the second is also a first sync byte
    const auto frames = read(reader, bytes);
    ASSERT_EQ(frames.size(), 1u);
    EXPECT_EQ(frames[0].kind(), DownlinkFrame::kTelemetry);
    EXPECT_EQ(frames[0].bytes, telemetry_frame(0x0304));
    EXPECT_EQ(frames[0].payload().size(), 44u);
    EXPECT_EQ(frames[0].word(0), 0x0304);
    EXPECT_EQ(frames[0].end_t, 52u * 1600);
    EXPECT_EQ(reader.stray_bytes(), 2u);
}

TEST(DownlinkReader, DamageCostsTheDamagedFrameAlone) {
    const Bytes good = telemetry_frame(1), behind = telemetry_frame(2);
    for (std::size_t at = 0; at < good.size(); ++at) {
        if (at == 3) continue;  // another size: the frame behind is needed to notice
        DownlinkReader reader;
        Bytes bytes = good;
        bytes[at] ^= 0x10;
        bytes.insert(bytes.end(), behind.begin(), behind.end());
        const auto frames = read(reader, bytes);
        ASSERT_EQ(frames.size(), 1u) << at;
        EXPECT_EQ(frames[0].bytes, behind) << at;
        EXPECT_EQ(reader.stray_bytes(), good.size()) << at;
    }
}

TEST(DownlinkReader, RubbishBetweenFramesIsCounted) {
    constexpr unsigned kSeed = 85;
    std::mt19937 random(kSeed);
    DownlinkReader reader;
    std::size_t found = 0, rubbish = 0;
    for (int i = 0; i < 200; ++i) {
        Bytes bytes(random() % 20);
        for (uint8_t& byte : bytes) byte = static_cast<uint8_t>(random() % 0xA0);  // no sync byte
        rubbish += bytes.size();
        const Bytes frame = telemetry_frame(static_cast<uint16_t>(i));
        bytes.insert(bytes.end(), frame.begin(), frame.end());
        found += read(reader, bytes).size();
    }
    EXPECT_EQ(found, 200u) << "seed " << kSeed;
    EXPECT_EQ(reader.stray_bytes(), rubbish);
}

TEST(DownlinkReader, CountsFramesWithAWrongCheck) {
    DownlinkReader reader;
    Bytes bytes = telemetry_frame(7);
    bytes[20] ^= 0x10;
    for (const uint8_t byte : bytes) EXPECT_FALSE(reader.take(byte, 0));
    EXPECT_EQ(reader.refused_frames(), 1u);
    EXPECT_EQ(reader.stray_bytes(), bytes.size());
    std::size_t whole = 0;
    for (const uint8_t byte : telemetry_frame(8)) whole += reader.take(byte, 0) ? 1U : 0U;
    EXPECT_EQ(whole, 1u);
    EXPECT_EQ(reader.refused_frames(), 1u);
}

}  // namespace
