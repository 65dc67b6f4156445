// tables_test.cpp - a budget for people: what stands in the tables.
#include "tools/budget/tables.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>

#include "tests/tools/budget/sample_figures.hpp"

namespace {

using budget_test::sample_review;
using rover_budget::Review;
using testing::ContainsRegex;
using testing::HasSubstr;
using testing::Not;

// 500 T at 3.072 MHz: 0.1628 ms; at 2 MHz: 0.25 ms. Mean of 1600 T over 4 steps: 400.
TEST(Tables, TimesInTStatesAndMilliseconds) {
    EXPECT_EQ(rover_budget::ms_text(500, rover_budget::kClockMhz), "0.163");
    EXPECT_EQ(rover_budget::ms_text(500, rover_budget::kSlowClockMhz), "0.250");
    EXPECT_THAT(rover_budget::console_text(sample_review()),
                ContainsRegex("main line +400 +500 +0.130 +0.163 +0.200 +0.250 +<short> step 2"));
}

TEST(Tables, LimitsSayWhatHolds) {
    const std::string text = rover_budget::console_text(sample_review());
    EXPECT_THAT(text, ContainsRegex("worst step +499 +500 +OVER"));
    EXPECT_THAT(text, ContainsRegex("ROM +1000 +1000 +ok"));
    EXPECT_THAT(text, ContainsRegex("absent +1 +not measured +\\?"));
}

TEST(Tables, InterruptsOperationsAndBytes) {
    const std::string text = rover_budget::console_text(sample_review());
    EXPECT_THAT(text, ContainsRegex("RST 7.5 +4 +5.00 +60 +0.020 +70 +0.023"));
    EXPECT_THAT(text, ContainsRegex("map_grid +528 +554"));
    EXPECT_THAT(text, HasSubstr("of the order of 100"));
    EXPECT_THAT(text, ContainsRegex("control +600 +200 +12"));
    EXPECT_THAT(text, ContainsRegex("all +1000 +300"));
}

TEST(Tables, DifferencesOnlyWhereThereAreSome) {
    Review review = sample_review();
    EXPECT_THAT(rover_budget::console_text(review), Not(HasSubstr("DIFFERENT")));
    review.differences = {{"steps", 5, 4}};
    review.against = "old.json";
    review.since_then = {{"image.rom_bytes", 900, 1000}};
    const std::string text = rover_budget::console_text(review);
    EXPECT_THAT(text, ContainsRegex("DIFFERENT from the reviewed numbers"));
    EXPECT_THAT(text, ContainsRegex("steps +5 +4 +-1"));
    EXPECT_THAT(text, ContainsRegex("Differences from old.json"));
    EXPECT_THAT(text, ContainsRegex("image.rom_bytes +900 +1000 +\\+100"));
}

TEST(Markdown, EveryRowHasTheColumnsOfItsHead) {
    const std::string text = rover_budget::markdown_text(sample_review());
    EXPECT_THAT(text, HasSubstr("## Limits\n\n| limit | most | is |  |\n|---|---:|---:|---:|\n"));
    std::size_t columns = 0;
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) {
        const auto bars = static_cast<std::size_t>(std::count(line.begin(), line.end(), '|'));
        if (columns != 0 && bars != 0) {
            EXPECT_EQ(bars, columns) << line;
        }
        columns = bars;
    }
}

}  // namespace
