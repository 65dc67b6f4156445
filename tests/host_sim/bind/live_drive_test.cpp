// The world around a live board whose program only ticks and drives. The flying image in it:
// tests/system/monitor_test.cpp.
#include "host_sim/bind/live_drive.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <thread>

#include "host_sim/world/course.hpp"
#include "tests/support/assemble.hpp"

namespace {

using host_sim::Drive;
using host_sim::DriveOptions;
using host_sim::LiveBoard;
using host_sim::LiveDrive;

// Timer A ticks; all six wheels drive at full duty; SOD toggles for the watchdog.
constexpr const char* kFullSpeed = R"(
        MVI  A,34H
        OUT  13H
        MVI  A,00H
        OUT  10H
        MVI  A,78H
        OUT  10H
        MVI  A,82H
        OUT  23H
        MVI  A,255
        OUT  30H
        OUT  31H
        OUT  32H
        OUT  33H
        OUT  34H
        OUT  35H
STAY:   MVI  A,0C0H
        SIM
        MVI  A,40H
        SIM
        JMP  STAY
)";

DriveOptions course() {
    return host_sim::random_course(host_sim::rocky32(), host_sim::TerrainKind::fractal, 0.02, 0.5,
                                   7);
}

TEST(LiveDrive, TheWorldStepsWithTheBoard) {
    LiveBoard live({}, host_sim::Pace::eager);
    const auto code = test_support::assemble(kFullSpeed);
    live.board().program(code.bytes, code.origin);
    live.board().run(1000);
    host_sim::unplug_sensors(live.board());
    const uint64_t first_tick_t = host_sim::next_tick_t(live.board()) - 30'720;
    LiveDrive drive(live, course());

    // The same world beside it: a step without a command, then full speed.
    Drive expected(course());
    (void)expected.step({});
    hal::RawInputs inputs;
    constexpr int kSteps = 8;
    hal::Commands full;
    for (int8_t& percent : full.drive_percent) percent = 100;
    for (int i = 0; i < kSteps; ++i) inputs = expected.step(full).inputs;

    bool seen = false;
    bool same = false;
    // Just before the tick of step 8 its inputs are there, 2000 T earlier they are not.
    const uint64_t tick_t = first_tick_t + kSteps * host_sim::kStepT;
    live.at(tick_t - 2100, [&](host_sim::Board& board) {
        same = board.state.analog.sources[3].sum_q4 == inputs.adc_q4_count[3];
    });
    live.at(tick_t - 100, [&](host_sim::Board& board) {
        for (std::size_t channel = 0; channel < 5; ++channel) {
            EXPECT_EQ(board.state.analog.sources[channel].sum_q4, inputs.adc_q4_count[channel]);
        }
        EXPECT_EQ(board.state.presence.lines & 0x3F, inputs.tach_present);
        EXPECT_EQ(board.state.range.scan_counter, inputs.range_scan_count);
        seen = true;
    });
    live.start();
    while (live.elapsed_t() < tick_t + 10'000) {
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    live.stop();
    EXPECT_TRUE(seen);
    EXPECT_FALSE(same) << "the noise of two steps differs";
    EXPECT_EQ(drive.world().state().time_s, expected.state().time_s);
    EXPECT_EQ(drive.world().state().position_cm, expected.state().position_cm);
    EXPECT_FALSE(drive.finished());
}

}  // namespace
