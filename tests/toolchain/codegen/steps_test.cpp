// Names of steps: one for each, and sets of them.
#include "toolchain/codegen/steps.hpp"

#include <gtest/gtest.h>

namespace {

using toolchain::Step;
using toolchain::Steps;

TEST(Steps, EveryStepHasItsName) {
    const auto names = toolchain::step_names();
    ASSERT_EQ(names.size(), static_cast<std::size_t>(Step::zero_by_k) + 1);
    for (std::size_t i = 0; i < names.size(); ++i) {
        EXPECT_EQ(static_cast<std::size_t>(names[i].step), i) << names[i].name;
        EXPECT_EQ(toolchain::step_named(names[i].name), names[i].step);
    }
    EXPECT_EQ(toolchain::step_named("magic"), std::nullopt);
}

TEST(Steps, AreAllThereUntilOneIsLeftOut) {
    Steps steps;
    for (const toolchain::StepName& name : toolchain::step_names()) {
        EXPECT_TRUE(steps.contains(name.step)) << name.name;
        EXPECT_EQ(steps.documented().contains(name.step), !name.undocumented) << name.name;
    }
    steps.leave_out(Step::homes);
    EXPECT_FALSE(steps.contains(Step::homes));
    EXPECT_TRUE(steps.contains(Step::detours));
    EXPECT_FALSE(steps.documented().contains(Step::homes));
}

}  // namespace
