// board_targets_test.cpp - two targets, one answer: the flying image on the simulated board gives
// what the native controller gives, bit for bit: golden drives, random logs, closed loops.
// Needs   ROVER_IMAGE, the image that the build made.
#include <gtest/gtest.h>

#include <chrono>
#include <cstdio>
#include <ctime>

#include "host_sim/bind/board_target.hpp"
#include "host_sim/bind/comparison.hpp"
#include "host_sim/bind/host_target.hpp"
#include "host_sim/bind/random_log.hpp"
#include "host_sim/log/log_io.hpp"
#include "tests/system/golden_courses.hpp"
#include "tests/system/program.hpp"

namespace {

using host_sim::BoardTarget;
using host_sim::Log;
using system_test::GoldenCourse;

#if defined(NDEBUG) && !defined(__SANITIZE_ADDRESS__)
constexpr bool kFast = true;
#else
constexpr bool kFast = false;
#endif

/// One board for all tests of a process: it boots its image once.
BoardTarget& board() {
    static BoardTarget target{std::filesystem::path(ROVER_IMAGE)};
    return target;
}

std::string text(const host_sim::Comparison& result) {
    if (!result.divergence) return {};
    const host_sim::Divergence& found = *result.divergence;
    return "step " + std::to_string(found.step) + ": " + found.signal + ": host " + found.first +
           ", board " + found.second;
}

class GoldenBoard : public testing::TestWithParam<GoldenCourse> {};

TEST_P(GoldenBoard, TheImageGivesTheReviewedEstimatesAndTheHostsBytes) {
    const Log golden = host_sim::load_log(system_test::golden_file(GetParam()));
    Log on_board = golden, on_host = golden;
    host_sim::replay(board(), on_board);
    host_sim::replay_on_host(on_host);
    const host_sim::Comparison result = host_sim::compare_outputs(on_host, on_board);
    EXPECT_EQ(text(result), "");
    EXPECT_EQ(result.frames, golden.steps.size());
    EXPECT_EQ(result.bytes, 50 * golden.steps.size());
    EXPECT_EQ(board().counts().telemetry_frames, golden.steps.size());
    EXPECT_EQ(board().counts().stray_bytes, 0u);
    const bool own_ticks = GetParam().edit != system_test::Edit::tick_gaps;
    EXPECT_EQ(board().counts().ticks_written == 0, own_ticks) << "written only where they must be";
    system_test::drop_telemetry(on_board);
    EXPECT_EQ(system_test::first_difference(golden, on_board), "");
}

INSTANTIATE_TEST_SUITE_P(Courses, GoldenBoard, testing::ValuesIn(system_test::kGoldenCourses),
                         [](const auto& course) { return std::string(course.param.name); });

// Who observes sees every T-state and changes nothing.
TEST(BoardTargets, AnObservedRunEndsInTheSameState) {
    const Log golden = host_sim::load_log(system_test::golden_file(system_test::kGoldenCourses[0]));
    BoardTarget plain{std::filesystem::path(ROVER_IMAGE)};
    BoardTarget observed{std::filesystem::path(ROVER_IMAGE)};
    std::uint64_t seen_t = 0, gaps = 0;
    observed.observe([&](const host_sim::StepRecord& step, const host_sim::CpuState& after) {
        gaps += step.t_begin != seen_t || after.t != step.t_end ? 1 : 0;
        seen_t = step.t_end;
    });
    Log first = golden, second = golden;
    host_sim::replay(plain, first);
    host_sim::replay(observed, second);
    EXPECT_EQ(text(host_sim::compare_outputs(first, second)), "");
    EXPECT_TRUE(plain.board().state == observed.board().state);
    EXPECT_EQ(seen_t, observed.board().state.cpu.t);
    EXPECT_EQ(gaps, 0u);
}

// Random drives, faults, calibrations, noise, resets, ticks that leap, rubbish on the link.
TEST(BoardTargets, RandomLogsAreBitIdentical) {
    constexpr std::uint64_t kFirstSeed = 1, kLogs = kFast ? 200 : 12;
    constexpr std::size_t kStepsMax = 60;
    std::size_t steps = 0, bytes = 0, restarts = 0;
    for (std::uint64_t seed = kFirstSeed; seed < kFirstSeed + kLogs; ++seed) {
        const Log on_host = host_sim::random_log(seed, kStepsMax);
        Log on_board = on_host;
        host_sim::replay(board(), on_board);
        const host_sim::Comparison result = host_sim::compare_outputs(on_host, on_board);
        ASSERT_EQ(text(result), "") << "seed " << seed << ": rover85 compare --random 1 --seed "
                                    << seed << " --steps " << kStepsMax;
        steps += result.steps;
        bytes += result.bytes;
        for (const auto& step : on_host.steps) restarts += step.restart != host_sim::Restart::none;
    }
    std::printf("seeds %d to %d: %zu steps, %zu bytes, %zu restarts\n",
                static_cast<int>(kFirstSeed), static_cast<int>(kFirstSeed + kLogs - 1), steps,
                bytes, restarts);
    EXPECT_EQ(bytes, 50 * steps);
    EXPECT_GT(restarts, kFast ? 50u : 0u);
}

TEST(BoardTargets, ADriveInTheLoopIsTheSameOnBoth) {
    const GoldenCourse course{.name = "loop", .roughness = 0.08, .mean_advance_cm = 3.5};
    const Log on_host = system_test::drive_golden(course);
    host_sim::Vehicle vehicle = host_sim::rocky32();
    vehicle.speed_cm_per_s = 6;
    host_sim::DriveOptions options = host_sim::random_course(
        vehicle, host_sim::TerrainKind::wilcox1994, course.roughness, course.length_m, 85);
    options.advance.mean_cm = course.mean_advance_cm;
    host_sim::Drive world(options);
    host_sim::LogHead head;
    head.calibration = host_sim::nominal_calibration(vehicle);
    const Log on_board = host_sim::drive(board(), world, head);
    EXPECT_EQ(text(host_sim::compare_outputs(on_host, on_board)), "");
    EXPECT_EQ(system_test::first_difference(on_host, on_board), "");
    bool half_speed = false;
    for (const auto& step : on_host.steps) half_speed |= step.commands->drive_percent[0] == 50;
    EXPECT_TRUE(half_speed) << "the course has to command something";
}

TEST(BoardTargets, AWrongInputShowsAsADifference) {
    Log on_host = host_sim::load_log(system_test::golden_file(system_test::kGoldenCourses[0]));
    Log on_board = on_host;
    on_board.steps[30].inputs.adc_q4_count[3] ^= 16;  // pitch: one count of sixteen
    host_sim::replay_on_host(on_host);
    host_sim::replay(board(), on_board);
    const auto result = host_sim::compare_outputs(on_host, on_board);
    ASSERT_TRUE(result.divergence.has_value());
    EXPECT_EQ(result.divergence->step, 30u);
    EXPECT_EQ(result.divergence->time_ms, 3000u);
    EXPECT_EQ(result.divergence->signal.find("telemetry "), 0u);
}

TEST(BoardTargets, IdentitiesDifferInTheTargetAlone) {
    Log log;
    host_sim::replay(board(), log);
    const std::string host = host_sim::host_image_identity();
    EXPECT_EQ(log.head.image_identity.substr(0, log.head.image_identity.rfind(' ')),
              host.substr(0, host.rfind(' ')));
    EXPECT_TRUE(log.head.image_identity.ends_with(" board"));
}

TEST(BoardTargets, RunsAtLeast200TimesFasterThanReal) {
    if (!kFast) GTEST_SKIP() << "only an optimised build has to be fast";
    Log log = host_sim::load_log(system_test::golden_file(system_test::kGoldenCourses[2]));
    host_sim::replay(board(), log);  // boots
    double best_s = 1e9;
    for (int i = 0; i < 5; ++i) {
        const std::clock_t begin = std::clock();
        host_sim::replay(board(), log);
        best_s = std::min(best_s, static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC);
    }
    const double real_s = 0.1 * static_cast<double>(log.steps.size());
    std::printf("%.1f s of the board in %.3f s: %.0f times faster; slowest step %llu T\n", real_s,
                best_s, real_s / best_s,
                static_cast<unsigned long long>(board().counts().slowest_step_t));
    EXPECT_GT(real_s / best_s, 200);
}

}  // namespace
