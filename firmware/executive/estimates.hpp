// estimates.hpp - everything the controller knows after a step; the content of a telemetry frame.
// Depends on   fixed-width integers only.
#pragma once

#include <stdint.h>

namespace rover {

/// What the slip estimator is doing.
enum class SlipMode : uint8_t {
    odometry_only,  ///< no usable suspension geometry: position follows the wheels
    tracking,       ///< position follows the ground that the wheels feel
    reacquiring,    ///< matching failed lately; wide search, position uncertain
    reversing,      ///< driving backwards: odometry until known ground is reached again
    turning,        ///< turning on the spot: no advance is claimed
    moved,          ///< lifted or moved by hand: map dropped, odometry until rebuilt
};

/// Bits of Estimates::available: which estimates have the sensors they need.
enum Available : uint8_t {
    kAvailableOdometry = 1u << 0,   ///< at least one tachometer
    kAvailableAttitude = 1u << 1,   ///< pitch and roll
    kAvailableLinkage = 1u << 2,    ///< z1, z2 (pitch, differential, one bogie)
    kAvailableSlip = 1u << 3,       ///< slip and corrected position
    kAvailableLookAhead = 1u << 4,  ///< fresh range samples, and the left linkage
    kAvailableSinkage = 1u << 5,    ///< sinkage (linkage and look-ahead)
};

/// Bits of Estimates::events: set in the step in which something happened.
enum Event : uint8_t {
    kEventCycle = 1u << 0,         ///< a slip-and-sinkage cycle was completed in this step
    kEventSlipAlarm = 1u << 1,     ///< slip alarm is up
    kEventSinkageAlarm = 1u << 2,  ///< sinkage alarm is up
    kEventLostLock = 1u << 3,      ///< the estimator has just declared loss of lock
    kEventTickGap = 1u << 4,       ///< ticks are missing between this step and the last
    kEventSensorFault = 1u << 5,   ///< a fault bit is set (see faults); absence is none
    kEventOverspeed = 1u << 6,     ///< more than 15 mm of odometry in a step: cycles come late
};

/// Bits of Estimates::faults.
enum Fault : uint16_t {
    kFaultBogieLeft = 1u << 0,
    kFaultBogieRight = 1u << 1,
    kFaultDifferential = 1u << 2,
    kFaultPitch = 1u << 3,
    kFaultRoll = 1u << 4,
    kFaultTachometer = 1u << 5,   ///< a present tachometer disagrees with the others
    kFaultRangeStale = 1u << 6,   ///< no new scan within the allowed steps
    kFaultCalibration = 1u << 7,  ///< calibration record refused; nominal values in use
};

struct Estimates {
    uint16_t step_count = 0;  ///< control steps since reset, modulo 2^16
    uint16_t tick_count = 0;  ///< tick of the inputs that this step used
    uint8_t available = 0;    ///< Available bits
    uint8_t events = 0;       ///< Event bits
    uint16_t faults = 0;      ///< Fault bits
    SlipMode mode = SlipMode::odometry_only;
    uint16_t cycle_count = 0;            ///< slip-and-sinkage cycles since reset, modulo 2^16
    int32_t position_q4_mm = 0;          ///< s32 Q4 mm, rear contact along the ground track
    int32_t odometer_q4_mm = 0;          ///< s32 Q4 mm, plain wheel odometry
    uint16_t position_sigma_q4_mm = 0;   ///< u16 Q4 mm, one sigma, saturates
    int16_t advance_q4_mm = 0;           ///< s16 Q4 mm, advance of the last cycle
    int8_t slip_percent = 0;             ///< 100 (1 - advance/odometry), smoothed; [-100, 100]
    uint16_t match_cost_q4 = 0;          ///< u16 Q4, running mean of the matching cost
    int16_t sinkage_q4_mm = 0;           ///< s16 Q4 mm, at the front wheel; >= 0
    int16_t pitch_brad = 0;              ///< s16 brad, body, nose up positive
    int16_t roll_brad = 0;               ///< s16 brad, body, right side down positive
    int16_t rocker_brad = 0;             ///< s16 brad, rocker against the horizon, nose up +
    int16_t bogie_brad = 0;              ///< s16 brad, bogie against the horizon, nose up +
    int16_t height_middle_q4_mm = 0;     ///< s16 Q4 mm, z(1): middle wheel above the rear wheel
    int16_t height_front_q4_mm = 0;      ///< s16 Q4 mm, z(2): front wheel above the rear wheel
    int16_t height_ahead_q4_mm[2] = {};  ///< s16 Q4 mm, z(3), z(4), of the last cycle
                                         ///< that saw the sample
};

}  // namespace rover
