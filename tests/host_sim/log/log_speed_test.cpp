// log_speed_test.cpp - writing and reading a 62.5 m traverse must not be what people wait for.
// Processor time and not wall time is measured, so that a busy machine does not fail it.
#include <gtest/gtest.h>

#include <ctime>

#include "host_sim/log/log_io.hpp"
#include "log_samples.hpp"

namespace {

#if defined(NDEBUG) && !defined(__SANITIZE_ADDRESS__)
constexpr bool kOptimised = true;
#else
constexpr bool kOptimised = false;
#endif

template <class Action>
double seconds_of(Action action) {
    const std::clock_t start = std::clock();
    action();
    return static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
}

TEST(LogSpeed, SeventyFiveThousandStepsTakeAFractionOfASecond) {
    if (!kOptimised) GTEST_SKIP() << "limits hold for the release build";
    const host_sim::Log log = log_test::small_log(75'000);
    std::string rlog;
    std::string csv;
    EXPECT_LE(seconds_of([&] { rlog = host_sim::encode_rlog(log); }), 0.3);
    EXPECT_LE(seconds_of([&] { csv = host_sim::encode_csv(log); }), 0.6);
    EXPECT_LE(seconds_of([&] { EXPECT_EQ(host_sim::read_rlog(rlog, "x").steps.size(), 75'000u); }),
              0.3);
    EXPECT_LE(seconds_of([&] { EXPECT_EQ(host_sim::read_csv(csv, "x").steps.size(), 75'000u); }),
              0.6);
}

}  // namespace
