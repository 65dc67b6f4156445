// map_grid_count_test.cpp - operations a cycle are the reviewed numbers.
#include "tools/opcount/map_grid_count.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

namespace {

const opcount::MapGridCount& counted() {
    static const opcount::MapGridCount count = opcount::count_map_grid();
    return count;
}

TEST(MapGridOperations, AreThoseOfTheBudgetFile) {
    const std::string path = std::string(ROVER_SOURCE_DIR) + "/tests/budgets/operations.csv";
    std::ifstream file(path);
    ASSERT_TRUE(file) << path;
    std::ostringstream text;
    text << file.rdbuf();
    EXPECT_EQ(opcount::budget(counted()), text.str())
        << "if the change is meant: opcount --budget > tests/budgets/operations.csv";
}

TEST(MapGridOperations, CategoriesAddUpAndTheWorstCycleIsNoBetterThanTheMean) {
    std::uint64_t worst_by_category = 0;
    std::uint64_t total = 0;
    for (std::size_t i = 0; i < opcount::kCategoryCount; ++i) {
        total += counted().total[i];
        worst_by_category += counted().worst[i];
    }
    EXPECT_GE(counted().worst_sum * counted().cycles, total);
    EXPECT_LE(counted().worst_sum, worst_by_category);
}

// The course is 62.5 m and the estimator good to 1.5 %: what was counted is the estimator at work.
TEST(MapGridOperations, AreCountedOnACourseThatTheEstimatorFollows) {
    EXPECT_NEAR(counted().travelled_q6_bin * 2.5 / 64, 6250, 0.015 * 6250);
}

}  // namespace
