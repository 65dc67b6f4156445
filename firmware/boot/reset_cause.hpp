// reset_cause.hpp - why the last reset came, from what outlived it.
// Depends on   executive/battery_area.hpp, board_status.hpp; a Bus.
// Must run     before the timers are set up again and before the marks are.
// Design note  docs/design/boot.md     Tests  tests/firmware/boot/reset_cause_test.cpp
#pragma once

#include "firmware/executive/battery_area.hpp"
#include "firmware/executive/board_status.hpp"
#include "hal/board/rb85.hpp"

namespace rover {

/// From so many ticks without an edge on, a reset is the watchdog's: it waits 50, the main loop
/// never lets 20 pass.
inline constexpr uint8_t kWatchdogQuietTicks = 40;

inline constexpr uint8_t kReadStatus0 = 0xE2;  ///< 82C54 read-back: status of counter 0
inline constexpr uint8_t kTickStatus = 0x34;   ///< two bytes, mode 2, binary
inline constexpr uint8_t kTickStatusMask = 0x3F;

/// Does the tick counter still run in its mode? RESET does not reach the timers, power-up does.
template <class Bus>
bool timer_kept_its_mode() {
    Bus::template out<hal::rb85::kTimerA + hal::rb85::kTimerControl>(kReadStatus0);
    return bit_and(Bus::template in<hal::rb85::kTimerA>(), kTickStatusMask) == kTickStatus;
}

/// @param mark         RunMark of the last run
/// @param quiet_ticks  since its last watchdog edge
constexpr ResetCause reset_cause(bool timer_kept, uint8_t mark, uint8_t quiet_ticks) {
    if (!timer_kept) return ResetCause::power_up;
    if (mark == static_cast<uint8_t>(RunMark::warm_restart) ||
        mark == static_cast<uint8_t>(RunMark::cold_restart)) {
        return ResetCause::restart;
    }
    return quiet_ticks >= kWatchdogQuietTicks ? ResetCause::watchdog : ResetCause::other;
}

}  // namespace rover
