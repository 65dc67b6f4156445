// chip_test.cpp - what all chip models share: nanoseconds to T-states.
#include "host_sim/chips/chip.hpp"

#include <gtest/gtest.h>

namespace {

using host_sim::chips::t_states_from_ns;

constexpr uint64_t kClockHz = 3'072'000;

TEST(Chip, TimesAreRoundedUpToWholeTStates) {
    EXPECT_EQ(t_states_from_ns(0, kClockHz), 0U);
    EXPECT_EQ(t_states_from_ns(1, kClockHz), 1U);
    EXPECT_EQ(t_states_from_ns(325, kClockHz), 1U);  // one is 325.52 ns
    EXPECT_EQ(t_states_from_ns(326, kClockHz), 2U);
    EXPECT_EQ(t_states_from_ns(35'000, kClockHz), 108U);  // 107.52: conversion of the AD574A
    EXPECT_EQ(t_states_from_ns(500, 2'000'000), 1U);
}

TEST(Chip, LongTimesAreExact) {
    EXPECT_EQ(t_states_from_ns(1'000'000'000, kClockHz), kClockHz);
    EXPECT_EQ(t_states_from_ns(86'400'000'000'000'000, kClockHz), 86'400'000 * kClockHz);
    EXPECT_EQ(t_states_from_ns(86'400'000'000'000'001, kClockHz), 86'400'000 * kClockHz + 1);
}

}  // namespace
