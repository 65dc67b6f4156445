// The slip-and-sinkage firmware on the 8085 and on the host: the same bits in every command and in
// the whole state, step by step, over random drives with faults, moves by hand and noise.
// ROVER_TARGET_SEED and ROVER_TARGET_CYCLES (slip-and-sinkage cycles) change what is tried,
// ROVER_TARGET_FULL=1 tries every level on images.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <ctime>
#include <string>
#include <vector>

#include "tests/target/controller_comparison.hpp"

namespace target_test {
namespace {

constexpr uint64_t kShortCycles = kSlowBuild ? 50 : 500;
constexpr uint64_t kLongCycles = kSlowBuild ? 300 : 10'000;
constexpr double kCompileSeconds = 10;

uint64_t number_from(const char* variable, uint64_t otherwise) {
    const char* text = std::getenv(variable);
    return text == nullptr ? otherwise : std::strtoull(text, nullptr, 10);
}

// What the image does instead of copying the initial value from ROM.
TEST(SetInitialValues, TurnsZeroBytesIntoAFreshController) {
    alignas(rover::Controller) std::array<unsigned char, sizeof(rover::Controller)> bytes = {};
    auto* controller = reinterpret_cast<rover::Controller*>(bytes.data());
    rover::set_initial_values(*controller);
    rover::use_calibration(*controller, hal::Calibration{}, true);
    EXPECT_EQ(record_of(*controller).bytes(), record_of(rover::Controller{}).bytes());
}

class ControllerMir : public testing::TestWithParam<Level> {};

TEST_P(ControllerMir, GivesTheHostsBits) {
    const auto module = toolchain::driver::compile_to_mir(firmware_request(GetParam()));
    InterpretedMailbox target(module);
    const uint64_t seed = number_from("ROVER_TARGET_SEED", 1);
    const Comparison result = compare(target, seed, 300, [](bool) {});
    EXPECT_EQ(result.difference, "");
    EXPECT_GE(result.cycles, 300U);
}

/// Least, mean, most.
class Spread {
public:
    void add(uint64_t value) {
        least_ = count_ == 0 ? value : std::min(least_, value);
        most_ = std::max(most_, value);
        sum_ += value;
        ++count_;
    }
    [[nodiscard]] std::string text() const {
        return fmt::format("{} / {} / {} of {}", least_, count_ == 0 ? 0 : sum_ / count_, most_,
                           count_);
    }

private:
    uint64_t least_ = 0;
    uint64_t most_ = 0;
    uint64_t sum_ = 0;
    uint64_t count_ = 0;
};

void print_sizes(const toolchain::driver::Result& result, double seconds) {
    const toolchain::assembly::Program& program = result.program;
    uint32_t rom = 0;
    for (const toolchain::assembly::PlacedSection& section : program.sections) {
        if (in_rom(section.section.kind)) rom += section.size;
    }
    fmt::print(
        "compiled in {:.2f} s of processor time without clang; ROM {} + {} data bytes, RAM: frames "
        "{}, data {}, zero {}, "
        "stack {}\n",
        seconds, rom, program.data_image.size, program.frames.size, program.data.size,
        program.zero.size, result.compiled.stack_bytes);
    for (const toolchain::driver::PhaseTime& phase : result.times) {
        fmt::print("  {} {:.3f} s\n", phase.name, phase.seconds);
    }
}

/// The firmware at that level against the host for so many slip-and-sinkage cycles.
Comparison compare_image(const Level& level, uint64_t cycles) {
    const std::clock_t begin = std::clock();
    const toolchain::driver::Result compiled =
        toolchain::driver::compile_program(firmware_request(level));
    // Processor time of all but clang: other tests run beside this one.
    const double seconds = static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
    print_sizes(compiled, seconds);
    ImageMailbox target(compiled.program, level.undocumented
                                              ? host_sim::InstructionSet::all
                                              : host_sim::InstructionSet::documented);
    Spread with_cycle;
    Spread without;
    const uint64_t seed = number_from("ROVER_TARGET_SEED", 1);
    const Comparison result = compare(target, seed, cycles, [&](bool cycle) {
        (cycle ? with_cycle : without).add(target.step_t());
    });
    fmt::print("seed {}: {} steps with {} slip-and-sinkage cycles\n", seed, result.steps,
               result.cycles);
    fmt::print("T-states (least / mean / most): steps with a cycle {}, others {}\n",
               with_cycle.text(), without.text());
    EXPECT_TRUE(target.machine().rom_is_intact());
    EXPECT_LE(target.machine().stack_used(), compiled.compiled.stack_bytes);
    if (!kSlowBuild) {
        EXPECT_LE(seconds, kCompileSeconds);
    }
    return result;
}

class ControllerImage : public testing::TestWithParam<Level> {};

TEST_P(ControllerImage, GivesTheHostsBits) {
    const Comparison result = compare_image(GetParam(), kShortCycles);
    EXPECT_EQ(result.difference, "");
    EXPECT_GE(result.cycles, kShortCycles);
}

// The acceptance run. Every mode, event and fault has to come up in it.
TEST(ControllerImageLong, TenThousandCyclesGiveTheHostsBits) {
    const uint64_t cycles = number_from("ROVER_TARGET_CYCLES", kLongCycles);
    const Comparison result = compare_image(kLevels[3], cycles);
    EXPECT_EQ(result.difference, "");
    EXPECT_GE(result.cycles, cycles);
    if (cycles < 10'000) return;
    for (std::size_t i = 0; i < result.reached.modes.size(); ++i) {
        EXPECT_GT(result.reached.modes[i], 0U) << "mode " << i;
    }
    for (std::size_t i = 0; i < 8; ++i) {
        const bool exists = 1U << i <= rover::kEventOverspeed;
        EXPECT_EQ(result.reached.events[i] > 0, exists) << "event " << i;
        EXPECT_GT(result.reached.faults[i], 0U) << "fault " << i;
    }
}

/// -Os has the long run; -O1 and -O2 take as long to compile.
std::vector<Level> image_levels() {
    if (std::getenv("ROVER_TARGET_FULL") != nullptr) return {kSettings.begin(), kSettings.end()};
    return {kSettings.front(), kSettings.back()};
}

INSTANTIATE_TEST_SUITE_P(Levels, ControllerMir, testing::ValuesIn(kLevels),
                         [](const auto& test) { return test.param.name; });
INSTANTIATE_TEST_SUITE_P(Levels, ControllerImage, testing::ValuesIn(image_levels()),
                         [](const auto& test) { return test.param.name; });

}  // namespace
}  // namespace target_test
