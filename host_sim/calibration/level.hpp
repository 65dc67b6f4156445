// level.hpp - the reading of an inclinometer axis while the vehicle stands still.
// Depends on   swing.hpp (Reading, CalibrationError), statistics.hpp.
// Tests        tests/host_sim/calibration/level_test.cpp
#pragma once

#include <cstdint>
#include <span>

#include "host_sim/calibration/swing.hpp"

namespace host_sim {

/// A stretch of the log, [from, to).
struct TimeSpan {
    double from_s = 0, to_s = 0;
};

struct LevelOptions {
    double duration_min_s = 2;
    double noise_max_q4_count = 64;  ///< 0.15 deg
};

struct LevelReading {
    double q4_count = 0;
    double standard_error_q4_count = 0;
};

/// Mean of the readings in the stretch. Standard error from the scatter of eight block means, so
/// that noise with memory is not taken for independent, and from quantisation.
/// @errors  CalibrationError: stretch shorter than duration_min_s, or with fewer readings than that
///          takes at 10 Hz; sensor absent; too noisy; the vehicle moved (halves differ by more than
///          one code and four of their standard errors)
LevelReading read_level(std::span<const Reading> readings, TimeSpan span,
                        const LevelOptions& options = {});

}  // namespace host_sim
