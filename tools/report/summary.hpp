// summary.hpp - the headline figures of a drive, and the sentences that say them.
// Depends on   host_sim/log/log.hpp.
// Rule         a figure whose source is not in the log is empty, in every output; never a zero.
#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "host_sim/log/log.hpp"

namespace report {

using Figure = std::optional<double>;

/// What rises and falls: how often, for how long, and where it first rose.
struct AlarmFigures {
    std::size_t count = 0;    ///< times it went up; up in the first step counts
    double raised_share = 0;  ///< part of the steps with estimates in which it was up, [0, 1]
    Figure first_time_s;      ///< since the log's start
    Figure first_place_m;     ///< on the scale of Track::place_m; empty without one
};

/// One quantity, estimated and true. Means and the RMS are over steps, so every second counts
/// alike.
struct QuantityFigures {
    Figure estimated_mean, estimated_greatest;  ///< over steps in which the estimate is available
    Figure true_mean, true_greatest;            ///< over steps in which the truth is known
    Figure rms_error;                           ///< over steps with both
};

struct Summary {
    std::size_t step_count = 0;
    double duration_s = 0;       ///< last time minus first
    bool has_estimates = false;  ///< the controller ran in at least one step
    bool has_truth = false;      ///< a true position is known in at least two steps
    std::string vehicle;         ///< `name` of the vehicle description, else empty
    std::string image_identity;

    // Distances in metres from the first to the last step that has the quantity.
    Figure true_distance_m;
    Figure firmware_distance_m;  ///< position_q4_mm
    Figure wheel_distance_m;     ///< odometer_q4_mm; from the tachometers when no controller ran
    Figure
        slip_overall_percent;  ///< 100 (1 - true/wheel distance); empty below 0.1 m of wheel travel

    // (estimate - truth) at the last step with both, counted from the first step with both.
    Figure firmware_error_m, wheel_error_m;
    Figure firmware_error_percent,
        wheel_error_percent;    ///< of the true distance; empty below 0.1 m
    Figure position_sigma_m;    ///< the firmware's own one-sigma at the end, when slip is available
    Figure within_sigma_share;  ///< part of the steps with |error| <= sigma, [0, 1]

    QuantityFigures sinkage_mm;
    QuantityFigures slip_percent;

    AlarmFigures slip_alarm, sinkage_alarm;
    std::size_t cycle_count = 0;      ///< slip-and-sinkage cycles that ran during the log
    std::size_t lost_lock_count = 0;  ///< steps with kEventLostLock
    std::size_t tick_gap_count = 0;   ///< steps with kEventTickGap
    std::size_t overspeed_count = 0;  ///< steps with kEventOverspeed

    std::map<std::string, double> sensor_present_share;  ///< by Sensor::key, [0, 1]
    std::map<std::string, std::size_t> fault_steps;      ///< by FaultName::key; only faults seen
    std::map<std::string, double> available_share;  ///< by EstimateName::key; empty: no estimates
    std::map<std::string, double> mode_share;       ///< by kModeKeys; empty: no estimates
    std::map<std::string, std::string> notes;

    std::vector<std::string> sensors_missing;       ///< texts of sensors never present
    std::vector<std::string> sensors_intermittent;  ///< texts of sensors present in some steps only
    std::vector<std::string> not_available;         ///< texts of estimates never available
};

/// Headline figures of a log. Any log is accepted, an empty one too.
Summary summarize(const host_sim::Log& log);

/// The summary in plain words, one sentence or two each; what is not known is left out or said to
/// be unknown. Not escaped.
std::vector<std::string> sentences(const Summary& summary);

/// The summary as JSON text: keys carry their unit, unknown figures are null.
std::string summary_json(const Summary& summary);

/// Writes summary_json() to a file, replacing it as a whole.
/// @errors  std::runtime_error naming the file, the reason and what to do; no half-written file
void write_summary_json(const Summary& summary, const std::filesystem::path& file);

// Numbers as the report prints them.
std::string text_of_percent(double value);     ///< "0.17 %", "2.3 %", "20 %": no sign
std::string text_of_distance(double value_m);  ///< "62.5 m", "12 cm", "3 mm": no sign
std::string text_of_duration(double value_s);  ///< "12.5 s", "12 min 30 s", "2 h"
std::string text_of_count(std::size_t count);  ///< "75,000"

}  // namespace report
