// parallel_test.cpp - every piece once, the same failure, whatever the number of threads.
#include "host_sim/campaign/parallel.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <stdexcept>
#include <string>
#include <vector>

namespace {

using host_sim::parallel_for;

TEST(ParallelFor, CallsEveryIndexExactlyOnce) {
    for (const unsigned threads : {0u, 1u, 2u, 7u, 64u}) {
        for (const std::size_t count : {0u, 1u, 5u, 200u}) {
            std::vector<std::atomic<int>> calls(count);
            parallel_for(count, threads, [&](std::size_t index) { ++calls[index]; });
            for (const auto& once : calls) EXPECT_EQ(once, 1);
        }
    }
}

TEST(ParallelFor, ReportsProgressInOrderUpToTheTotal) {
    std::vector<std::size_t> seen;
    parallel_for(
        50, 4, [](std::size_t) {},
        [&](std::size_t done, std::size_t total) {
            EXPECT_EQ(total, 50u);
            seen.push_back(done);
        });
    ASSERT_EQ(seen.size(), 50u);
    for (std::size_t i = 0; i < seen.size(); ++i) EXPECT_EQ(seen[i], i + 1);
}

TEST(ParallelFor, RethrowsTheFailureOfTheLowestIndex) {
    for (const unsigned threads : {1u, 2u, 8u}) {
        for (int repeat = 0; repeat < 50; ++repeat) {
            try {
                parallel_for(40, threads, [](std::size_t index) {
                    if (index >= 11) throw std::runtime_error(std::to_string(index));
                });
                FAIL() << "nothing was thrown";
            } catch (const std::runtime_error& error) {
                EXPECT_STREQ(error.what(), "11");
            }
        }
    }
}

}  // namespace
