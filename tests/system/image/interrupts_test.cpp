// interrupts_test.cpp - latency and load of the interrupts, and storms of them.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <map>
#include <random>

#include "tests/system/image/image_bench.hpp"

namespace {

using host_sim::Stimulus;
using image_test::ImageBench;
using image_test::kCharacterT;
using image_test::kSecondT;
using image_test::kStepT;

constexpr std::uint16_t kTrap = 0x24, kRst55 = 0x2C, kRst65 = 0x34, kRst75 = 0x3C;
constexpr std::array<std::uint8_t, 5> kServoChannels = {5, 6, 7, 8, 10};

/// Follows a running board instruction by instruction.
class Watch {
public:
    explicit Watch(ImageBench& bench) : bench_(bench) {}

    std::map<std::uint16_t, std::uint64_t> worst_latency;  ///< by vector
    std::map<std::uint16_t, std::uint64_t> count;
    std::uint64_t interrupt_t = 0;  ///< T-states in handlers
    std::uint64_t total_t = 0;
    std::map<std::uint16_t, std::uint64_t> worst_duration;

    /// Up to an address, or for `t` T-states.
    void run(std::uint64_t t, std::uint32_t stop_at = ~0U) {
        const std::uint64_t end = bench_.now() + t;
        host_sim::StepRecord record;
        while (bench_.now() < end && bench_.board.state.cpu.pc != stop_at) {
            const auto& cpu = bench_.board.state.cpu;
            follow_requests(cpu);
            const std::uint64_t before = cpu.t;
            const std::uint16_t sp = cpu.sp;
            bench_.board.step(record, end);
            using Kind = host_sim::StepRecord::Kind;
            if (record.kind != Kind::instruction && record.kind != Kind::halt) {
                enter(cpu.pc, cpu.t, sp);
            }
            if (!open_.empty()) interrupt_t += cpu.t - before;
            total_t += cpu.t - before;
            while (!open_.empty() && cpu.sp >= open_.back().sp) {
                auto& worst = worst_duration[open_.back().vector];
                worst = std::max(worst, cpu.t - open_.back().since);
                open_.pop_back();
            }
        }
    }

private:
    struct Open {
        std::uint16_t vector;
        std::uint16_t sp;
        std::uint64_t since;
    };

    /// Since when each line has asked for an interrupt that is not masked.
    void follow_requests(const host_sim::CpuState& cpu) {
        using host_sim::Pin;
        const auto ask = [&](std::uint16_t vector, bool asks, std::uint64_t since) {
            if (!asks) {
                asking_.erase(vector);
            } else if (!asking_.contains(vector)) {
                asking_[vector] = since;
            }
        };
        const auto level = [&](Pin pin) { return cpu.pin(pin).level; };
        ask(kRst75, cpu.rst75_latch && (cpu.masks & 4) == 0, cpu.rst75_latched_t);
        // A line that was masked asks from now on.
        ask(kRst65, level(Pin::rst65) && (cpu.masks & 2) == 0,
            std::max(cpu.pin(Pin::rst65).changed_t, last_t_));
        ask(kRst55, level(Pin::rst55) && (cpu.masks & 1) == 0,
            std::max(cpu.pin(Pin::rst55).changed_t, last_t_));
        last_t_ = cpu.t;
    }
    void enter(std::uint16_t vector, std::uint64_t t, std::uint16_t sp) {
        ++count[vector];
        open_.push_back({vector, sp, t});
        if (!asking_.contains(vector)) return;
        worst_latency[vector] = std::max(worst_latency[vector], t - asking_[vector]);
        asking_.erase(vector);
    }

    ImageBench& bench_;
    std::map<std::uint16_t, std::uint64_t> asking_;
    std::vector<Open> open_;
    std::uint64_t last_t_ = 0;
};

/// Puts so many bytes more into the transmit ring: 256 of them, low byte of the consumer's pointer,
/// its high byte, the producer's index.
void fill_to(ImageBench& bench, unsigned bytes) {
    const std::uint16_t ring = bench.address("to_send");
    auto& memory = bench.board.state.memory.bytes;
    const unsigned queued = static_cast<std::uint8_t>(memory[ring + 258U] - memory[ring + 256U]);
    memory[ring + 258U] =
        static_cast<std::uint8_t>(memory[ring + 256U] + std::min(queued + bytes, 250U));
}

/// @param count  of all potentiometers; straight ahead, 2048, is wanted
void load_at_full_telemetry(const char* servos, std::uint16_t count) {
    SCOPED_TRACE(servos);
    ImageBench bench;
    for (const std::uint8_t channel : kServoChannels) bench.sensor(channel, count);
    ASSERT_TRUE(bench.run_to_step(2));
    Watch watch(bench);
    const std::uint64_t start = bench.now();
    const std::uint16_t place = bench.address("rover_link");
    for (int step = 0; step < 20; ++step) {
        // Behind the controller's 50 bytes 110 more: the largest frame, in every step.
        watch.run(2 * kStepT, place);
        fill_to(bench, hal::kTelemetryBytesMax - 50);
        bench.drive(15, kStepT * 9 / 10);  // 3 cm/s
        watch.run(1000);
    }
    EXPECT_NEAR(static_cast<double>(bench.now() - start), 20.0 * kStepT, 0.9 * kStepT);
    const double load =
        100.0 * static_cast<double>(watch.interrupt_t) / static_cast<double>(watch.total_t);
    std::printf("servos %s: ", servos);
    std::printf("load %.1f %%; worst latency 5.5 %d, 6.5 %d, 7.5 %d T; duration 5.5 %d, 7.5 %d T\n",
                load, static_cast<int>(watch.worst_latency[kRst55]),
                static_cast<int>(watch.worst_latency[kRst65]),
                static_cast<int>(watch.worst_latency[kRst75]),
                static_cast<int>(watch.worst_duration[kRst55]),
                static_cast<int>(watch.worst_duration[kRst75]));
    EXPECT_GE(watch.count[kRst55], 20u * 150);
    EXPECT_LE(load, 15.0);
    EXPECT_LE(watch.worst_duration[kRst75], 8000u);
    for (const auto& [vector, worst] : watch.worst_latency) EXPECT_LE(worst, 400u) << vector;
}

TEST(ImageInterrupts, LatencyAndLoadAtFullTelemetry) {
    load_at_full_telemetry("at rest", 2048);
    load_at_full_telemetry("turning left", 1000);
    load_at_full_telemetry("turning right", 3000);
}

// Every source at once, at random: characters in bursts at line rate, TRAPs, wheels.
TEST(ImageInterrupts, LatencyInAStorm) {
    const unsigned seed = 19;
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    ImageBench bench;
    for (const std::uint8_t channel : kServoChannels) bench.sensor(channel, 1000);
    ASSERT_TRUE(bench.run_to_step(2));
    Watch watch(bench);
    for (int step = 0; step < 20; ++step) {
        fill_to(bench, 200);
        std::vector<std::uint8_t> bytes(150);
        for (std::uint8_t& byte : bytes) byte = static_cast<std::uint8_t>(random());
        bench.send(bytes);
        bench.drive(200, kStepT);
        watch.run(kStepT);
    }
    std::printf(
        "storm: load %.1f %%; worst latency 5.5 %d, 6.5 %d, 7.5 %d T; duration 5.5 %d, "
        "6.5 %d, 7.5 %d T\n",
        100.0 * static_cast<double>(watch.interrupt_t) / static_cast<double>(watch.total_t),
        static_cast<int>(watch.worst_latency[kRst55]),
        static_cast<int>(watch.worst_latency[kRst65]),
        static_cast<int>(watch.worst_latency[kRst75]),
        static_cast<int>(watch.worst_duration[kRst55]),
        static_cast<int>(watch.worst_duration[kRst65]),
        static_cast<int>(watch.worst_duration[kRst75]));
    EXPECT_EQ(bench.board.state.usart.overrun_count, 0u);
    for (const auto& [vector, worst] : watch.worst_latency) EXPECT_LE(worst, 400u) << vector;
}

// A character that ends the sleep just before the step's tick: whatever instruction of the main
// line's look at the clock the tick meets, the step begins.
TEST(ImageInterrupts, NoTickIsSleptOver) {
    ImageBench start;
    ASSERT_TRUE(start.run_to_step(4));
    const auto snapshot = start.board.state;
    const std::uint16_t due = 40;
    while (start.ticks() < due) start.run(4);
    const std::uint64_t tick_t = start.now();
    for (std::uint64_t before = 0; before < 700; before += 2) {
        ImageBench bench;
        bench.board.state = snapshot;
        bench.board.schedule({.t = tick_t - kCharacterT - before,
                              .kind = Stimulus::Kind::serial_byte,
                              .value = 0x55});
        bench.run(tick_t + 2000 - bench.now());
        ASSERT_TRUE(bench.run_to("rover_control")) << before;
        ASSERT_LT(bench.now() - tick_t, 30'000u) << before;
        ASSERT_EQ(bench.fault_register() & rover::kFaultStepLate, 0) << before;
    }
}

TEST(ImageInterrupts, AfterAStormTheCountersAddUp) {
    for (unsigned seed = 1; seed <= 3; ++seed) {
        SCOPED_TRACE(seed);
        std::mt19937 random(seed);
        ImageBench bench;
        ASSERT_TRUE(bench.run_to_step(1));
        std::uint64_t sent = 0;
        std::uint64_t frames_seen = 0;
        std::uint64_t answers = 0;
        const std::uint16_t first_step = bench.steps();
        const std::uint64_t end = bench.now() + 10'000'000;
        while (bench.now() < end) {
            std::vector<std::uint8_t> bytes(random() % 120);
            for (std::uint8_t& byte : bytes) {
                byte = static_cast<std::uint8_t>(random() % 3 == 0 ? 0xC5 : random());
            }
            bench.send(bytes);
            sent += bytes.size();
            for (int i = 0; i < 3; ++i) {
                const auto kind =
                    random() % 2 == 0 ? Stimulus::Kind::bumper : Stimulus::Kind::undervoltage;
                const std::uint64_t at = bench.now() + random() % kStepT;
                bench.board.schedule({.t = at, .kind = kind, .value = 1});
                bench.board.schedule({.t = at + 1 + random() % 3000, .kind = kind, .value = 0});
            }
            bench.drive(static_cast<unsigned>(random() % 300), kStepT);
            bench.run(std::max<std::uint64_t>(bytes.size() * kCharacterT, random() % kStepT) + 1);
            for (const auto& frame : bench.frames()) ++(frame.kind == 1 ? frames_seen : answers);
        }
        bench.run(kStepT);
        const std::uint16_t steps = bench.steps();
        const auto& memory = bench.board.state.memory.bytes;
        const std::uint16_t ring = bench.address("received");
        const auto status = [&] {
            bench.run(10 * kStepT);  // lets the rings run empty
            for (const auto& frame : bench.frames()) ++(frame.kind == 1 ? frames_seen : answers);
            return bench.ask_status();
        }();
        ASSERT_TRUE(status);
        EXPECT_EQ(static_cast<std::uint16_t>(status->received + status->receive_errors),
                  static_cast<std::uint16_t>(sent + 6));
        EXPECT_EQ(status->receive_errors, 0);
        EXPECT_EQ(bench.board.state.usart.overrun_count, 0u);
        EXPECT_EQ(bench.board.state.usart.overwritten_count, 0u);
        EXPECT_EQ(memory[ring], memory[ring + 1U]);
        EXPECT_EQ(bench.stray_bytes(), 0u);
        EXPECT_EQ(status->late_steps, 0);
        EXPECT_GT(status->trap_count, 0);
        EXPECT_GE(bench.ticks(), 10 * (steps - 1));
        // Every step's telemetry came out whole, or was counted.
        EXPECT_GE(frames_seen + status->frames_dropped, std::uint64_t{steps} - first_step);
        std::printf(
            "seed %u: %d bytes sent, %d dropped; %d telemetry frames, %d others, %d frames "
            "dropped; %d TRAPs\n",
            seed, static_cast<int>(sent), status->receive_dropped, static_cast<int>(frames_seen),
            static_cast<int>(answers), status->frames_dropped, status->trap_count);
    }
}

}  // namespace
