// bounds_test.cpp - a storm of interrupts against the bounds from the image's code.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <random>

#include "hal/board/rb85.hpp"
#include "tests/system/image/image_bench.hpp"
#include "tools/bounds/observed.hpp"

namespace {

namespace fs = std::filesystem;
using host_sim::Stimulus;
using image_test::ImageBench;
using image_test::kCharacterT;
using image_test::kStepT;

constexpr uint32_t kStackEnd = 0xFF00;

/// The rover's program with its flow, from the build.
class Flow {
public:
    [[nodiscard]] const rover_bounds::FlowProgram& program() const { return program_; }

private:
    static fs::path beside(const char* ending) {
        return fs::path(ROVER_IMAGE).replace_extension(ending);
    }
    const fs::path table_ = fs::path(ROVER_SOURCE_DIR) / "tests/budgets/flow.csv";
    host_sim::Image image_ = host_sim::load_hex(ROVER_IMAGE);
    host_sim::Symbols symbols_ = host_sim::load_symbols(beside(".sym"));
    rover_bounds::FlowProgram program_{
        image_, symbols_, rover_budget::parse_map(host_sim::read_image_file(beside(".map")), "map"),
        rover_bounds::parse_flow(host_sim::read_image_file(table_), table_.string())};
};

// Characters without a pause, wheels at 255 pulses in 50 ms, and a TRAP in every step.
TEST(Bounds, HoldInAStorm) {
    const Flow flow;
    const rover_bounds::Bounds bounds =
        rover_bounds::find_bounds(flow.program(), {hal::rb85::kTickCount, kCharacterT, kStepT});
    rover_bounds::Observer observer(flow.program(), bounds, kStackEnd);
    ImageBench bench;
    ASSERT_TRUE(bench.run_to_step(2));
    std::mt19937 random(85);
    host_sim::StepRecord record;
    constexpr unsigned kSteps = 100;
    for (unsigned step = 0; step < kSteps; ++step) {
        const uint64_t begin = bench.now();
        std::vector<uint8_t> bytes(kStepT / kCharacterT);
        for (uint8_t& byte : bytes) byte = static_cast<uint8_t>(random());
        bench.send(bytes);
        bench.drive(500, kStepT);
        const uint64_t at = begin + random() % kStepT;
        bench.board.schedule({.t = at, .kind = Stimulus::Kind::bumper, .value = 1});
        bench.board.schedule({.t = at + 2000, .kind = Stimulus::Kind::bumper, .value = 0});
        while (bench.now() < begin + kStepT) {
            bench.board.step(record, begin + kStepT);
            observer.observe(record, bench.board.state.cpu);
        }
    }
    const rover_bounds::Observed& seen = observer.observed();
    EXPECT_THAT(seen.violations, testing::IsEmpty());
    EXPECT_GT(seen.steps, kSteps - 5);
    for (const char* name : {"TRAP", "RST 7.5", "RST 6.5", "RST 5.5"}) {
        EXPECT_TRUE(seen.handler_t.contains(name)) << name;
    }
}

}  // namespace
