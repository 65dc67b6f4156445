#include "tools/report/decimate.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

namespace {

using report::keep_rows;
using report::Run;
using report::worst_runs;
using testing::ElementsAre;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

TEST(KeepRows, ShortLogsKeepEveryRow) {
    const std::vector<double> column = {3, 1, 2};
    const std::vector<const std::vector<double>*> columns = {&column};
    EXPECT_THAT(keep_rows(columns, 3, 3), ElementsAre(0, 1, 2));
    EXPECT_TRUE(keep_rows(columns, 0, 3).empty());
}

TEST(KeepRows, KeepsEndsAndBothExtremesOfOneBucket) {
    const std::vector<double> column = {0, 5, 1, -7, 2, 9, 3, 0};
    const std::vector<const std::vector<double>*> columns = {&column};
    EXPECT_THAT(keep_rows(columns, 8, 5), ElementsAre(0, 3, 5, 7));
}

// Chosen independently: the extremes of a column over the rows kept equal those over all rows, and
// every single-row peak far above the noise is still there.
TEST(KeepRows, NoPeakIsLostAndTheBoundHolds) {
    const unsigned seed = 85;
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    std::mt19937 random(seed);
    std::normal_distribution<double> noise;
    for (const std::size_t count : {1001u, 7500u, 75000u}) {
        std::vector<double> a(count), b(count);
        for (std::size_t row = 0; row < count; ++row) {
            a[row] = noise(random);
            b[row] = row % 10 == 0 ? noise(random) : kNan;
        }
        std::vector<std::size_t> peaks;
        for (std::size_t row = 17; row < count; row += count / 20) peaks.push_back(row);
        for (const std::size_t row : peaks) a[row] = 1000.0;
        const std::vector<const std::vector<double>*> columns = {&a, &b};
        const auto rows = keep_rows(columns, count, 1000);
        EXPECT_LE(rows.size(), 1000u);
        EXPECT_TRUE(std::is_sorted(rows.begin(), rows.end()));
        EXPECT_EQ(std::adjacent_find(rows.begin(), rows.end()), rows.end());
        EXPECT_EQ(rows.front(), 0u);
        EXPECT_EQ(rows.back(), count - 1);
        for (const std::size_t peak : peaks) {
            EXPECT_TRUE(std::binary_search(rows.begin(), rows.end(), peak)) << peak;
        }
        double least = 0, greatest = 0, kept_least = 0, kept_greatest = 0;
        for (const double value : b) {
            if (std::isnan(value)) continue;
            least = std::min(least, value);
            greatest = std::max(greatest, value);
        }
        for (const std::size_t row : rows) {
            if (std::isnan(b[row])) continue;
            kept_least = std::min(kept_least, b[row]);
            kept_greatest = std::max(kept_greatest, b[row]);
        }
        EXPECT_EQ(kept_least, least);
        EXPECT_EQ(kept_greatest, greatest);
    }
}

TEST(KeepRows, AGapStaysAGap) {
    std::vector<double> column(1000, 1.0);
    for (std::size_t row = 400; row < 600; ++row) column[row] = kNan;
    const std::vector<const std::vector<double>*> columns = {&column};
    const auto rows = keep_rows(columns, column.size(), 100);
    const auto is_gap = [&](std::size_t row) { return std::isnan(column[row]); };
    EXPECT_TRUE(std::any_of(rows.begin(), rows.end(), is_gap));
}

TEST(KeepRows, TooSmallALimitUsesOneBucket) {
    const std::vector<double> a = {1, 2, 3, 4, 5}, b = {5, 4, 3, 2, 1};
    const std::vector<const std::vector<double>*> columns = {&a, &b};
    EXPECT_LE(keep_rows(columns, 5, 0).size(), 3 * columns.size() + 2);
}

TEST(WorstRuns, ExactWhenTheBucketsSuffice) {
    const std::vector<signed char> severity = {0, 0, 1, 1, 0};
    const auto runs = worst_runs(severity, 5);
    ASSERT_EQ(runs.size(), 3u);
    EXPECT_EQ(runs[1].begin, 2u);
    EXPECT_EQ(runs[1].end, 4u);
    EXPECT_EQ(runs[1].value, 1);
}

TEST(WorstRuns, OneRaisedStepInSeventyFiveThousandSurvives) {
    std::vector<signed char> severity(75000, 0);
    severity[31415] = 1;
    const auto runs = worst_runs(severity, 2000);
    ASSERT_EQ(runs.size(), 3u);
    EXPECT_LE(runs[1].begin, 31415u);
    EXPECT_GT(runs[1].end, 31415u);
    EXPECT_LE(runs[1].end - runs[1].begin, 75000u / 2000u + 1);
}

TEST(WorstRuns, EmptyGivesNothing) {
    EXPECT_TRUE(worst_runs({}, 10).empty());
}

}  // namespace
