// link_test.cpp - what the image answers over the link, and the records it keeps.
#include <gtest/gtest.h>

#include <algorithm>

#include "firmware/link/calibration_frame.hpp"
#include "tests/system/image/image_bench.hpp"

namespace {

using Bytes = std::vector<std::uint8_t>;
using image_test::ImageBench;
using image_test::kSecondT;
using image_test::kStepT;

Bytes record_of(const hal::Calibration& calibration) {
    std::uint8_t bytes[rover::kCalibrationBytes];
    rover::write_calibration(calibration, bytes);
    return {bytes, bytes + rover::kCalibrationBytes};
}

Bytes acknowledged(ImageBench& bench, std::uint8_t type, const Bytes& payload) {
    const auto frame = bench.ask(type, payload, 0x82);
    return frame ? frame->payload : Bytes{};
}

TEST(ImageLink, IdentityIsTheBlockInTheImage) {
    ImageBench bench;
    ASSERT_TRUE(bench.run_to_step(1));
    const auto frame = bench.ask(1, {}, 0x80);
    ASSERT_TRUE(frame);
    const auto& program = image_test::program();
    const auto block = program.rom.begin() + program.identity;
    EXPECT_EQ(std::string(block, block + 7), "ROVER85");
    EXPECT_EQ(frame->payload, Bytes(block + 8, block + 28));
    EXPECT_EQ(frame->payload[0], 1);
    EXPECT_EQ(frame->payload[8] | frame->payload[9] << 8, static_cast<int>(program.image_end));
    EXPECT_EQ(std::string(frame->payload.begin() + 12, frame->payload.end()), "Rocky3.2");
}

TEST(ImageLink, StatusOfAFreshBoard) {
    ImageBench bench;
    ASSERT_TRUE(bench.run_to_step(3));
    const auto status = bench.ask_status();
    ASSERT_TRUE(status);
    EXPECT_EQ(status->faults, rover::kFaultNoRecord | rover::kFaultNoCheckpoint);
    EXPECT_EQ(status->reset_count, 1);
    EXPECT_EQ(status->reset_cause, rover::ResetCause::power_up);
    EXPECT_EQ(status->warm, 0);
    EXPECT_EQ(status->received, 6);
    EXPECT_EQ(status->receive_dropped, 0);
    EXPECT_EQ(status->receive_errors, 0);
    EXPECT_EQ(status->late_steps, 0);
    EXPECT_EQ(status->trap_count, 0);
}

TEST(ImageLink, AnswersFramesBehindNoise) {
    ImageBench bench;
    ASSERT_TRUE(bench.run_to_step(1));
    bench.send({0x00, 0xC5, 0xC5, 0x3A, 0x02, 0x00, 0x00, 0x00, 0xC5});
    bench.run(kStepT);
    const auto status = bench.ask_status();
    ASSERT_TRUE(status);
    EXPECT_EQ(status->frames_refused, 1);
    EXPECT_EQ(status->received, 15);
}

TEST(ImageLink, UnknownTypesAndWrongSizesAreSaid) {
    ImageBench bench;
    ASSERT_TRUE(bench.run_to_step(1));
    EXPECT_EQ(acknowledged(bench, 0x05, {}), (Bytes{0x05, 1}));
    EXPECT_EQ(acknowledged(bench, 0x7F, {1, 2, 3}), (Bytes{0x7F, 1}));
    EXPECT_EQ(acknowledged(bench, 0x03, Bytes(34)), (Bytes{0x03, 2}));
    EXPECT_EQ(acknowledged(bench, 0x03, Bytes(36)), (Bytes{0x03, 2}));
    EXPECT_EQ(acknowledged(bench, 0x03, Bytes(35)), (Bytes{0x03, 3}));  // version 0
    EXPECT_EQ(acknowledged(bench, 0x04, {}), (Bytes{0x04, 2}));
    EXPECT_EQ(acknowledged(bench, 0x04, {3}), (Bytes{0x04, 3}));
    EXPECT_EQ(bench.board.state.reset_count, 1u);
    EXPECT_EQ(bench.byte(0xFF60), 0);  // no record was written
}

TEST(ImageLink, ACalibrationRecordIsUsedFromTheNextResetOn) {
    ImageBench bench;
    ASSERT_TRUE(bench.run_to_step(1));
    bench.run(kStepT);
    auto before = bench.frames();
    ASSERT_FALSE(before.empty());
    EXPECT_EQ(before.back().payload[6] & 0x80, 0x80);  // kFaultCalibration in telemetry
    hal::Calibration calibration;
    calibration.angle[3].zero_q4_count = 16 * 2047 - 1000;
    calibration.angle[4].inverted = true;
    EXPECT_EQ(acknowledged(bench, 3, record_of(calibration)), (Bytes{0x03, 0}));
    bench.run(2 * kStepT);
    before = bench.frames();
    EXPECT_EQ(before.back().payload[6] & 0x80, 0x80);  // not yet
    const auto pitch_before = before.back().payload[28] | before.back().payload[29] << 8;
    bench.reset();
    ASSERT_TRUE(bench.run_to_step(1));
    bench.run(kStepT / 2);
    const auto after = bench.frames();
    EXPECT_EQ(after.back().payload[6] & 0x80, 0);
    const auto pitch =
        static_cast<std::int16_t>(after.back().payload[28] | after.back().payload[29] << 8);
    EXPECT_EQ(pitch_before, 0xFFFF - 2);  // -8 counts of 27307/65536 brad
    EXPECT_EQ(pitch, 417);                // 1000 counts
    EXPECT_EQ(bench.fault_register(), 0);
}

TEST(ImageLink, RestartsWarmAndCold) {
    ImageBench bench;
    ASSERT_TRUE(bench.run_to_step(1));
    for (int i = 0; i < 20; ++i) {
        bench.drive(50, kStepT);
        bench.run(kStepT);
    }
    for (const std::uint8_t cold : {std::uint8_t{0}, std::uint8_t{1}}) {
        const auto resets = bench.board.state.reset_count;
        EXPECT_EQ(acknowledged(bench, 4, {cold}), (Bytes{4, 0}));
        const auto odometer = bench.checkpoint()->record.odometer_q4_mm;
        EXPECT_GT(odometer, 16 * 100);
        EXPECT_EQ(bench.board.state.motors.duty(0), 0);
        bench.run(kSecondT * 6 / 10);
        EXPECT_EQ(bench.board.state.reset_count, resets + 1);
        ASSERT_TRUE(bench.run_to_step(1));
        EXPECT_EQ(bench.checkpoint()->record.odometer_q4_mm, cold != 0 ? 0 : odometer);
        const auto status = bench.ask_status();
        ASSERT_TRUE(status);
        EXPECT_EQ(status->reset_cause, rover::ResetCause::restart);
        EXPECT_EQ(status->warm, cold != 0 ? 0 : 1);
        EXPECT_EQ(bench.board.state.motors.duty(0), 255);
    }
}

TEST(ImageLink, TelemetryIsNotDisturbedByAnswers) {
    ImageBench bench;
    ASSERT_TRUE(bench.run_to_step(1));
    bench.frames();
    for (int i = 0; i < 30; ++i) {
        bench.send_frame(static_cast<std::uint8_t>(1 + i % 2), {});
        bench.run(kStepT);
    }
    bench.run(kStepT / 2);
    const auto frames = bench.frames();
    const auto of_kind = [&](std::uint8_t kind) {
        return std::ranges::count_if(frames, [&](const auto& f) { return f.kind == kind; });
    };
    EXPECT_EQ(of_kind(0x80), 15);
    EXPECT_EQ(of_kind(0x81), 15);
    EXPECT_NEAR(static_cast<double>(of_kind(0x01)), 31, 1);
    EXPECT_EQ(bench.stray_bytes(), 0u);
}

}  // namespace
