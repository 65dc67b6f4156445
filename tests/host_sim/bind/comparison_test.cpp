// comparison_test.cpp - differences are found and named by their field.
#include "host_sim/bind/comparison.hpp"

#include <gtest/gtest.h>

#include "firmware/link/telemetry.hpp"

namespace {

using host_sim::compare_outputs;
using host_sim::Log;

Log log_of(std::size_t steps) {
    Log log;
    for (std::size_t i = 0; i < steps; ++i) {
        host_sim::LogStep& step = log.steps.emplace_back();
        step.time_ms = static_cast<uint32_t>(100 * i);
        rover::Estimates estimates;
        estimates.step_count = static_cast<uint16_t>(i);
        hal::Commands& commands = step.commands.emplace();
        commands.telemetry_size = rover::write_telemetry(estimates, commands.telemetry);
    }
    return log;
}

TEST(CompareOutputs, TheSameIsIdenticalAndCounted) {
    const auto result = compare_outputs(log_of(7), log_of(7));
    EXPECT_FALSE(result.divergence.has_value());
    EXPECT_EQ(result.steps, 7u);
    EXPECT_EQ(result.frames, 7u);
    EXPECT_EQ(result.bytes, 350u);
    EXPECT_EQ(compare_outputs({}, {}).steps, 0u);
}

// Every field of the frame that the firmware writes, changed by itself, is named.
TEST(CompareOutputs, EveryTelemetryFieldIsNamed) {
    struct Case {
        const char* name;
        void (*change)(rover::Estimates&);
    };
    const Case cases[] = {
        {"step_count", [](rover::Estimates& e) { e.step_count = 9; }},
        {"tick_count", [](rover::Estimates& e) { e.tick_count = 0x100; }},
        {"available", [](rover::Estimates& e) { e.available = 1; }},
        {"events", [](rover::Estimates& e) { e.events = 1; }},
        {"faults", [](rover::Estimates& e) { e.faults = 0x100; }},
        {"mode", [](rover::Estimates& e) { e.mode = rover::SlipMode::moved; }},
        {"cycle_count", [](rover::Estimates& e) { e.cycle_count = 0x100; }},
        {"position_q4_mm", [](rover::Estimates& e) { e.position_q4_mm = 1 << 24; }},
        {"odometer_q4_mm", [](rover::Estimates& e) { e.odometer_q4_mm = 1 << 16; }},
        {"position_sigma_q4_mm", [](rover::Estimates& e) { e.position_sigma_q4_mm = 1; }},
        {"advance_q4_mm", [](rover::Estimates& e) { e.advance_q4_mm = 1; }},
        {"slip_percent", [](rover::Estimates& e) { e.slip_percent = -1; }},
        {"match_cost_q4", [](rover::Estimates& e) { e.match_cost_q4 = 1; }},
        {"sinkage_q4_mm", [](rover::Estimates& e) { e.sinkage_q4_mm = 1; }},
        {"pitch_brad", [](rover::Estimates& e) { e.pitch_brad = 1; }},
        {"roll_brad", [](rover::Estimates& e) { e.roll_brad = 0x100; }},
        {"rocker_brad", [](rover::Estimates& e) { e.rocker_brad = 1; }},
        {"bogie_brad", [](rover::Estimates& e) { e.bogie_brad = 1; }},
        {"height_middle_q4_mm", [](rover::Estimates& e) { e.height_middle_q4_mm = 1; }},
        {"height_front_q4_mm", [](rover::Estimates& e) { e.height_front_q4_mm = 1; }},
        {"height_ahead_q4_mm[0]", [](rover::Estimates& e) { e.height_ahead_q4_mm[0] = 0x100; }},
        {"height_ahead_q4_mm[1]", [](rover::Estimates& e) { e.height_ahead_q4_mm[1] = 0x100; }},
    };
    for (const Case& field : cases) {
        const Log first = log_of(3);
        Log second = first;
        rover::Estimates estimates;
        estimates.step_count = 1;
        field.change(estimates);
        rover::write_telemetry(estimates, second.steps[1].commands->telemetry);
        const auto result = compare_outputs(first, second);
        ASSERT_TRUE(result.divergence.has_value()) << field.name;
        EXPECT_EQ(
            result.divergence->signal.find(std::string("telemetry ") + field.name + " (byte "), 0u)
            << result.divergence->signal;
        EXPECT_EQ(result.divergence->step, 1u);
        EXPECT_EQ(result.divergence->time_ms, 100u);
        EXPECT_EQ(result.frames, 1u);
    }
}

TEST(CompareOutputs, ValuesAreGivenAsNumberAndBytes) {
    const Log first = log_of(1);
    Log second = first;
    rover::Estimates estimates;
    estimates.odometer_q4_mm = -2;
    rover::write_telemetry(estimates, second.steps[0].commands->telemetry);
    const auto result = compare_outputs(first, second);
    EXPECT_EQ(result.divergence->signal, "telemetry odometer_q4_mm (byte 19)");
    EXPECT_EQ(result.divergence->first, "0 (00 00 00 00)");
    EXPECT_EQ(result.divergence->second, "-2 (FE FF FF FF)");
}

TEST(CompareOutputs, MotorsLasersFramesAndMissingStepsAreNamed) {
    const auto signal = [](auto change) {
        const Log first = log_of(2);
        Log second = first;
        change(second);
        const auto result = compare_outputs(first, second);
        return result.divergence ? result.divergence->signal : std::string();
    };
    EXPECT_EQ(signal([](Log& log) { log.steps[1].commands->drive_percent[3] = 50; }),
              "drive motor 3");
    EXPECT_EQ(signal([](Log& log) { log.steps[1].commands->steer_brad[2] = 1; }),
              "steering motor 2");
    EXPECT_EQ(signal([](Log& log) { log.steps[1].commands->mast_brad = 1; }), "mast motor");
    EXPECT_EQ(signal([](Log& log) { log.steps[1].commands->laser_bits = 1; }), "lasers");
    EXPECT_EQ(signal([](Log& log) { log.steps[1].commands->telemetry_size = 0; }),
              "telemetry frame");
    EXPECT_EQ(signal([](Log& log) { log.steps[1].commands.reset(); }), "commands");
    EXPECT_EQ(signal([](Log& log) { log.steps.pop_back(); }), "steps of the log");
    EXPECT_EQ(signal([](Log&) {}), "");
}

TEST(TelemetryFieldAt, CoversTheWholeFrameWithoutGap) {
    std::size_t at = 0;
    while (at < rover::kTelemetrySize) {
        const auto field = host_sim::telemetry_field_at(at);
        ASSERT_EQ(field.offset, at);
        for (std::size_t i = 0; i < field.size; ++i) {
            EXPECT_EQ(host_sim::telemetry_field_at(at + i).name, field.name);
        }
        at += field.size;
    }
    EXPECT_EQ(at, std::size_t{rover::kTelemetrySize});
    EXPECT_EQ(host_sim::telemetry_field_at(at).name, "behind the frame");
}

}  // namespace
