// board_status.hpp - fault register, reset cause and the status frame.
// Depends on   core/arith.hpp.
// Normative    docs/spec/link.md
// Tests        tests/firmware/executive/board_status_test.cpp
#pragma once

#include "firmware/core/arith.hpp"

namespace rover {

/// Bits of the fault register. They stay until the next reset. The low byte is written by the main
/// line alone, the high byte by the TRAP handler alone, so that neither loses a bit of the other.
enum BoardFault : uint8_t {
    kFaultRom = 1u << 0,          ///< the image's check is wrong
    kFaultRam = 1u << 1,          ///< the RAM test failed
    kFaultStack = 1u << 2,        ///< the guard below the stack was overwritten
    kFaultStepLate = 1u << 3,     ///< a step began behind its tick
    kFaultLinkLost = 1u << 4,     ///< a byte or a frame was lost, either way
    kFaultConverter = 1u << 5,    ///< a conversion without an end
    kFaultNoRecord = 1u << 6,     ///< no valid calibration record is stored
    kFaultNoCheckpoint = 1u << 7  ///< cold start because no checkpoint was valid
};
enum TrapFault : uint8_t {
    kTrapUndervoltage = 1u << 0,  ///< bit 8 of the register
    kTrapBumper = 1u << 1,        ///< bit 9
};
/// With one of these, or any TRAP, the drives stay off.
inline constexpr uint8_t kFaultsThatStop = kFaultRom | kFaultRam | kFaultStack;

/// Why the last reset came, as far as the board can tell.
enum class ResetCause : uint8_t {
    power_up = 0,  ///< the timer had lost its mode
    watchdog = 1,  ///< 0.4 s or more without an edge of SOD, while ticks still came
    restart = 2,   ///< the ground asked
    other = 3,     ///< button, or the watchdog behind a hang with interrupts disabled
};

/// Payload of the status frame, words low byte first, without padding.
struct BoardStatus {
    uint16_t faults = 0;           ///< BoardFault, TrapFault bits from bit 8 on
    uint16_t last_faults = 0;      ///< those of the run before
    uint16_t reset_count = 0;      ///< modulo 2^16, since the battery was last empty
    uint16_t late_steps = 0;       ///< modulo 2^16, as all counts below
    uint16_t missed_steps = 0;     ///< steps that never were
    uint16_t received = 0;         ///< bytes taken by a step, and dropped ones
    uint16_t receive_dropped = 0;  ///< bytes that the full ring refused
    uint16_t receive_errors = 0;   ///< overruns, framing and parity errors
    uint16_t frames_dropped = 0;   ///< frames that found no room in the transmit ring
    uint8_t frames_refused = 0;    ///< uplink frames with a wrong check or size, modulo 2^8
    uint8_t trap_count = 0;        ///< modulo 2^8
    ResetCause reset_cause = ResetCause::power_up;
    uint8_t warm = 0;  ///< 1: went on from a checkpoint
};
static_assert(sizeof(BoardStatus) == 22, "the same bytes on host and target");

}  // namespace rover
