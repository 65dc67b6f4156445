// flight_test.cpp - the image's telemetry and motor latches are those of the controller on the
// host.
#include <gtest/gtest.h>

#include <random>

#include "firmware/executive/controller.hpp"
#include "tests/system/image/image_bench.hpp"

namespace {

using image_test::Frame;
using image_test::ImageBench;
using image_test::kStepT;

/// What the bench's board shows the controller when nothing moves.
hal::RawInputs quiet_inputs() {
    hal::RawInputs inputs;
    for (std::uint16_t& count : inputs.adc_q4_count) count = hal::kAdcAbsent;
    for (std::size_t i = 0; i < 5; ++i) inputs.adc_q4_count[i] = 16 * 2047;
    inputs.tach_present = 0x3F;
    return inputs;
}

/// A host controller as the image starts it without a calibration record.
rover::Controller cold_controller() {
    hal::Calibration none;
    none.version = 0;
    rover::Controller controller;
    rover::controller_reset(controller, none);
    return controller;
}

std::vector<std::uint8_t> telemetry(const hal::Commands& commands) {
    return {commands.telemetry, commands.telemetry + commands.telemetry_size};
}

TEST(ImageFlight, SendsTheHostsTelemetryTenTimesASecond) {
    ImageBench bench;
    ASSERT_TRUE(bench.run_to_step(1));
    const double boot_s = static_cast<double>(bench.now()) / image_test::kSecondT;
    RecordProperty("boot_ms", static_cast<int>(boot_s * 1000));
    std::printf("cold start: first step ends at %.3f s\n", boot_s);
    ASSERT_TRUE(bench.run_to_step(50));
    bench.run(kStepT / 2);
    rover::Controller host = cold_controller();
    hal::RawInputs inputs = quiet_inputs();
    const auto frames = bench.frames();
    ASSERT_EQ(frames.size(), 50u);
    for (std::size_t step = 0; step < frames.size(); ++step) {
        EXPECT_EQ(frames[step].bytes, telemetry(rover::controller_step(host, inputs)))
            << "step " << step;
        inputs.tick_count = static_cast<std::uint16_t>(inputs.tick_count + 10);
    }
    EXPECT_EQ(bench.stray_bytes(), 0u);
    EXPECT_EQ(bench.board.state.violation_count, 0u);
    EXPECT_EQ(bench.board.state.reset_count, 1u);
    EXPECT_EQ(bench.fault_register(), rover::kFaultNoRecord | rover::kFaultNoCheckpoint);
}

TEST(ImageFlight, DrivesOverBumpsAsTheHostDoes) {
    ImageBench bench;
    const unsigned seed = 11;
    std::mt19937 random(seed);
    ASSERT_TRUE(bench.run_to_step(1));
    rover::Controller host = cold_controller();
    hal::RawInputs inputs = quiet_inputs();
    hal::Commands commands = rover::controller_step(host, inputs);
    std::vector<std::vector<std::uint8_t>> expected = {telemetry(commands)};
    std::vector<Frame> frames;
    std::uint16_t pulses = 0;
    unsigned cycles = 0;
    for (std::uint16_t step = 1; step <= 300; ++step) {
        for (std::uint8_t channel = 0; channel < 5; ++channel) {
            const auto count = static_cast<std::uint16_t>(2000 + random() % 96);
            bench.sensor(channel, count);
            inputs.adc_q4_count[channel] = static_cast<std::uint16_t>(16 * count);
        }
        const auto more = static_cast<unsigned>(40 + random() % 30);
        const bool forward = random() % 8 != 0;
        for (std::uint8_t wheel = 0; wheel < 6; ++wheel) {
            bench.board.schedule({.t = bench.now(),
                                  .kind = host_sim::Stimulus::Kind::tach_forward,
                                  .index = wheel,
                                  .value = forward ? 1 : 0});
        }
        bench.drive(more, 20'000);
        pulses = static_cast<std::uint16_t>(forward ? pulses + more : pulses - more);
        for (std::uint16_t& count : inputs.tach_count) count = pulses;
        inputs.tick_count = static_cast<std::uint16_t>(inputs.tick_count + 10);
        commands = rover::controller_step(host, inputs);
        expected.push_back(telemetry(commands));
        cycles += (host.estimates.events & rover::kEventCycle) != 0 ? 1 : 0;
        ASSERT_TRUE(bench.run_to_step(static_cast<std::uint16_t>(step + 1)));
        for (const Frame& frame : bench.frames()) frames.push_back(frame);
        for (unsigned motor = 0; motor < 6; ++motor) {
            const int percent = commands.drive_percent[motor];
            ASSERT_EQ(bench.board.state.motors.duty(motor), (percent * 255 + 50) / 100);
        }
    }
    bench.run(kStepT / 2);
    for (const Frame& frame : bench.frames()) frames.push_back(frame);
    ASSERT_EQ(frames.size(), expected.size());
    for (std::size_t step = 0; step < frames.size(); ++step) {
        ASSERT_EQ(frames[step].bytes, expected[step]) << "seed " << seed << " step " << step;
    }
    EXPECT_GT(cycles, 30u);
    EXPECT_EQ(bench.board.state.violation_count, 0u);
}

TEST(ImageFlight, RangeScansAndDetectorsReachTheController) {
    ImageBench bench;
    bench.board.set_range_scan(0x03, {-10, 12, 0, 0, 0, 0, 0, 0});
    ASSERT_TRUE(bench.run_to_step(1));
    bench.run(kStepT / 3);
    const auto frames = bench.frames();
    ASSERT_EQ(frames.size(), 1u);
    EXPECT_NE(frames[0].payload[4] & rover::kAvailableLookAhead, 0);
}

TEST(ImageFlight, StartsWithinTwoAndAHalfSeconds) {
    ImageBench bench;
    ASSERT_TRUE(bench.run_to_step(1));
    const std::uint64_t cold = bench.now();
    const std::uint64_t before = bench.now();
    bench.reset();
    ASSERT_TRUE(bench.run_to_step(1));
    const std::uint64_t warm = bench.now() - before;
    std::printf("first step ends %.2f s behind power-up, %.2f s behind a reset\n",
                static_cast<double>(cold) / image_test::kSecondT,
                static_cast<double>(warm) / image_test::kSecondT);
    EXPECT_LT(cold, image_test::kSecondT * 5 / 2);
    EXPECT_LT(warm, image_test::kSecondT);
}

// docs/spec/memory-map.md; the addresses are in firmware/config/memory_layout.hpp.
TEST(ImageFlight, StaysInItsMemory) {
    for (const host_sim::Symbol& symbol : image_test::program().symbols.all()) {
        if (symbol.kind != host_sim::SymbolKind::data || symbol.address < 0x8000) continue;
        if (symbol.name.starts_with("loader")) continue;  // which does not run meanwhile
        EXPECT_LE(symbol.address + symbol.size, 0x8800u) << symbol.name;
    }
    ImageBench bench;
    ASSERT_TRUE(bench.run_to_step(1));
    auto& memory = bench.board.state.memory.bytes;
    for (std::size_t i = 0x8800; i < 0xFDFC; ++i) memory[i] = 0xE5;
    bench.send_frame(2, {});
    bench.drive(100, 5 * kStepT);
    ASSERT_TRUE(bench.run_to_step(20));
    for (std::size_t i = 0x8800; i < 0xFDFC; ++i) ASSERT_EQ(memory[i], 0xE5) << i;
    for (std::size_t i = 0xFDFC; i < 0xFE00; ++i) EXPECT_EQ(memory[i], 0xB7) << i;
}

}  // namespace
