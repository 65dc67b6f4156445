#include "tools/rover85/log_output.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "host_sim/log/log_io.hpp"
#include "tests/tools/rover85/command_line.hpp"

namespace {

host_sim::Log two_steps() {
    host_sim::Log log;
    log.steps.resize(2);
    for (host_sim::LogStep& step : log.steps) {
        std::ranges::fill(step.inputs.adc_q4_count, hal::kAdcAbsent);
    }
    log.steps[1].time_ms = 100;
    log.steps[0].inputs.adc_q4_count[3] = 32760;
    log.steps[1].inputs.tach_present = 0b100001;
    return log;
}

TEST(LogOutput, TheNameDecidesTheKindAndBothReadBack) {
    const rover85_test::TestFolder folder("log_output");
    for (const std::string name : {"a.rlog", "a.csv"}) {
        EXPECT_EQ(check_log_name(folder.file(name)), "");
        write_log(folder.file(name), two_steps());
        EXPECT_EQ(host_sim::load_log(folder.file(name)).steps.size(), 2U) << name;
    }
    EXPECT_NE(check_log_name("a.txt"), "");
    EXPECT_NE(check_log_name("rlog"), "");
    EXPECT_THROW(write_log(folder.file("a.txt"), two_steps()), host_sim::LogError);
    EXPECT_FALSE(std::filesystem::exists(folder.file("a.txt")));
}

TEST(LogOutput, DescriptionNamesWhatIsPresent) {
    EXPECT_EQ(describe_log(two_steps()),
              "2 steps, 0.1 s; present: pitch, tachometer front_left, tachometer rear_right; all "
              "else absent");
    EXPECT_EQ(describe_log({}), "0 steps, 0.0 s; present: nothing; all else absent");
}

}  // namespace
