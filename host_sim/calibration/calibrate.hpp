// calibrate.hpp - estimates the calibration record from a recorded swing and a level stretch.
// Depends on   swing.hpp, level.hpp, host_sim/log/log.hpp.
// Source       docs/spec/calibration.md: procedure, formulas, uncertainty, refusals.
// Tests        tests/host_sim/calibration/calibrate_test.cpp
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "hal/calibration.hpp"
#include "host_sim/calibration/level.hpp"
#include "host_sim/calibration/swing.hpp"
#include "host_sim/log/log.hpp"

namespace host_sim {

struct CalibrateOptions {
    /// Potentiometers that were swung to both stops.
    std::vector<hal::AngleChannel> swung = {hal::AngleChannel::bogie_left,
                                            hal::AngleChannel::bogie_right,
                                            hal::AngleChannel::differential};
    double bogie_stop_deg = 30;         ///< stops at -this and +this, (0, 45)
    double differential_stop_deg = 30;  ///< likewise
    double gain_tolerance = 0.25;       ///< largest credible deviation from the nominal gain
    double zero_max_deg = 11;           ///< largest credible zero error, potentiometers
    double level_max_deg = 10;          ///< largest credible zero error, inclinometer
    SwingOptions swing;
    LevelOptions level;
    std::optional<TimeSpan> level_span;   ///< standing on level ground, or first heading
    std::optional<TimeSpan> turned_span;  ///< same place, turned by 180 deg; needs level_span
    std::array<bool, hal::kAngleChannelCount> flip = {};  ///< change `inverted` of the channel
};

/// What was found for one channel.
struct ChannelCalibration {
    hal::AngleChannel channel = hal::AngleChannel::bogie_left;
    double zero_q4_count = 0;
    double zero_error_q4_count = 0;  ///< standard error
    double gain_q16 = 0;             ///< 0: not estimated (inclinometer)
    double gain_error_q16 = 0;       ///< standard error
    std::optional<Swing> swing;
};

struct CalibrationResult {
    hal::Calibration record;  ///< the log's record with the estimates put in
    std::vector<ChannelCalibration> channels;
    double ground_pitch_deg = 0;  ///< slope under the vehicle at the first heading; needs both
    double ground_roll_deg = 0;
};

/// Estimates what the log has, on top of the record in its head.
/// zero = middle of the stops, gain = angle between the stops / counts between them, rounded to the
/// record's formats. Polarity cannot be seen in a swing between symmetrical stops: `inverted` stays
/// as in the log's head, unless flipped.
/// @errors  CalibrationError, starting with the channel's name: everything of find_swing and
///          read_level; gain or zero beyond what is credible; options out of range; nothing to do
CalibrationResult calibrate(const Log& log, const CalibrateOptions& options = {});

/// Lines for people: one a channel, value and standard error in counts and degrees, and what the
/// standard errors leave out.
std::vector<std::string> describe(const CalibrationResult& result, const CalibrateOptions& options);

}  // namespace host_sim
