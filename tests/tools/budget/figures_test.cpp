// figures_test.cpp - numbers by name, review against old ones, limits, operations.
#include "tools/budget/figures.hpp"

#include <gtest/gtest.h>

#include "tests/tools/budget/sample_figures.hpp"
#include "tools/budget/budget_error.hpp"
#include "tools/budget/reviewed.hpp"

namespace {

using rover_budget::BudgetError;
using rover_budget::Difference;
using rover_budget::Numbers;

TEST(NumbersOf, NamesEveryNumber) {
    const Numbers numbers = rover_budget::numbers_of(budget_test::sample_figures());
    EXPECT_EQ(numbers.at("image.rom_bytes"), 1000u);
    EXPECT_EQ(numbers.at("image.ram_bytes"), 300u);
    EXPECT_EQ(numbers.at("image.stack_bytes"), 40u);
    EXPECT_EQ(numbers.at("image.stack_bytes_seen"), 30u);
    EXPECT_EQ(numbers.at("steps"), 4u);
    EXPECT_EQ(numbers.at("step.t_states_worst"), 500u);
    EXPECT_EQ(numbers.at("module.control.rom_bytes"), 600u);
    EXPECT_EQ(numbers.at("module.control.t_states_total"), 1600u);
    EXPECT_EQ(numbers.at("module.arithmetic.rom_bytes"), 100u);
    EXPECT_FALSE(numbers.contains("module.arithmetic.t_states_worst"));
    EXPECT_FALSE(numbers.contains("module.other.rom_bytes"));
    EXPECT_EQ(numbers.at("interrupt.rst75.latency_worst"), 70u);
    EXPECT_EQ(numbers.at("interrupts.latency_worst"), 70u);
    EXPECT_FALSE(numbers.contains("interrupt.trap.accepted"));
}

// 3 of 7 are 42.857 %: 4286 in hundredths, rounded up.
TEST(NumbersOf, TheShareOfInterruptsIsRoundedUp) {
    rover_budget::ProfileFigures profile;
    EXPECT_EQ(rover_budget::interrupt_share_e4(profile), 0u);
    profile.total_t = 7;
    profile.interrupts.total_t = 3;
    EXPECT_EQ(rover_budget::interrupt_share_e4(profile), 4286u);
    profile.total_t = 100;
    profile.interrupts.total_t = 15;
    EXPECT_EQ(rover_budget::interrupt_share_e4(profile), 1500u);
}

TEST(Differences, BetterWorseNewAndGone) {
    const Numbers before = {{"a", 10}, {"b", 20}, {"c", 30}, {"d", 5}};
    const Numbers now = {{"a", 10}, {"b", 19}, {"c", 33}, {"e", 1}};
    const auto found = rover_budget::differences(before, now);
    EXPECT_EQ(found,
              (std::vector<Difference>{
                  {"b", 20, 19}, {"c", 30, 33}, {"d", 5, std::nullopt}, {"e", std::nullopt, 1}}));
    EXPECT_EQ(rover_budget::describe(found[0]), "b  20 -> 19  (-1, -5.0 %)");
    EXPECT_EQ(rover_budget::describe(found[1]), "c  30 -> 33  (+3, +10.0 %)");
    EXPECT_EQ(rover_budget::describe(found[2]), "d  5 -> gone");
    EXPECT_EQ(rover_budget::describe(found[3]), "e  new: 1");
    EXPECT_TRUE(rover_budget::differences(now, now).empty());
}

TEST(ReviewedFile, ReadsWhatItWrote) {
    const Numbers numbers = {{"a", 0}, {"b", 4'000'000'000'000}};
    EXPECT_EQ(rover_budget::parse_numbers(rover_budget::reviewed_text(numbers), "b.json"), numbers);
}

TEST(ReviewedFile, RefusesWhatIsNone) {
    for (const char* text : {"", "[]", "{}", "{\"numbers\":3}", "{\"numbers\":{\"a\":-1}}",
                             "{\"numbers\":{\"a\":1.5}}"}) {
        EXPECT_THROW((void)rover_budget::parse_numbers(text, "b.json"), BudgetError) << text;
    }
}

TEST(Limits, HoldUpToTheirValue) {
    const auto limits =
        rover_budget::parse_limits("# x\na,10,first, with comma\nb,5,second\n", "l");
    ASSERT_EQ(limits.size(), 2u);
    EXPECT_EQ(limits[0].what, "first, with comma");
    EXPECT_TRUE(limits[0].holds({{"a", 10}}));
    EXPECT_FALSE(limits[0].holds({{"a", 11}}));
    EXPECT_FALSE(limits[1].holds({{"a", 1}})) << "not measured";
    for (const char* wrong : {"a", "a,1", "a,x,y", "a,1,", ",1,y"}) {
        EXPECT_THROW((void)rover_budget::parse_limits(wrong, "l"), BudgetError) << wrong;
    }
}

TEST(ParseOperations, MeanAndWorst) {
    const auto operations = rover_budget::parse_operations(
        "# x\noperation,total,worst_cycle\ncycles,4,\nadd,7,2\n"
        "all,10,5\n",
        "o.csv");
    EXPECT_DOUBLE_EQ(operations.mean(), 2.5);
    EXPECT_EQ(operations.worst, 5u);
    EXPECT_THROW((void)rover_budget::parse_operations("cycles,4,\n", "o.csv"), BudgetError);
    EXPECT_THROW((void)rover_budget::parse_operations("cycles,4,\nall,x,5\n", "o.csv"),
                 BudgetError);
}

}  // namespace
