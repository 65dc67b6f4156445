// swing.hpp - finds the two mechanical stops in the readings of a potentiometer that was swung.
// Depends on   statistics.hpp.     Source  docs/spec/calibration.md, "Stops".
// Tests        tests/host_sim/calibration/swing_test.cpp
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <stdexcept>

namespace host_sim {

/// Why a log does not give a calibration: one sentence, what to do included.
class CalibrationError : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

/// A converter reading; kAdcAbsent where there is none.
struct Reading {
    std::uint32_t time_ms = 0;
    std::uint16_t q4_count = 0;
};

/// What counts as a stop.
struct SwingOptions {
    double dwell_s = 1.2;                ///< shortest rest at a stop, > 0
    double settle_s = 0.3;               ///< left out at both ends of a rest, [0, dwell_s / 2)
    int visits_min = 3;                  ///< rests needed at each stop, >= 2
    double noise_max_q4_count = 24;      ///< largest credible noise at rest, 1.5 codes
    double visit_spread_q4_count = 128;  ///< visits of one stop agree within this, 0.18 deg
    double overshoot_q4_count = 2185;    ///< bounce beyond a stop, 3 deg; more is refused
    double span_min_q4_count = 6554;     ///< 9 deg: less is not a swing
};

/// The level of one stop.
struct StopLevel {
    double q4_count = 0;
    double standard_error_q4_count = 0;
    int visits = 0;
};

struct Swing {
    StopLevel low, high;
    double noise_q4_count = 0;  ///< standard deviation at rest
};

/// Finds the stops.
/// A rest is a stretch of at least dwell_s in which the readings stay within 8 noise_max of one
/// another; its first and last settle_s and its outliers do not count. The lowest rests are the low
/// stop, the highest the high stop; two rests are two visits when the arm went a quarter of the
/// span away between them. Each visit counts by its trimmed mean, the stop by the mean of its
/// visits.
/// @errors  CalibrationError: sensor absent (never there, or missing in more than a tenth of the
///          steps); too noisy; never at rest; span too small; a stop with too few visits; arm
///          beyond a stop by more than the overshoot; converter at its limit at a stop
Swing find_swing(std::span<const Reading> readings, const SwingOptions& options = {});

}  // namespace host_sim
