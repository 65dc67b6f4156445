// table1_sweep_test.cpp - the reproduction of the paper's Table 1, in both arithmetics.
#include "host_sim/campaign/table1_sweep.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>

#include "host_sim/bind/slip_estimators.hpp"

namespace {

using namespace host_sim;
namespace paper = host_sim::wilcox_table1;

// Seeds that nothing was chosen by; the mean of 20 runs beside the paper's single one.
SweepTable1Options acceptance(Arithmetic arithmetic) {
    return {.arithmetic = arithmetic, .seeds = 20, .seed_base = 7001, .bin_max_cm = 4.0};
}

class Table1 : public ::testing::TestWithParam<Arithmetic> {};

TEST_P(Table1, Bin25LiesWithin3PointsAndBinsUpTo4WithinAMeanOf2PointsOfThePaper) {
    const SweepTable1Result result = sweep_table1(acceptance(GetParam()), make_slip_estimator);
    ASSERT_EQ(result.rows.size(), 16u);
    for (std::size_t i = 0; i < paper::kRoughnessCount; ++i) {
        EXPECT_NEAR(result.rows[9][i].mean_pct, paper::kRows[9].cells[i].odometry_error_pct, 3.0)
            << "bin " << paper::kRows[9].bin_cm << " roughness " << paper::kRoughness[i];
    }
    EXPECT_LE(table1_deviation(result, 0.25, 4.0).mean_abs_points, 2.0);
    EXPECT_EQ(table1_deviation(result, 0.25, 4.0).cells, 96u);
}

INSTANTIATE_TEST_SUITE_P(Arithmetics, Table1,
                         ::testing::Values(Arithmetic::fixed, Arithmetic::floating),
                         [](const auto& test) { return std::string(name_of(test.param)); });

TEST(Table1Terrain, StatisticsMatchThePapersTable) {
    SweepTable1Options options;
    options.seed_base = 7001;
    options.bin_max_cm = 0.25;
    options.seeds = 20;
    const SweepTable1Result result = sweep_table1(options, make_slip_estimator);
    EXPECT_NEAR(result.unit_terrain_rms_cm, paper::kUnitTerrainRmsCm, 2.0);
    for (std::size_t i = 1; i < paper::kBinCount; ++i) {
        const TerrainStatistics& ours = result.terrain[i];
        EXPECT_NEAR(ours.rms_step_cm / paper::kTerrain[i].rms_step_cm, 1, 0.015) << i;
        EXPECT_NEAR(ours.rms_projection_cm / paper::kTerrain[i].rms_projection_cm, 1, 0.025) << i;
    }
}

TEST(SweepTable1, ResultDoesNotDependOnTheNumberOfThreads) {
    SweepTable1Options options{.seeds = 3, .threads = 1, .length_cm = 500};
    const std::string one = sweep_table1_json(options, sweep_table1(options, make_slip_estimator));
    options.threads = 4;
    EXPECT_EQ(sweep_table1_json(options, sweep_table1(options, make_slip_estimator)), one);
}

TEST(SweepTable1, PrintsAll32By6CellsWithThePapersValues) {
    const SweepTable1Options options{.seeds = 1, .length_cm = 200};
    std::ostringstream out;
    std::ostringstream err;
    ASSERT_EQ(run_sweep_table1(options, make_slip_estimator, out, err), 0);
    std::istringstream lines(out.str());
    int rows = 0;
    for (std::string line; std::getline(lines, line);) {
        double bin_cm = 0;
        if (std::sscanf(line.c_str(), "%lf |", &bin_cm) != 1 || rows == 32) continue;
        ASSERT_EQ(bin_cm, paper::kRows[static_cast<std::size_t>(rows)].bin_cm);
        for (const paper::Cell& cell : paper::kRows[static_cast<std::size_t>(rows)].cells) {
            char text[16];
            std::snprintf(text, sizeof text, " %6.2f ", cell.odometry_error_pct);
            EXPECT_NE(line.find(text), std::string::npos) << line;
        }
        ++rows;
    }
    EXPECT_EQ(rows, 32);
}

TEST(SweepTable1, JsonHasEveryCellBesideThePapers) {
    const SweepTable1Options options{.seeds = 1, .length_cm = 200};
    const auto document = nlohmann::json::parse(
        sweep_table1_json(options, sweep_table1(options, make_slip_estimator)));
    ASSERT_EQ(document["cells"].size(), 192u);
    EXPECT_EQ(document["cells"][191]["bin_cm"], 8.0);
    EXPECT_EQ(document["cells"][191]["paper_odometry_error_pct"], -15.76);
    EXPECT_EQ(document["terrain_statistics"].size(), 31u);
}

TEST(Table1DeviationOfTheMean, IsCountedInPointsOverTheBand) {
    SweepTable1Result result;
    result.rows.resize(2);
    for (std::size_t row = 0; row < 2; ++row) {
        for (std::size_t i = 0; i < paper::kRoughnessCount; ++i) {
            const double off = row == 0 ? 1.0 : -4.0;
            result.rows[row][i].mean_pct = paper::kRows[row].cells[i].odometry_error_pct + off;
        }
    }
    const Table1Deviation both = table1_deviation(result, 0.25, 0.5);
    EXPECT_NEAR(both.mean_abs_points, 2.5, 1e-9);
    EXPECT_NEAR(both.mean_signed_points, -1.5, 1e-9);
    EXPECT_NEAR(both.worst_abs_points, 4.0, 1e-9);
    EXPECT_EQ(both.cells, 12u);
    EXPECT_EQ(table1_deviation(result, 5, 8).cells, 0u);
}

TEST(RunSweepTable1, RefusesBadOptionsWithCode2) {
    std::ostringstream out;
    std::ostringstream err;
    EXPECT_EQ(run_sweep_table1({.seeds = 0}, make_slip_estimator, out, err), 2);
    EXPECT_NE(err.str().find("seeds"), std::string::npos);
}

}  // namespace
