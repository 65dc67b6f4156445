// controller_tuning.hpp - constants of acquisition and schedule, with unit and range.
// Depends on   <stdint.h>.      Design note  docs/design/controller.md
#pragma once

#include <stdint.h>

namespace rover {

inline constexpr uint16_t kTicksPerStep = 10;  ///< 100 Hz ticks in a 10 Hz control step

// -- Odometry ---------------------------------------------------------------------------------
inline constexpr int16_t kCycleTravelQ4Mm = 960;  ///< 60.0 mm: one slip-and-sinkage cycle
inline constexpr uint8_t kCycleSteps = 4;         ///< that a cycle takes: one part in each
inline constexpr uint16_t kOverspeedQ4Mm = kCycleTravelQ4Mm / kCycleSteps;  ///< a step: 0.15 m/s
inline constexpr int16_t kCycleOdometerMaxQ6Bin = 500;  ///< 195 mm: the estimator's odometry ends
inline constexpr uint16_t kTachDisagreeMm = 15;         ///< in a cycle: a tachometer fault
inline constexpr uint16_t kTachStepMaxCount = 1900;     ///< more pulses in a step: counter upset
inline constexpr int16_t kTachLeadMaxCount = 8;         ///< a wheel ahead of its side: remembered

// -- Sensor faults ----------------------------------------------------------------------------
inline constexpr uint8_t kStuckCycles = 8;      ///< identical sums in so many cycles: stuck
inline constexpr uint8_t kScanFreshSteps = 3;   ///< a look-ahead scan is used for so many steps
inline constexpr uint8_t kScanStaleSteps = 10;  ///< no new scan for so many steps: a fault

// -- Moved by hand ------------------------------------------------------------------------------
inline constexpr uint16_t kMovedQ4Mm = 192;  ///< 12 mm change of z(1) or z(2), wheels at rest

// -- Commands -----------------------------------------------------------------------------------
inline constexpr int8_t kCruisePercent = 100;
inline constexpr int8_t kCautionPercent = 50;  ///< while an alarm is up

}  // namespace rover
