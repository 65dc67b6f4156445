// golden_replay_test.cpp - reviewed drives: recorded inputs must give the recorded estimates, bit
// for bit. A wanted change is made by `golden-update` and reviewed (docs/guides/testing.md).
#include <gtest/gtest.h>

#include "host_sim/log/log_io.hpp"
#include "tests/system/golden_courses.hpp"
#include "tests/system/program.hpp"

namespace {

class GoldenReplay : public testing::TestWithParam<system_test::GoldenCourse> {};

TEST_P(GoldenReplay, RecordedInputsGiveTheReviewedEstimates) {
    const host_sim::Log golden = host_sim::load_log(system_test::golden_file(GetParam()));
    ASSERT_GT(golden.steps.back().estimates->cycle_count, 15);
    host_sim::Log again = golden;
    host_sim::replay_on_host(again);
    for (host_sim::LogStep& step : again.steps) {
        step.commands->telemetry_size = 0;
        for (std::uint8_t& byte : step.commands->telemetry) byte = 0;
    }
    EXPECT_EQ(system_test::first_difference(golden, again), "")
        << "if this is wanted: build the target golden-update and review the change";
}

INSTANTIATE_TEST_SUITE_P(Courses, GoldenReplay, testing::ValuesIn(system_test::kGoldenCourses),
                         [](const auto& course) { return std::string(course.param.name); });

TEST(GoldenReplaySize, TheFilesStayBelow300Kilobytes) {
    std::uintmax_t size = 0;
    for (const auto& course : system_test::kGoldenCourses) {
        size += std::filesystem::file_size(system_test::golden_file(course));
    }
    EXPECT_LT(size, 300u * 1000);
}

}  // namespace
