// columns.hpp - a log in physical units, one column per quantity; NaN is "not known".
// Depends on   host_sim/log/log.hpp.
// Used by      summary, charts, spans. Nothing is interpolated or filled in, except `place_m`.
#pragma once

#include <vector>

#include "host_sim/log/log.hpp"

namespace report {

using Column = std::vector<double>;

inline constexpr double kNotKnown = __builtin_nan("");

constexpr double mm_of_q4(double value_q4_mm) {
    return value_q4_mm / 16.0;
}
constexpr double deg_of_brad(double angle_brad) {
    return angle_brad * 360.0 / 65536.0;
}

/// Angle of a potentiometer or inclinometer in degrees by its calibration; NaN when the channel is
/// absent or the gain is 0 (not calibrated). Not rounded as the firmware rounds.
double calibrated_deg(const hal::AngleCalibration& calibration, std::uint16_t adc_q4_count);

/// Travel of the wheel rims in millimetres since the first step: per step the mean over the wheels
/// present in it and in the step before; steps without such a wheel add nothing. NaN throughout
/// when no wheel is ever present twice in a row.
Column wheel_travel_mm(const host_sim::Log& log);

/// What a place along the track is measured by.
enum class PlaceSource { none, truth, firmware, wheels };

/// Where the rover was, for the horizontal axis and the list of events.
struct Track {
    PlaceSource source = PlaceSource::none;
    bool reverses = false;  ///< the position falls back by more than 0.1 m: distance driven instead
    Column time_s;
    Column place_m;  ///< never decreasing, no NaN; empty when `source` is none
};

/// The place comes from the truth if at least 9 of 10 steps have a true position, else from the
/// firmware's position, else from the wheels; unknown steps repeat the last known place. `none`
/// when the rover covers less than 0.1 m.
Track track_of(const host_sim::Log& log);

}  // namespace report
