// bounds_test.cpp - all bounds of a small rover, and how they are shown.
#include "tools/bounds/bounds.hpp"

#include <gtest/gtest.h>

#include "tests/tools/bounds/sample_program.hpp"
#include "tools/bounds/tables.hpp"

namespace {

using bounds_test::kLoopWork;
using bounds_test::kLoopWorkT;
using bounds_test::kMainIsEndless;
using bounds_test::Sample;
using bounds_test::small_rover;
using rover_bounds::Bounds;
using rover_bounds::find_bounds;

constexpr rover_bounds::Timing kTiming = {30'720, 1600, 307'200};

class SmallRover : public testing::Test {
protected:
    Sample sample = small_rover(kLoopWork).note("loop", "loop 3");
    rover_bounds::FlowProgram program = sample.flow(kMainIsEndless);
    Bounds bounds = find_bounds(program, kTiming);
};

TEST_F(SmallRover, HasABoundForEveryFunctionHandlerAndTheStep) {
    EXPECT_EQ(bounds.step.t, 46 + kLoopWorkT);
    EXPECT_EQ(bounds.function_t.at(sample.at("work")), kLoopWorkT);
    EXPECT_FALSE(bounds.function_t.at(sample.at("main")));
    // acceptance 12, JMP 10, and the handler
    EXPECT_EQ(bounds.handler_t.at("RST 7.5"), 12U + 10 + 12 + 4 + 4 + 10 + 10);
    EXPECT_EQ(bounds.handler_t.at("TRAP"), 12U + 10 + 10);
}

TEST_F(SmallRover, NumbersAreByName) {
    const auto numbers = numbers_of(bounds);
    EXPECT_EQ(numbers.at("bound.step"), bounds.step.t);
    EXPECT_EQ(numbers.at("bound.stack"), 14U);
    EXPECT_EQ(numbers.at("bound.disabled"), 13U);  // DI, EI, HLT
    EXPECT_EQ(numbers.at("bound.handler.RST 6.5"), 58U);
    EXPECT_TRUE(numbers.contains("bound.response.tick"));
}

TEST_F(SmallRover, AHandlerThatIsMissedIsAnError) {
    const auto error = [](const Sample& without) -> std::string {
        try {
            (void)find_bounds(without.flow(kMainIsEndless), kTiming);
        } catch (const std::exception& refused) {
            return refused.what();
        }
        return "accepted";
    };
    const Sample none("reset: JMP main\nmain: CALL wait\n JMP main\nwait: RET\n",
                      {{"reset", "__reset"}, {"main", "main"}, {"wait", "x::rover_wait()"}});
    EXPECT_NE(error(none).find("the image has no handler of TRAP"), std::string::npos);
}

TEST_F(SmallRover, ShowsBoundsBesideWhatWasSeen) {
    rover_bounds::Observed observed;
    observed.step_t = 51;  // half of the bound of 102
    const std::string text = console_text(program, bounds, observed);
    EXPECT_NE(text.find("step, main line"), std::string::npos);
    EXPECT_NE(text.find("102        51   2.00"), std::string::npos) << text;
    EXPECT_NE(text.find("endless"), std::string::npos);
    const std::string json = json_text(program, bounds, observed);
    EXPECT_NE(json.find("\"format\": \"rover85 bounds 1\""), std::string::npos);
    EXPECT_NE(json.find("\"bound.step\": 102"), std::string::npos);
}

}  // namespace
