// golden_replay_test.cpp - reviewed drives: recorded inputs must give the recorded estimates, bit
// for bit. A wanted change is made by `golden-update` and reviewed (docs/guides/testing.md).
#include <gtest/gtest.h>

#include <set>
#include <string>

#include "host_sim/log/log_io.hpp"
#include "tests/system/golden_courses.hpp"
#include "tests/system/program.hpp"

namespace {

class GoldenReplay : public testing::TestWithParam<system_test::GoldenCourse> {};

TEST_P(GoldenReplay, RecordedInputsGiveTheReviewedEstimates) {
    const host_sim::Log golden = host_sim::load_log(system_test::golden_file(GetParam()));
    ASSERT_GT(golden.steps.back().estimates->odometer_q4_mm, 0);
    host_sim::Log again = golden;
    host_sim::replay_on_host(again);
    system_test::drop_telemetry(again);
    EXPECT_EQ(system_test::first_difference(golden, again), "")
        << "if this is wanted: build the target golden-update and review the change";
}

INSTANTIATE_TEST_SUITE_P(Courses, GoldenReplay, testing::ValuesIn(system_test::kGoldenCourses),
                         [](const auto& course) { return std::string(course.param.name); });

/// What a name promises is in the file: a golden drive that reaches nothing guards nothing.
struct Reached {
    unsigned events = 0, faults = 0, cycles = 0, restarts = 0, never_available = 0xFF;
    std::set<rover::SlipMode> modes;
};

Reached reached(const char* name) {
    Reached all;
    const host_sim::Log log =
        host_sim::load_log(std::filesystem::path(ROVER_SOURCE_DIR) / "tests/golden/replay" /
                           (std::string(name) + ".rlog"));
    for (const host_sim::LogStep& step : log.steps) {
        all.events |= step.estimates->events;
        all.faults |= step.estimates->faults;
        if ((step.estimates->events & rover::kEventCycle) != 0) ++all.cycles;
        all.never_available &= ~unsigned{step.estimates->available};
        if (step.restart != host_sim::Restart::none) ++all.restarts;
        all.modes.insert(step.estimates->mode);
    }
    return all;
}

TEST(GoldenReplayReach, EachCourseReachesWhatItIsNamedFor) {
    using rover::SlipMode;
    EXPECT_GT(reached("smooth").cycles, 15u);
    EXPECT_GT(reached("rough").cycles, 15u);
    EXPECT_TRUE(reached("slipping").events & rover::kEventSlipAlarm);
    EXPECT_TRUE(reached("sinking").events & rover::kEventSinkageAlarm);
    EXPECT_TRUE(reached("stuck_sensor").faults & rover::kFaultBogieLeft);
    EXPECT_TRUE(reached("dropouts").modes.contains(SlipMode::odometry_only));
    EXPECT_TRUE(reached("dropouts").modes.contains(SlipMode::reacquiring));
    EXPECT_TRUE(reached("absent_sensors").never_available & rover::kAvailableLookAhead);
    EXPECT_FALSE(reached("absent_sensors").never_available & rover::kAvailableSlip);
    EXPECT_EQ(reached("resets").restarts, 2u);
    EXPECT_TRUE(reached("moved_by_hand").modes.contains(SlipMode::moved));
    EXPECT_TRUE(reached("reverse_and_turn").modes.contains(SlipMode::reversing));
    EXPECT_TRUE(reached("reverse_and_turn").modes.contains(SlipMode::turning));
    EXPECT_TRUE(reached("tick_gaps").events & rover::kEventTickGap);
    EXPECT_TRUE(reached("noise").modes.contains(SlipMode::reacquiring));
}

TEST(GoldenReplaySize, TheFilesStayBelow600Kilobytes) {
    std::uintmax_t size = 0;
    for (const auto& course : system_test::kGoldenCourses) {
        size += std::filesystem::file_size(system_test::golden_file(course));
    }
    EXPECT_LT(size, 600u * 1000);
}

}  // namespace
