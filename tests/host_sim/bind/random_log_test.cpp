// random_log_test.cpp - random logs follow from their seed, can be written, and reach things.
#include "host_sim/bind/random_log.hpp"

#include <gtest/gtest.h>

#include "host_sim/bind/comparison.hpp"
#include "host_sim/bind/host_target.hpp"
#include "host_sim/log/log_io.hpp"

namespace {

using host_sim::Log;
using host_sim::random_log;

TEST(RandomLog, FollowsFromItsSeedAndIsAsItWouldBeReadFromAFile) {
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
        const Log log = random_log(seed, 50);
        ASSERT_GE(log.steps.size(), 40u);
        ASSERT_LE(log.steps.size(), 50u);
        const std::string bytes = host_sim::encode_rlog(log);
        EXPECT_EQ(host_sim::encode_rlog(random_log(seed, 50)), bytes);
        Log again = host_sim::read_rlog(bytes, "x");
        host_sim::replay_on_host(again);
        EXPECT_FALSE(host_sim::compare_outputs(log, again).divergence.has_value()) << seed;
        EXPECT_EQ(host_sim::encode_rlog(again), bytes) << seed;
    }
    EXPECT_NE(host_sim::encode_rlog(random_log(1, 50)), host_sim::encode_rlog(random_log(2, 50)));
}

TEST(RandomLog, AHundredOfThemReachRestartsLinkBytesAbsenceAndRefusedCalibrations) {
    std::size_t warm = 0, cold = 0, bytes = 0, absent = 0, refused = 0, gaps = 0;
    for (std::uint64_t seed = 1; seed <= 100; ++seed) {
        const Log log = random_log(seed, 60);
        for (const host_sim::LogStep& step : log.steps) {
            warm += step.restart == host_sim::Restart::warm;
            cold += step.restart == host_sim::Restart::cold;
            bytes += step.inputs.command_size;
            absent += step.inputs.adc_q4_count[0] == hal::kAdcAbsent;
            gaps += (step.estimates->events & rover::kEventTickGap) != 0;
        }
        refused += (log.steps[0].estimates->faults & rover::kFaultCalibration) != 0;
    }
    EXPECT_GT(warm, 20u);
    EXPECT_GT(cold, 5u);
    EXPECT_GT(bytes, 1000u);
    EXPECT_GT(absent, 50u);
    EXPECT_GT(refused, 2u);
    EXPECT_GT(gaps, 50u);
}

TEST(Canonical, WhatIsAbsentHasOneValue) {
    hal::RawInputs inputs;
    inputs.adc_q4_count[2] = 65521;
    inputs.adc_q4_count[3] = 65520;
    inputs.tach_present = 0xC1;
    inputs.tach_count[0] = 7;
    inputs.tach_count[1] = 8;
    inputs.range_present = 0x02;
    inputs.range_q1_mm[0] = 5;
    inputs.range_q1_mm[1] = 6;
    inputs.command_size = 1;
    inputs.command[0] = 3;
    inputs.command[1] = 4;
    const hal::RawInputs seen = host_sim::canonical(inputs);
    EXPECT_EQ(seen.adc_q4_count[2], hal::kAdcAbsent);
    EXPECT_EQ(seen.adc_q4_count[3], 65520);
    EXPECT_EQ(seen.tach_present, 1);
    EXPECT_EQ(seen.tach_count[0], 7);
    EXPECT_EQ(seen.tach_count[1], 0);
    EXPECT_EQ(seen.range_q1_mm[0], 0);
    EXPECT_EQ(seen.range_q1_mm[1], 6);
    EXPECT_EQ(seen.command[0], 3);
    EXPECT_EQ(seen.command[1], 0);
}

}  // namespace
