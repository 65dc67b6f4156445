// flow_program_test.cpp - where loops get their bounds, and what is refused.
#include "tools/bounds/flow_program.hpp"

#include <gtest/gtest.h>

#include "tests/tools/bounds/sample_program.hpp"
#include "tools/budget/budget_error.hpp"

namespace {

using bounds_test::kLoopWork;
using bounds_test::kMainIsEndless;
using bounds_test::Sample;
using bounds_test::small_rover;

std::string error_of(const Sample& sample, const std::string& table) {
    try {
        (void)sample.flow(table);
    } catch (const rover_budget::BudgetError& error) {
        return error.what();
    }
    return "accepted";
}

TEST(FlowProgram, ALoopWithoutABoundIsAnErrorWithItsLine) {
    const Sample sample = small_rover(kLoopWork);
    const std::string error = error_of(sample, kMainIsEndless);
    EXPECT_NE(error.find("a.cpp:"), std::string::npos) << error;
    EXPECT_NE(error.find(": x::work(), loop 1 at "), std::string::npos) << error;
    EXPECT_NE(error.find("the loop has no bound"), std::string::npos) << error;
}

TEST(FlowProgram, ANoteOfTheCompilerIsABoundAndARuleMayTightenIt) {
    Sample sample = small_rover(kLoopWork);
    sample.note("loop", "loop 5");
    const auto noted = sample.flow(kMainIsEndless);
    EXPECT_EQ(noted.loops(sample.at("work")).at(0).most, 5U);
    EXPECT_EQ(sample.flow(kMainIsEndless + "turns,x::work()#1 3,why\n")
                  .loops(sample.at("work"))
                  .at(0)
                  .most,
              3U);
    EXPECT_EQ(sample.flow(kMainIsEndless + "turns,x::work()#1 8,why\n")
                  .loops(sample.at("work"))
                  .at(0)
                  .most,
              5U);
}

TEST(FlowProgram, StatedTimesReplaceTheCode) {
    Sample sample = small_rover(kLoopWork);
    sample.note("work", "t 10 to 99");
    const auto program = sample.flow(kMainIsEndless);
    EXPECT_EQ(program.graph().at(sample.at("work")).stated_t, 99U);
}

TEST(FlowProgram, TheStepIsOneTurnOfTheLoopThatWaits) {
    const Sample sample = small_rover("RET\n");
    const auto program = sample.flow(kMainIsEndless);
    EXPECT_EQ(program.step().entry, sample.at("turn"));
    EXPECT_EQ(program.wait(), sample.at("wait"));
    ASSERT_EQ(program.handlers().size(), 4U);
    EXPECT_EQ(program.handlers()[1].name, "RST 7.5");
}

TEST(FlowProgram, LinesThatFitNothingAreRefused) {
    const Sample sample = small_rover("RET\n");
    EXPECT_EQ(error_of(sample, kMainIsEndless + "turns,gone#1 3,why\n"),
              "flow.csv:2: gone fits nothing in the image; correct the pattern or the loop's "
              "number");
    EXPECT_EQ(error_of(sample, kMainIsEndless + "fact,x::work()#1 <= 3,why\n")
                  .find("flow.csv:2: x::work() fits nothing"),
              0U);
}

}  // namespace
