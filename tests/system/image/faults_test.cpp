// faults_test.cpp - what the image does when ROM, RAM, stack, supply, converter or itself fails.
#include <gtest/gtest.h>

#include "firmware/executive/estimates.hpp"
#include "tests/system/image/image_bench.hpp"

namespace {

using host_sim::Stimulus;
using image_test::ImageBench;
using image_test::kSecondT;
using image_test::kStepT;

constexpr unsigned kFreshFaults = rover::kFaultNoRecord | rover::kFaultNoCheckpoint;

bool motors_are_off(const ImageBench& bench) {
    for (unsigned motor = 0; motor < 10; ++motor) {
        if (bench.board.state.motors.duty(motor) != 0) return false;
    }
    return true;
}

/// A loop in unused RAM that does nothing: where a program may end up that has lost its way.
void lose_the_way(ImageBench& bench, bool interrupts) {
    auto& memory = bench.board.state.memory.bytes;
    memory[0xA000] = 0xC3;  // JMP A000
    memory[0xA001] = 0x00;
    memory[0xA002] = 0xA0;
    bench.board.state.cpu.pc = 0xA000;
    bench.board.state.cpu.interrupt_enable = interrupts;
}

TEST(ImageFaults, TheWatchdogResetsAHungImageAndTheDriveGoesOn) {
    ImageBench bench;
    ASSERT_TRUE(bench.run_to_step(12));
    ASSERT_TRUE(bench.run_to("rover_wait"));
    EXPECT_FALSE(motors_are_off(bench));
    const auto before = bench.checkpoint();
    lose_the_way(bench, true);
    bench.run(kSecondT * 45 / 100);
    EXPECT_EQ(bench.board.state.reset_count, 1u);
    bench.run(kSecondT / 10);
    EXPECT_EQ(bench.board.state.reset_count, 2u);
    EXPECT_TRUE(motors_are_off(bench));
    ASSERT_TRUE(bench.run_to_step(2));
    const auto status = bench.ask_status();
    ASSERT_TRUE(status);
    EXPECT_EQ(status->reset_cause, rover::ResetCause::watchdog);
    EXPECT_EQ(status->warm, 1);
    EXPECT_EQ(status->reset_count, 2);
    EXPECT_EQ(status->last_faults, kFreshFaults);
    EXPECT_EQ(status->faults, rover::kFaultNoRecord);
    EXPECT_EQ(bench.checkpoint()->record.odometer_q4_mm, before->record.odometer_q4_mm);
    EXPECT_FALSE(motors_are_off(bench));
}

TEST(ImageFaults, AHangWithInterruptsDisabledEndsInAResetToo) {
    ImageBench bench;
    ASSERT_TRUE(bench.run_to_step(5));
    lose_the_way(bench, false);
    bench.run(kSecondT * 6 / 10);
    EXPECT_EQ(bench.board.state.reset_count, 2u);
    ASSERT_TRUE(bench.run_to_step(1));
    const auto status = bench.ask_status();
    ASSERT_TRUE(status);
    EXPECT_EQ(status->reset_cause, rover::ResetCause::other);
    EXPECT_EQ(status->warm, 1);
}

TEST(ImageFaults, ThePowerUpAndTheButtonAreToldApart) {
    ImageBench bench;
    ASSERT_TRUE(bench.run_to_step(5));
    bench.reset();
    ASSERT_TRUE(bench.run_to_step(1));
    EXPECT_EQ(bench.ask_status()->reset_cause, rover::ResetCause::other);
    bench.board.power_cycle();
    bench.run(100'000);
    ASSERT_TRUE(bench.run_to_step(1));
    const auto status = bench.ask_status();
    ASSERT_TRUE(status);
    EXPECT_EQ(status->reset_cause, rover::ResetCause::power_up);
    EXPECT_EQ(status->warm, 1);
    EXPECT_EQ(status->reset_count, 3);
}

TEST(ImageFaults, EveryKindOfRomDamageKeepsTheDrivesOff) {
    const auto& rom = image_test::program().rom;
    const std::size_t spare = image_test::program().identity;
    for (const std::size_t place : {spare + 12, spare + 16, spare + 18, spare + 20, spare + 27}) {
        for (const unsigned bit : {0U, 7U}) {
            ImageBench bench;
            const auto bad = static_cast<std::uint8_t>(rom[place] ^ 1U << bit);
            bench.board.program(std::array{bad}, static_cast<std::uint16_t>(place));
            ASSERT_TRUE(bench.run_to_step(3)) << place;
            const auto status = bench.ask_status();
            ASSERT_TRUE(status) << place;
            EXPECT_EQ(status->faults, kFreshFaults | rover::kFaultRom) << place;
            EXPECT_TRUE(motors_are_off(bench));
        }
    }
}

/// Runs to step 1 with a bit of RAM that is always 1, seen by reads between instructions.
bool runs_with_a_stuck_bit(ImageBench& bench, std::uint16_t address, std::uint8_t bit) {
    host_sim::StepRecord record;
    const std::uint64_t limit = bench.now() + 10 * kSecondT;
    while (bench.steps() != 1 && bench.now() < limit) {  // the RAM test makes other values of it
        bench.board.step(record, limit);
        auto& cell = bench.board.state.memory.bytes[address];
        cell = static_cast<std::uint8_t>(cell | bit);
    }
    return bench.steps() == 1;
}

TEST(ImageFaults, AStuckBitInRamKeepsTheDrivesOff) {
    // Of memory that nothing uses, so that the image still works: below, between and in the middle
    // of the stack's page.
    for (const std::uint16_t address :
         {std::uint16_t{0x8700}, std::uint16_t{0xB123}, std::uint16_t{0xFD00}}) {
        for (const std::uint8_t bit : {std::uint8_t{0x01}, std::uint8_t{0x80}}) {
            ImageBench bench;
            ASSERT_TRUE(runs_with_a_stuck_bit(bench, address, bit)) << address;
            EXPECT_EQ(bench.fault_register(), kFreshFaults | rover::kFaultRam) << address;
            EXPECT_TRUE(motors_are_off(bench));
            ASSERT_TRUE(bench.ask_status()) << address;
            EXPECT_TRUE(motors_are_off(bench));
        }
    }
}

TEST(ImageFaults, AWarmStartTestsTheRamThatIsInUse) {
    for (const bool in_use : {true, false}) {
        ImageBench bench;
        ASSERT_TRUE(bench.run_to_step(3));
        bench.reset();
        ASSERT_TRUE(runs_with_a_stuck_bit(bench, in_use ? 0x8700 : 0xB123, 0x10));
        EXPECT_EQ((bench.fault_register() & rover::kFaultRam) != 0, in_use);
    }
}

TEST(ImageFaults, AnOverwrittenStackGuardStopsTheDrives) {
    ImageBench bench;
    ASSERT_TRUE(bench.run_to_step(3));
    EXPECT_FALSE(motors_are_off(bench));
    bench.board.state.memory.bytes[0xFDFF] ^= 0x01;
    ASSERT_TRUE(bench.run_to_step(5));
    EXPECT_EQ(bench.fault_register(), kFreshFaults | rover::kFaultStack);
    EXPECT_TRUE(motors_are_off(bench));
}

TEST(ImageFaults, ATrapTurnsTheMotorsOffAtOnceAndForGood) {
    for (const bool undervoltage : {true, false}) {
        ImageBench bench;
        ASSERT_TRUE(bench.run_to_step(3));
        bench.run(kStepT / 2);
        const auto kind = undervoltage ? Stimulus::Kind::undervoltage : Stimulus::Kind::bumper;
        bench.board.schedule({.t = bench.now() + 1, .kind = kind, .value = 1});
        const std::uint64_t start = bench.now();
        host_sim::StepRecord record;
        while (!motors_are_off(bench) && bench.now() < start + 10'000) bench.board.step(record);
        EXPECT_LE(bench.now() - start, 400u);
        std::printf("motors off %d T behind TRAP\n", static_cast<int>(bench.now() - start));
        bench.board.schedule({.t = bench.now() + 3000, .kind = kind, .value = 0});
        for (int i = 0; i < 50; ++i) {
            bench.run(kStepT / 5 + 77);
            EXPECT_TRUE(motors_are_off(bench));
        }
        const auto status = bench.ask_status();
        ASSERT_TRUE(status);
        EXPECT_EQ(status->faults, kFreshFaults | (undervoltage ? 0x100U : 0x200U));
        EXPECT_EQ(status->trap_count, 1);
        bench.reset();
        ASSERT_TRUE(bench.run_to_step(1));
        EXPECT_FALSE(motors_are_off(bench));
    }
}

TEST(ImageFaults, ATrapAtAnyInstructionOfTheMotorWritesLeavesThemOff) {
    ImageBench start;
    ASSERT_TRUE(start.run_to_step(3));
    ASSERT_TRUE(start.run_to("rover_apply"));
    const auto snapshot = start.board.state;
    for (std::uint64_t t = 1; t < 1500; t += 3) {
        ImageBench bench;
        bench.board.state = snapshot;
        bench.board.schedule({.t = snapshot.cpu.t + t, .kind = Stimulus::Kind::bumper, .value = 1});
        bench.run(4000);
        ASSERT_TRUE(motors_are_off(bench)) << t;
        ASSERT_EQ(bench.fault_register() & 0x200, 0x200) << t;
    }
}

TEST(ImageFaults, UndervoltageAtBootKeepsTheDrivesOff) {
    ImageBench bench;
    bench.board.schedule({.t = 0, .kind = Stimulus::Kind::undervoltage, .value = 1});
    ASSERT_TRUE(bench.run_to_step(2));
    EXPECT_EQ(bench.fault_register() & 0x100, 0x100);
    EXPECT_TRUE(motors_are_off(bench));
}

TEST(ImageFaults, ALateStepIsCountedAndSaid) {
    ImageBench bench;
    ASSERT_TRUE(bench.run_to_step(3));
    ASSERT_TRUE(bench.run_to("rover_wait"));
    // The tick jumps ahead: as if the main line had been held up for 23 ticks.
    const std::uint16_t tick = bench.address("rover_tick_count");
    const auto ticks = static_cast<std::uint16_t>(bench.ticks() / 10 * 10 + 33);
    bench.board.state.memory.bytes[tick] = static_cast<std::uint8_t>(ticks & 0xFF);
    bench.board.state.memory.bytes[tick + 1U] = static_cast<std::uint8_t>(ticks >> 8);
    bench.frames();
    ASSERT_TRUE(bench.run_to_step(5));
    const auto status = bench.ask_status();
    ASSERT_TRUE(status);
    EXPECT_EQ(status->late_steps, 1);
    EXPECT_EQ(status->missed_steps, 2);
    EXPECT_EQ(status->faults, kFreshFaults | rover::kFaultStepLate);
    // The steps behind it are at multiples of ten ticks again.
    EXPECT_TRUE(bench.run_to_step(static_cast<std::uint16_t>(bench.steps() + 2)));
    bench.run(kStepT / 2);
    const auto frames = bench.frames();
    ASSERT_FALSE(frames.empty());
    EXPECT_EQ((frames.back().payload[2] | frames.back().payload[3] << 8) % 10, 0);
}

TEST(ImageFaults, AConverterWithoutAnEndCostsItsChannelsAndNoMoreTimeThanItsBound) {
    ImageBench bench;
    ASSERT_TRUE(bench.run_to_step(2));
    bench.frames();
    for (std::uint8_t channel = 0; channel < 5; ++channel) {
        bench.board.replay_sensor(channel, hal::kAdcAbsent);
    }
    bench.run(4 * kStepT);
    const auto frames = bench.frames();
    ASSERT_GE(frames.size(), 3u);
    EXPECT_EQ(frames[1].payload[4] & rover::kAvailableLinkage, 0);
    EXPECT_NE(bench.fault_register() & rover::kFaultConverter, 0);
    EXPECT_EQ(bench.fault_register() & rover::kFaultStepLate, 0);
}

}  // namespace
