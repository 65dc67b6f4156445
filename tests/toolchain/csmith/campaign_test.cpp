#include "tests/toolchain/csmith/campaign.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <set>
#include <stdexcept>

namespace csmith_test {
namespace {

Finding by_seed(uint64_t seed) {
    if (seed % 10 == 7) return {Verdict::difference, "seven " + std::to_string(seed)};
    if (seed % 10 == 3) return {Verdict::skipped, ""};
    return {};
}

TEST(RunCampaign, HearsOfEverySeedOnce) {
    for (const unsigned jobs : {1U, 3U}) {
        std::multiset<uint64_t> heard;
        const Summary summary = run_campaign(
            {101, 200, jobs}, by_seed,
            [&](const Summary&, uint64_t seed, const Finding&) { heard.insert(seed); });
        EXPECT_EQ(heard.size(), 100U);
        EXPECT_EQ(std::set<uint64_t>(heard.begin(), heard.end()).size(), 100U);
        EXPECT_EQ(summary.done(), 100U);
        EXPECT_EQ(summary.count(Verdict::agreed), 80U);
        EXPECT_EQ(summary.count(Verdict::skipped), 10U);
        EXPECT_EQ(summary.count(Verdict::difference), 10U);
        EXPECT_EQ(summary.findings.at(107), (Finding{Verdict::difference, "seven 107"}));
        EXPECT_TRUE(summary.has_fault());
    }
}

TEST(RunCampaign, CountsWhatAProcessThatDiedDidNotReport) {
    const Summary summary = run_campaign({1, 6, 2}, [](uint64_t seed) -> Finding {
        if (seed == 2) _exit(9);
        if (seed == 3) throw std::runtime_error("thrown");
        return {};
    });
    EXPECT_EQ(summary.count(Verdict::agreed), 4U);
    EXPECT_EQ(summary.findings.at(2).text, "the comparing process died");
    EXPECT_EQ(summary.findings.at(3).text, "thrown");
    EXPECT_TRUE(summary.has_fault());
}

TEST(Summary, SkippedProgramsAreNoFaultAndAlwaysCounted) {
    const Summary summary = run_campaign({1, 2, 1}, [](uint64_t seed) {
        return seed == 1 ? Finding{Verdict::skipped, "why"} : Finding{};
    });
    EXPECT_FALSE(summary.has_fault());
    EXPECT_EQ(counts_text(summary), "2 programs, 1 agreed, 1 skipped");
}

TEST(Verdict, FaultsAreThoseOfOurCompiler) {
    for (const Verdict verdict :
         {Verdict::agreed, Verdict::skipped, Verdict::doubtful, Verdict::too_large}) {
        EXPECT_FALSE(is_fault(verdict)) << name_of(verdict);
    }
    for (const Verdict verdict :
         {Verdict::no_end, Verdict::refused, Verdict::failed, Verdict::difference}) {
        EXPECT_TRUE(is_fault(verdict)) << name_of(verdict);
    }
}

}  // namespace
}  // namespace csmith_test
