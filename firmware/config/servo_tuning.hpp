// servo_tuning.hpp - constants of the servo loops, with unit and range.
// Depends on   <stdint.h>.      Design note  docs/design/executive.md
// Units        a code is 64 brad, 0.35 degrees: firmware/executive/servo_loops.hpp.
#pragma once

#include <stdint.h>

namespace rover {

/// No servo is sent farther from straight ahead, in 1/256 turn: 39.4 degrees. What overshoots there
/// is still away from the ends of its potentiometer.
inline constexpr uint8_t kServoReachQ8Turn = 28;

inline constexpr uint8_t kServoDeadbandCodes = 1;  ///< so near is there: within 0.7 degrees
/// Duty of 255 of a servo that is nearly there, and 1 more for each two codes: 181 at most. It has
/// to overcome friction, and must not cross the deadband's three codes between two looks: a motor
/// of up to 50 degrees a second at full duty stops without oscillating.
inline constexpr uint8_t kServoLeastDuty = 64;

}  // namespace rover
