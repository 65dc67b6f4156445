// Reduced programs that our compiler once got wrong: tests/toolchain/regressions/*.c.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <vector>

#include "tests/toolchain/csmith/compare.hpp"

namespace csmith_test {
namespace {

std::vector<std::filesystem::path> programs() {
    std::vector<std::filesystem::path> found;
    const auto folder = std::filesystem::path(ROVER_SOURCE_DIR) / "tests/toolchain/regressions";
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
        if (entry.path().extension() == ".c") found.push_back(entry.path());
    }
    std::sort(found.begin(), found.end());
    return found;
}

class Regressions : public testing::TestWithParam<std::filesystem::path> {};

TEST_P(Regressions, AgreeWithTheOracle) {
    const Finding finding = compare({GetParam(), {}}, {});
    EXPECT_EQ(finding.verdict, Verdict::agreed) << finding.text;
}

INSTANTIATE_TEST_SUITE_P(Reduced, Regressions, testing::ValuesIn(programs()),
                         [](const auto& test) { return test.param.stem().string(); });

}  // namespace
}  // namespace csmith_test
