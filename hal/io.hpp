// io.hpp - RawInputs and Commands: the only two structs that cross the hardware boundary.
// Depends on   nothing but fixed-width integers.
// Bounds       both are plain, fixed-size values; one of each per 10 Hz control step.
// Absent       a sensor that a vehicle lacks, or that gave no answer, is marked absent here; it is
//              never replaced by a number.
#pragma once

#include <stdint.h>

namespace hal {

/// Channels of the 16:1 multiplexer in front of the 12-bit converter, in multiplexer order.
enum class AdcChannel : uint8_t {
    bogie_left,
    bogie_right,
    differential,
    pitch,
    roll,
    steer_front_left,
    steer_front_right,
    steer_rear_left,
    steer_rear_right,
    gyro,
    mast,
    motor_current,
    battery,
    proximity,
};
inline constexpr uint8_t kAdcChannelCount = 14;

/// Sum of 16 conversions of 12 bits: u16 Q4 counts, [0, 65520]. Anything above means "absent".
inline constexpr uint16_t kAdcMaxQ4Count = 65520;
inline constexpr uint16_t kAdcAbsent = 0xFFFF;

/// Wheel order of tachometers and drive commands.
enum class Wheel : uint8_t {
    front_left,
    front_right,
    middle_left,
    middle_right,
    rear_left,
    rear_right
};
inline constexpr uint8_t kWheelCount = 6;
inline constexpr uint8_t kSteerCount = 4;

inline constexpr uint8_t kRangeSampleCount = 8;
inline constexpr uint8_t kCommandBytesMax = 16;

/// What the sensors said during one control step (100 ms). Raw counts only.
struct RawInputs {
    uint16_t tick_count = 0;                       ///< 100 Hz ticks since reset, modulo 2^16
    uint16_t adc_q4_count[kAdcChannelCount] = {};  ///< see kAdcMaxQ4Count, kAdcAbsent
    uint16_t tach_count[kWheelCount] = {};  ///< pulses since reset, modulo 2^16, forward counts up
    uint8_t tach_present = 0;               ///< bit w: wheel w has a working tachometer channel
    uint8_t detector_bits = 0;              ///< laser proximity detectors, one bit each
    uint8_t range_scan_count = 0;           ///< modulo 2^8; unchanged means no new scan (stale)
    uint8_t range_present = 0;              ///< bit i: range_q1_mm[i] was seen in this scan
    int16_t range_q1_mm[kRangeSampleCount] = {};  ///< s16 Q1 mm, ground, body frame
    uint8_t command_size = 0;                     ///< [0, kCommandBytesMax]
    uint8_t command[kCommandBytesMax] = {};       ///< received link bytes, oldest first
};

inline constexpr uint8_t kTelemetryBytesMax = 160;

/// What the controller asks of the vehicle, held until the next step. The mast's angle is as far
/// behind the steering angles as their AdcChannels are apart.
struct Commands {
    int8_t drive_percent[kWheelCount] = {};  ///< [-100, 100] of full wheel speed, forward positive
    int16_t steer_brad[kSteerCount] = {};    ///< s16 brad (turn/2^16), left positive
    uint8_t laser_bits = 0;                  ///< bit i fires laser i
    uint8_t telemetry_size = 0;              ///< [0, kTelemetryBytesMax]
    int16_t mast_brad = 0;                   ///< s16 brad, left positive
    uint8_t telemetry[kTelemetryBytesMax] = {};
};

}  // namespace hal
