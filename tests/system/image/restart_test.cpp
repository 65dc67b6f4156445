// restart_test.cpp - resets at any moment: the drive goes on where it was, from a whole checkpoint.
#include <gtest/gtest.h>

#include <cstring>
#include <random>

#include "firmware/executive/controller.hpp"
#include "tests/system/image/image_bench.hpp"

namespace {

using image_test::ImageBench;
using image_test::kSecondT;
using image_test::kStepT;

/// The first telemetry frame of a warm start, by the host: from the record, nothing has moved.
std::vector<std::uint8_t> first_frame(const rover::PoseRecord& record) {
    hal::Calibration none;
    none.version = 0;
    rover::Controller controller;
    rover::controller_reset(controller, none);
    rover::controller_resume(controller, record);
    hal::RawInputs inputs;
    for (std::uint16_t& count : inputs.adc_q4_count) count = hal::kAdcAbsent;
    for (std::size_t i = 0; i < 5; ++i) inputs.adc_q4_count[i] = 16 * 2047;
    inputs.tach_present = 0x3F;
    const hal::Commands commands = rover::controller_step(controller, inputs);
    return {commands.telemetry, commands.telemetry + commands.telemetry_size};
}

bool same(const rover::PoseRecord& a, const rover::PoseRecord& b) {
    return std::memcmp(&a, &b, sizeof a) == 0;
}

/// Runs up to the first telemetry frame behind a reset.
std::vector<std::uint8_t> next_frame(ImageBench& bench) {
    const std::uint64_t limit = bench.now() + 10 * kSecondT;
    while (bench.now() < limit) {
        bench.run(kStepT / 10);
        const auto frames = bench.frames();
        if (!frames.empty()) return frames.front().bytes;
    }
    return {};
}

// 4 steps of drive between resets on average, a fifth of the resets during the boot itself.
TEST(ImageRestart, AThousandResetsAtRandomMomentsLoseAtMostOneStep) {
    const unsigned seed = 85;
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    ImageBench bench;
    ASSERT_TRUE(bench.run_to_step(3));
    unsigned in_boot = 0;
    std::int32_t furthest = 0;
    for (int round = 0; round < 1000; ++round) {
        const auto start = bench.checkpoint();
        ASSERT_TRUE(start);
        const std::uint16_t steps_before = bench.steps();
        const bool early = random() % 5 == 0;
        const std::uint64_t way = early ? 0 : random() % (8 * kStepT);
        if (early) {
            ++in_boot;
            bench.board.reset();
            bench.run(random() % kSecondT);
        } else {
            bench.drive(static_cast<unsigned>(way / 4000 + 1), way + 1);
            bench.run(way);
        }
        const auto before = bench.checkpoint();
        ASSERT_TRUE(before) << round;
        if (!early) {
            // One checkpoint a step; that of the step under way may be written already.
            const auto written = static_cast<std::uint8_t>(before->sequence - start->sequence);
            const auto steps = static_cast<std::uint8_t>(bench.steps() - steps_before);
            ASSERT_TRUE(written == steps || written == steps + 1) << round;
        }
        furthest = std::max(furthest, before->record.odometer_q4_mm);
        bench.board.reset();
        bench.board.take_transmitted();
        ASSERT_EQ(next_frame(bench), first_frame(before->record)) << "round " << round;
        ASSERT_EQ(bench.fault_register(), rover::kFaultNoRecord) << round;
    }
    EXPECT_GT(furthest, 16 * 10'000);  // over 10 m
    std::printf("1000 resets, %u of them during the boot, %.1f m driven\n", in_boot,
                furthest / 16000.0);
}

TEST(ImageRestart, ACheckpointCostsAtMost6000TStates) {
    ImageBench bench;
    ASSERT_TRUE(bench.run_to_step(3));
    ASSERT_TRUE(bench.run_to("rover_checkpoint"));
    bench.board.state.cpu.interrupt_enable = false;
    const std::uint16_t sp = bench.board.state.cpu.sp;
    const std::uint64_t start = bench.now();
    host_sim::StepRecord record;
    while (bench.board.state.cpu.sp <= sp) bench.board.step(record);
    std::printf("checkpoint: %d T\n", static_cast<int>(bench.now() - start));
    EXPECT_LE(bench.now() - start, 6000u);
}

TEST(ImageRestart, AResetBehindAnyInstructionOfTheCheckpointFindsTheOldOrTheNewOne) {
    ImageBench bench;
    ASSERT_TRUE(bench.run_to_step(3));
    bench.drive(60, kStepT / 10);
    ASSERT_TRUE(bench.run_to_step(4));
    bench.drive(60, kStepT / 10);
    ASSERT_TRUE(bench.run_to_step(5));
    bench.drive(60, kStepT / 10);
    bench.run(kStepT / 10);
    ASSERT_TRUE(bench.run_to("rover_checkpoint"));
    const std::uint16_t sp = bench.board.state.cpu.sp;
    const auto old = bench.checkpoint();
    ASSERT_TRUE(old);
    std::vector<host_sim::BoardState> boundaries;
    host_sim::StepRecord record;
    while (bench.board.state.cpu.sp <= sp) {
        boundaries.push_back(bench.board.state);
        bench.board.step(record);
    }
    std::printf("checkpoint: %d instructions, those of interrupts included\n",
                static_cast<int>(boundaries.size()));
    const auto fresh = bench.checkpoint();
    ASSERT_TRUE(fresh);
    ASSERT_FALSE(same(fresh->record, old->record));
    EXPECT_EQ(fresh->sequence, old->sequence + 1);
    const auto old_frame = first_frame(old->record);
    const auto fresh_frame = first_frame(fresh->record);
    bool is_new = false;
    unsigned booted = 0;
    for (std::size_t i = 0; i < boundaries.size(); ++i) {
        ImageBench cut;
        cut.board.state = boundaries[i];
        const auto seen = cut.checkpoint();
        ASSERT_TRUE(seen) << "instruction " << i;
        const bool seen_new = same(seen->record, fresh->record);
        ASSERT_TRUE(seen_new || same(seen->record, old->record)) << "instruction " << i;
        ASSERT_TRUE(seen_new || !is_new) << "instruction " << i;
        is_new = seen_new;
        cut.board.take_transmitted();
        if (i % 3 == 0) {
            cut.board.power_cycle();
        } else {
            cut.board.reset();
        }
        // The cold sensors of a power cycle are at 0 V again.
        for (std::uint8_t channel = 0; channel < 5; ++channel) cut.sensor(channel, 2047);
        ASSERT_EQ(next_frame(cut), is_new ? fresh_frame : old_frame) << "instruction " << i;
        ++booted;
    }
    std::printf("%u resets and losses of supply\n", booted);
}

}  // namespace
