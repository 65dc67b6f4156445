// Programs of fixed seeds, every level against avr-gcc on simavr. More:
// docs/guides/random-testing.md.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <tuple>

#include "tests/toolchain/csmith/campaign.hpp"

namespace csmith_test {
namespace {

constexpr uint64_t kGroup = 10;
constexpr uint64_t kSearchBudget = 1000;  // of register homes: a hundredth of the time

class Programs : public testing::TestWithParam<std::tuple<Generator, uint64_t>> {};

TEST_P(Programs, ComputeWhatTheOracleSays) {
    CompareOptions options;
    options.kind = std::get<0>(GetParam());
    options.subject.search_budget = kSearchBudget;
    const uint64_t first = std::get<1>(GetParam());
    const Campaign campaign{first, first + kGroup - 1, 1};
    const Summary summary =
        run_campaign(campaign, [&](uint64_t seed) { return compare_seed(seed, options); });
    fmt::print("seeds {} to {}: {}\n", campaign.first, campaign.last, counts_text(summary));
    for (const auto& [seed, finding] : summary.findings) {
        EXPECT_FALSE(is_fault(finding.verdict))
            << "seed " << seed << ": " << name_of(finding.verdict) << ": " << finding.text;
    }
    // Were most of them skipped, the test would say little.
    EXPECT_GT(summary.count(Verdict::agreed), kGroup / 2);
}

INSTANTIATE_TEST_SUITE_P(Csmith, Programs,
                         testing::Combine(testing::Values(Generator::csmith),
                                          testing::Range<uint64_t>(1, 31, kGroup)),
                         [](const auto& test) {
                             return fmt::format("From{}", std::get<1>(test.param));
                         });
INSTANTIATE_TEST_SUITE_P(Kernels, Programs,
                         testing::Combine(testing::Values(Generator::kernels),
                                          testing::Range<uint64_t>(1, 21, kGroup)),
                         [](const auto& test) {
                             return fmt::format("From{}", std::get<1>(test.param));
                         });

}  // namespace
}  // namespace csmith_test
