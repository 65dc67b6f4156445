// schedule_test.cpp - steps keep their phase; a late one is counted.
#include "firmware/executive/schedule.hpp"

#include <gtest/gtest.h>

namespace {

/// @return  false: late
bool begin(rover::Schedule& schedule, std::uint16_t tick) {
    bool on_time = true;
    rover::begin_due_step(schedule, tick, [&on_time] { on_time = false; });
    return on_time;
}

TEST(Schedule, StepsAreDueEveryTenTicksAcrossTheWrap) {
    rover::Schedule schedule;
    schedule.due_tick = 65500;
    for (std::uint32_t tick = 65500; tick < 65700; ++tick) {
        const auto now = static_cast<std::uint16_t>(tick);
        EXPECT_EQ(rover::step_is_due(schedule, now), tick % 10 == 0) << tick;
        if (tick % 10 != 0) continue;
        EXPECT_TRUE(begin(schedule, now));
    }
    EXPECT_EQ(schedule.late_steps, 0);
    EXPECT_EQ(schedule.missed_steps, 0);
}

TEST(Schedule, ALateStepIsCountedAndThoseBehindItKeepTheirTicks) {
    for (std::uint16_t late = 1; late < 100; ++late) {
        rover::Schedule schedule;
        schedule.due_tick = 40;
        EXPECT_FALSE(begin(schedule, static_cast<std::uint16_t>(40 + late)));
        EXPECT_EQ(schedule.late_steps, 1);
        EXPECT_EQ(schedule.missed_steps, late / 10);
        EXPECT_EQ(schedule.due_tick % 10, 0);
        EXPECT_GT(schedule.due_tick, 40 + late);
        EXPECT_LE(schedule.due_tick, 40 + late + 10);
    }
}

}  // namespace
