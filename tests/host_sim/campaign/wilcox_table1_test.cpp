// wilcox_table1_test.cpp - the transcription, read again from the paper's text.
#include "host_sim/campaign/wilcox_table1.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <regex>
#include <string>
#include <vector>

namespace {

namespace table = host_sim::wilcox_table1;

const char* const kPaper = ROVER_SOURCE_DIR "/../shared/papers/wilcox1994_nongeometric_hazards.txt";

std::vector<double> numbers_in(const std::string& line) {
    static const std::regex kNumber(R"(-?\d+\.\d+)");
    std::vector<double> numbers;
    for (std::sregex_iterator at(line.begin(), line.end(), kNumber), end; at != end; ++at) {
        numbers.push_back(std::stod(at->str()));
    }
    return numbers;
}

/// Numbers of every line of the paper that matches `pattern`.
std::vector<std::vector<double>> lines_like(const char* pattern) {
    std::ifstream paper(kPaper);
    std::vector<std::vector<double>> found;
    for (std::string line; std::getline(paper, line);) {
        if (std::regex_search(line, std::regex(pattern))) found.push_back(numbers_in(line));
    }
    return found;
}

class WilcoxTable1 : public ::testing::Test {
protected:
    void SetUp() override {
        if (!std::ifstream(kPaper)) GTEST_SKIP() << "the paper's text is not at " << kPaper;
    }
};

TEST_F(WilcoxTable1, EveryCellIsAsPrinted) {
    const auto lines = lines_like(R"(^\d\.\d\d\s+-?\d+\.\d+ \()");
    ASSERT_EQ(lines.size(), table::kRows.size());
    for (std::size_t row = 0; row < lines.size(); ++row) {
        ASSERT_EQ(lines[row].size(), 13u);
        EXPECT_EQ(table::kRows[row].bin_cm, lines[row][0]);
        EXPECT_EQ(table::kRows[row].bin_cm, 0.25 * static_cast<double>(row + 1));
        for (std::size_t i = 0; i < table::kRoughnessCount; ++i) {
            EXPECT_EQ(table::kRows[row].cells[i].odometry_error_pct, lines[row][1 + 2 * i]);
            EXPECT_EQ(table::kRows[row].cells[i].sinkage_rms_cm, lines[row][2 + 2 * i]);
        }
    }
}

TEST_F(WilcoxTable1, RoughnessHeadingIsAsPrinted) {
    const auto lines = lines_like(R"(^\s*0\.0025\s+0\.0050)");
    ASSERT_EQ(lines.size(), 1u);
    EXPECT_EQ(lines[0], std::vector<double>(table::kRoughness.begin(), table::kRoughness.end()));
}

TEST_F(WilcoxTable1, TerrainStatisticsAreAsPrinted) {
    const auto lines = lines_like(R"(^\d\.--)");
    ASSERT_EQ(lines.size() * 4, table::kTerrain.size());
    for (std::size_t i = 0; i < table::kTerrain.size(); ++i) {
        ASSERT_EQ(lines[i / 4].size(), 8u);
        EXPECT_EQ(table::kTerrain[i].rms_step_cm, lines[i / 4][2 * (i % 4)]);
        EXPECT_EQ(table::kTerrain[i].rms_projection_cm, lines[i / 4][2 * (i % 4) + 1]);
    }
}

}  // namespace
